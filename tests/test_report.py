"""The report of a colorization."""

import hashlib
import json
import tomllib
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Cancelled, ReflcolorError, Seeds, Settings, colorize
from reflcolor_addon.report.report import build_report, input_entry, scan_entry, stamped
from reflcolor_addon.version import __version__

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture
def scan():
    valid = np.ones((6, 10), bool)
    valid[2, 3] = False
    return random_scan(valid=valid, name="garage")


@pytest.fixture
def seeds():
    return Seeds([2, 4], [3, 8], [[10, 20, 30], [40, 50, 60]], [None, "view.jpg"], [(np.nan, np.nan), (812.5, 440)])


@pytest.fixture
def report_of(scan, seeds, tmp_path):
    """A function that makes a report, of the settings that it is given."""
    (tmp_path / "garage.ptx").write_bytes(b"points" * 400_000)

    def report(settings=None, **options):
        settings = settings or Settings()
        return build_report(
            scan_entry(scan, 2),
            colorize(scan, seeds, settings),
            settings,
            given_seeds=seeds,
            inputs=[input_entry("scan", tmp_path / "garage.ptx")],
            outputs=[("-o", tmp_path / "out.png")],
            **options,
        )

    return report


def test_it_says_what_was_colorized_and_how(report_of, scan, seeds):
    settings = Settings(alpha=4.0, beta=0.0, color_space="cielab", neighbors=4)
    report = report_of(settings)
    assert report["scan"] == {
        "name": "garage", "index": 2, "rows": 6, "columns": 10, "returns": 59, "full_turn": False, "flipped": [],
    }  # fmt: skip
    chosen = {"alpha": 4.0, "beta": 0.0, "color_space": "cielab", "neighbors": 4, "nearest": None}
    assert report["settings"] == Settings().as_dict() | chosen
    assert report["normalization"] == {
        "percentiles": [1.0, 99.0],
        "reflectance": np.percentile(scan.reflectance[scan.valid].astype(float), (1, 99)).tolist(),
        "range_m": np.percentile(scan.range[scan.valid], (1, 99)).tolist(),
    }
    confidence = colorize(scan, seeds, settings).confidence[scan.valid].mean()
    assert report["result"] == {
        "colored": 59,
        "unreached": 0,
        "observed": 0,
        "guessed": False,
        "mean_confidence": pytest.approx(confidence, abs=1e-4),
    }


def test_it_names_every_seed_as_it_was_used_and_as_it_was_given(report_of):
    report = report_of()
    assert report["seeds"] == [
        {
            "row": 1, "col": 3, "rgb": [10, 20, 30], "photo": None, "x": None, "y": None,
            "confidence": None, "reason": None, "moved_from": {"row": 2, "col": 3},
        },
        {"row": 4, "col": 8, "rgb": [40, 50, 60], "photo": "view.jpg", "x": 812.5, "y": 440.0,
         "confidence": None, "reason": None, "moved_from": None},
    ]  # fmt: skip
    assert report["warnings"] == ["seed 1: no return at row 2, column 3; moved to row 1, column 3"]


def test_it_holds_size_and_hash_of_every_input(report_of, tmp_path):
    content = (tmp_path / "garage.ptx").read_bytes()
    assert report_of()["inputs"] == [
        {
            "role": "scan",
            "path": str(tmp_path / "garage.ptx"),
            "bytes": len(content),
            "sha256": hashlib.sha256(content).hexdigest(),
        }
    ]


def test_it_holds_the_versions(report_of):
    versions = report_of(blender="5.2.2 LTS")["versions"]
    assert versions["reflcolor"] == __version__
    assert versions["blender"] == "5.2.2 LTS"
    assert versions["numpy"] == np.__version__
    assert report_of()["versions"]["blender"] is None


def test_it_is_json_and_the_same_each_time(report_of):
    text = json.dumps(report_of(), allow_nan=False)
    assert text == json.dumps(report_of(), allow_nan=False)
    assert json.loads(text) == report_of()


def test_an_input_that_is_gone_is_named(tmp_path):
    with pytest.raises(ReflcolorError, match=r"gone\.ptx: no such file"):
        input_entry("scan", tmp_path / "gone.ptx")


def test_hashing_a_large_file_can_be_cancelled(tmp_path):
    (tmp_path / "large.ptx").write_bytes(b"points")
    with pytest.raises(Cancelled):
        input_entry("scan", tmp_path / "large.ptx", lambda: True)


def test_the_time_is_in_utc_and_nothing_else_differs(report_of):
    report = report_of()
    later = stamped(report)
    before = datetime.now(UTC) - timedelta(seconds=2)
    assert before <= datetime.fromisoformat(later.pop("created")) <= datetime.now(UTC)
    assert later == report


def test_the_version_is_that_of_the_extension():
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert __version__ == manifest["version"]
