"""Writes colorized scans as scan files again, for programs that process them further."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...errors import OutputError
from ...messages import Message
from ...scan.scan import Scan
from ..readers.options import AS_IT_IS, ReadOptions
from .e57 import write_e57
from .e57_colors import write_e57_colors
from .ptx import write_ptx
from .ptx_colors import write_ptx_colors

SCAN_FILES = (".e57", ".ptx")
"""The formats that colorized scans can be written back to."""

_COPIES = {".e57": write_e57_colors, ".ptx": write_ptx_colors}
_DECIMALS = 9


@dataclass(frozen=True, eq=False, kw_only=True)
class ColoredScan:
    """A scan and the colors that it was given.

    Parameters
    ----------
    scan : Scan
    rgb : (H, W, 3) uint8
    source : Path or None
        The file that it was read from, if that is still there as it was.
    index : int or None
        Its place among the scans of that file, from 1.
    options : ReadOptions
        How that was read.
    """

    scan: Scan
    rgb: np.ndarray
    source: Path | None = None
    index: int | None = None
    options: ReadOptions = AS_IT_IS


def write_scans_back(colored, path, *, progress=None, cancelled=None):
    """Write colorized scans as E57 or PTX.

    Where all are of one file of the same format, the result is a copy of it with colors. Else it is made anew, with
    what a `Scan` holds: grid, points, reflectance, pose and name.

    Parameters
    ----------
    colored : list of ColoredScan
    path : path-like
        Ends in one of `SCAN_FILES`.
    progress, cancelled : callable, optional

    Returns
    -------
    list of Message
        What was not kept.

    Raises
    ------
    OutputError
        If the file cannot be written.
    Cancelled
        If ``cancelled()`` returned True.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    sources, ways = {scan.source for scan in colored}, {scan.options for scan in colored}
    source = sources.pop() if len(sources) == len(ways) == 1 else None
    if source is not None and source.suffix.lower() == suffix:
        colors = {scan.index - 1: scan.rgb for scan in colored}
        if len(colors) < len(colored):
            raise OutputError(
                "{file}: two of the scans are the same scan of {source}; it has room for one: export them one by one",
                file=path.name,
                source=source.name,
            )
        return _COPIES[suffix](source, colors, path, options=ways.pop(), progress=progress, cancelled=cancelled)
    scans = [replace(scan.scan, color=scan.rgb) for scan in colored]
    if progress:
        progress(0.5, Message("Writing {name}", name=path.name))
    if suffix == ".ptx":
        write_ptx(scans, path, decimals=_DECIMALS)
    else:
        write_e57(scans, path)
    return [
        Message(
            "{file}: written anew, not copied from one {format} file: grid, points, reflectance, pose and name were "
            "kept, nothing else",
            file=path.name,
            format=suffix.removeprefix(".").upper(),
        )
    ]
