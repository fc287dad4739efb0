"""The outermost boundary: which failures are one line, and which are defects."""

import cv2
import pytest

from reflcolor_addon.errors import ScanError, UsageError
from reflcolor_addon.failures import NO_MEMORY, line_of


def insufficient_memory():
    failed = cv2.error("(-4:Insufficient memory)")
    failed.code = -4
    return failed


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (ScanError("{file}: is empty", file="a.ptx"), "a.ptx: is empty"),
        (UsageError("give a file"), "give a file"),
        (MemoryError(), NO_MEMORY),
        (insufficient_memory(), NO_MEMORY),
        (ImportError("x.so: failed to map segment from shared object", name="cv2"), NO_MEMORY),
        (ModuleNotFoundError("No module", name="cv2.x"), "OpenCV is missing"),
        (PermissionError(13, "Permission denied", "a.ptx"), "a.ptx: Permission denied"),
        (OSError(28, "No space left on device"), "the operating system reports: No space left on device"),
        (OSError(5, "Input/output error", b"two\nlines"), r"two\nlines: Input/output error"),
    ],
)
def test_what_a_person_or_the_machine_can_cause_is_one_line(error, line):
    assert line_of(error).startswith(line)
    assert "\n" not in line_of(error)


@pytest.mark.parametrize("error", [ValueError("x"), KeyError("x"), ImportError("x", name="numpy"), cv2.error("x")])
def test_anything_else_is_a_defect(error):
    assert line_of(error) is None
