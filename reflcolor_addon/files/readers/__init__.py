"""Opens scan files of every format that is listed here; a format is a module with a `FORMAT`."""

from os import PathLike
from pathlib import Path

import numpy as np

from ...errors import ScanError
from ...messages import Message
from ...progress import IsCancelled, Progress
from ...scan.scan import Scan
from ..gate import opened
from . import e57, image_pair, las, numpy_arrays, pcd, ply, ptx, text_cloud
from .formats import REFUSED
from .options import AS_IT_IS, ReadOptions

__all__ = ["FORMATS", "SCAN_SUFFIXES", "ReadOptions", "read_scans", "scan_pixels"]

FORMATS = tuple(module.FORMAT for module in (ptx, e57, image_pair, pcd, ply, numpy_arrays, las, text_cloud))
"""What can be read; dialogs, help texts and docs/formats.md list it."""

SCAN_SUFFIXES = tuple(suffix for kind in FORMATS for suffix in kind.suffixes)
"""What scan files end in; for file dialogs and drag and drop."""

_EXPECTED = Message("a scan file ({suffixes})", suffixes=", ".join(SCAN_SUFFIXES))
_START = 512


def read_scans(
    path: PathLike | str,
    *,
    options: ReadOptions = AS_IT_IS,
    outside: bool = False,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> list[Scan]:
    """Read every scan of a file, upright and not mirrored.

    Parameters
    ----------
    path : path-like
        The suffix tells the format, in upper or lower case.
    options : ReadOptions
        What a person knows better than the file: its turn, unit, which returns to take.
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

    Examples
    --------
    >>> from reflcolor_addon import read_scans
    >>> for scan in read_scans("garage.ptx"):
    ...     print(scan.name, scan.shape, scan.reflectance.dtype)
    garage (20, 30) float32
    """
    asked = {"options": options, "outside": outside, "progress": progress, "cancelled": cancelled}
    return _with_format(Path(path), lambda kind, file, path: kind.read(file, path, **asked))


def scan_pixels(path: PathLike | str, *, options: ReadOptions = AS_IT_IS, outside: bool = False) -> list[int]:
    """Return how many pixels each scan of a file has, as its header says; its points are not read.

    Of a PTX with several scans only the first one's size is known: the others count as one, estimated from the rest of
    the file. Parameters and errors are those of `read_scans`, as far as the header shows what is wrong.
    """
    return _with_format(Path(path), lambda kind, file, path: kind.pixels(file, path, options=options, outside=outside))


def _with_format(path, act):
    """What ``act(format, file, path)`` gives for a file of a known format."""
    try:
        with opened(path, _EXPECTED, error=ScanError) as file:
            kind = _kind_of(path, file.read(_START))
            file.seek(0)
            # Numbers in untrusted files may overflow; the results are checked against limits, and reported.
            with np.errstate(over="ignore", invalid="ignore", divide="ignore", under="ignore"):
                return act(kind, file, path)
    except MemoryError:
        raise ScanError("{file}: does not fit into memory", file=path.name) from None


def _kind_of(path, start):
    """The Format of a file: by its name, which must not contradict its first bytes."""
    name = path.name.lower()
    named = next((kind for kind in FORMATS if name.endswith(kind.suffixes)), None)
    found = next((kind for kind in FORMATS if kind.sniff is not None and kind.sniff(start)), None)
    suffix = path.suffix.lower()
    if named is None and suffix in REFUSED:
        way = Message(REFUSED[suffix])
        raise ScanError("{file}: this format is not supported. {way}", file=path.name, way=way)
    if named is None:
        known = ", ".join(SCAN_SUFFIXES)
        if found is None:
            raise ScanError("{file}: not a scan file by its name, expected one of {known}", file=path.name, known=known)
        raise ScanError(
            "{file}: not a scan file by its name, expected one of {known}; its contents look like {contents}: rename "
            "it",
            file=path.name,
            known=known,
            contents=found.suffixes[0],
        )
    # Text of plain numbers looks like a PTX where it begins with a count; but a PTX has two, each on a line of its own.
    two_counts = [len(line.split()) for line in start.splitlines()[:2]] == [1, 1]
    if found is not None and found is not named and (named.sniff is not None or two_counts):
        raise ScanError(
            "{file}: its contents look like {contents}: rename it", file=path.name, contents=found.suffixes[0]
        )
    return named
