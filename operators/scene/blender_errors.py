"""Blender's own error messages, as the end of one line."""

import os

# Blender truncates longer paths silently.
LONGEST_PATH = 1023


def blender_reason(error):
    """Return why, of the RuntimeError that an operator of Blender raised: without its prefix, traceback and place."""
    lines = [line.strip() for line in str(error).splitlines()]
    said = [line for line in lines if line and not line.startswith("Location:")] or ["unknown error"]
    return said[-1].removeprefix("Error: ")


def refusal_of(error):
    """Return why another operator of this extension refused to work, of the RuntimeError that it raised.

    Raises
    ------
    RuntimeError
        The error itself, where it is no refusal but a defect.
    """
    if "Traceback" in str(error):
        raise error
    return blender_reason(error)


def path_fault(path):
    """Return why Blender can neither read nor write a path, whatever is there; None where it can."""
    try:
        if len(os.fspath(path).encode()) > LONGEST_PATH:
            return f"its path is longer than the {LONGEST_PATH:,} bytes that Blender takes"
    except UnicodeEncodeError:
        return "its path is not in UTF-8, as Blender needs it"
    return None
