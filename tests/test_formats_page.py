"""Every line of the tables of docs/formats.md names tests that exist, and no format is missing there."""

import re
from pathlib import Path

import pytest

from reflcolor_addon.files.readers import SCAN_SUFFIXES
from reflcolor_addon.files.writers import MESH_WRITERS
from reflcolor_addon.files.writers.scans_back import SCAN_FILES

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8") if (ROOT / "docs").is_dir() else ""
LINES = [line for line in PAGE.splitlines() if line.startswith("| ") and not line.endswith("| tested by |")]
TESTS = {
    name
    for file in (ROOT / "tests").glob("test_*.py")
    for name in re.findall(r"^def (test_\w+)", file.read_text(encoding="utf-8"), re.MULTILINE)
}


@pytest.mark.parametrize("line", LINES, ids=lambda line: line[2:50])
def test_every_line_names_tests_that_exist(line):
    named = re.findall(r"`(test_\w+)`", line)
    assert set(named) <= TESTS
    assert named or line.endswith("| not tested |")


def test_no_format_is_missing():
    assert LINES
    overview = PAGE[: PAGE.index("## ")]
    assert {suffix for suffix in (*SCAN_SUFFIXES, *MESH_WRITERS, *SCAN_FILES) if f"`{suffix}`" not in overview} == set()
