"""Checks whether a finished file is complete, by comparing its header with its contents.

A full disk can leave a file that begins correctly but is cut short.
"""

import struct
import zlib
from pathlib import Path

from ...messages import Message
from .fault import Fault
from .pictures import check_jpeg, check_png
from .ply import check_ply
from .scans import check_e57, check_ptx
from .scenes import check_blend, check_glb, check_usd
from .texts import check_json

_CHECKS = {
    ".png": check_png,
    ".jpg": check_jpeg,
    ".jpeg": check_jpeg,
    ".json": check_json,
    ".ply": check_ply,
    ".glb": check_glb,
    ".blend": check_blend,
    ".usd": check_usd,
    ".ptx": check_ptx,
    ".e57": check_e57,
}
"""By suffix: called as ``check(file, size)`` with the open binary file; raises Fault, or what its parts raise."""


def fault_of(path):
    """Say what is wrong with a finished file.

    Parameters
    ----------
    path : path-like
        Its suffix tells what it should be. Of a kind that is not known here it is only asked that it is not empty.

    Returns
    -------
    Message or None
        None where it is whole.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    path = Path(path)
    check = next((check for suffix, check in _CHECKS.items() if path.name.lower().endswith(suffix)), None)
    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            file.seek(0)
            if not size:
                raise Fault("it is empty")
            if check is not None:
                check(file, size)
    except Fault as fault:
        return fault.message
    except FileNotFoundError:
        return Message("there is no file")
    except (struct.error, zlib.error, ValueError, LookupError, RecursionError):
        return Message("it is cut short or damaged")
    return None
