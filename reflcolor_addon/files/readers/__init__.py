"""Opens scan files: PTX, structured E57, and image pairs described by a `.scan.json`."""

from pathlib import Path

from ...errors import ScanError
from .e57 import read_e57
from .image_pair import read_image_pair
from .ptx import read_ptx

SCAN_SUFFIXES = (".ptx", ".e57", ".scan.json")
"""What scan files end in; for file dialogs and drag and drop."""

_READERS = dict(zip(SCAN_SUFFIXES, (read_ptx, read_e57, read_image_pair), strict=True))


def read_scans(path, *, progress=None, cancelled=None):
    """Read every scan of a file, upright and not mirrored.

    Parameters
    ----------
    path : path-like
        The suffix tells the format, in upper or lower case.
    progress : callable, optional
        Called with a fraction 0..1 and a text.
    cancelled : callable, optional
        Asked now and then; True stops the reading.

    Returns
    -------
    list of Scan
        At least one; what was mended or left out is in their `warnings`.

    Raises
    ------
    ScanError
        One line: file, place, what was expected.
    Cancelled
        If `cancelled()` returned True.
    """
    path = Path(path)
    reader = next((read for suffix, read in _READERS.items() if path.name.lower().endswith(suffix)), None)
    start = _start_of(path)
    if not start:
        raise ScanError(f"{path.name}: is empty")
    contents = _contents(start)
    if reader is None:
        hint = f"; its contents look like {contents}: rename it" if contents else ""
        raise ScanError(f"{path.name}: not a scan file by its name, expected one of {', '.join(SCAN_SUFFIXES)}{hint}")
    if contents and not path.name.lower().endswith(contents):
        raise ScanError(f"{path.name}: its contents look like {contents}: rename it")
    try:
        return reader(path, progress=progress, cancelled=cancelled)
    except MemoryError:
        raise ScanError(f"{path.name}: does not fit into memory") from None
    except OSError as error:
        raise ScanError(f"{path}: cannot be read ({error.strerror or error})") from None


def _start_of(path):
    try:
        with path.open("rb") as file:
            return file.read(512)
    except FileNotFoundError:
        raise ScanError(f"{path}: no such file") from None
    except OSError as error:
        if path.is_dir():
            expected = f"expected a scan file ({', '.join(SCAN_SUFFIXES)})"
            raise ScanError(f"{path.name or path}: is a directory, {expected}") from None
        raise ScanError(f"{path}: cannot be read ({error.strerror or error})") from None
    except ValueError as error:
        raise ScanError(f"{str(path)!r}: cannot be read ({error})") from None


def _contents(start):
    """The suffix that the first bytes of a file speak for; None where they do not tell."""
    if start.startswith(b"ASTM-E57"):
        return ".e57"
    text = start.removeprefix(b"\xef\xbb\xbf").split()
    if text and text[0].startswith(b"{"):
        return ".scan.json"
    if len(text) > 2 and text[0].isdigit() and text[1].isdigit() and len(start.splitlines()[0].split()) == 1:
        return ".ptx"
    return None
