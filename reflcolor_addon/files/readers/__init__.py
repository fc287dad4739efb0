"""Opens scan files: PTX, structured E57, and image pairs described by a `.scan.json`."""

from pathlib import Path

from ...errors import ScanError
from ..gate import opened
from .e57 import read_e57
from .image_pair import read_image_pair
from .ptx import read_ptx

SCAN_SUFFIXES = (".ptx", ".e57", ".scan.json")
"""What scan files end in; for file dialogs and drag and drop."""

_EXPECTED = f"a scan file ({', '.join(SCAN_SUFFIXES)})"
_START = 512
_READERS = dict(zip(SCAN_SUFFIXES, (read_ptx, read_e57, read_image_pair), strict=True))


def read_scans(path, *, outside=False, progress=None, cancelled=None):
    """Read every scan of a file, upright and not mirrored.

    Parameters
    ----------
    path : path-like
        The suffix tells the format, in upper or lower case.
    outside : bool
        Let a `.scan.json` name images outside of its own folder, too; who sends such a file could name any file here.
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
    try:
        with opened(path, _EXPECTED, error=ScanError) as file:
            _check_kind(path, file.read(_START), reader)
            file.seek(0)
            return reader(file, path, outside=outside, progress=progress, cancelled=cancelled)
    except MemoryError:
        raise ScanError("{file}: does not fit into memory", file=path.name) from None


def _check_kind(path, start, reader):
    contents = _contents(start)
    if reader is None:
        known = ", ".join(SCAN_SUFFIXES)
        if contents is None:
            raise ScanError("{file}: not a scan file by its name, expected one of {known}", file=path.name, known=known)
        raise ScanError(
            "{file}: not a scan file by its name, expected one of {known}; its contents look like {contents}: rename "
            "it",
            file=path.name,
            known=known,
            contents=contents,
        )
    if contents and not path.name.lower().endswith(contents):
        raise ScanError("{file}: its contents look like {contents}: rename it", file=path.name, contents=contents)


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
