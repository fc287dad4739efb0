"""Writes colors into a copy of the E57 that a scan came from; everything else in the file is unchanged."""

import mmap
import os
import sys
from pathlib import Path

import numpy as np

from ...errors import OutputError, ScanError
from ...messages import Message
from ..atomic import written_atomically
from ..confined.child import Child, ChildFailed
from ..confined.reading import OneLine, shared_file
from ..gate import opened, size_of
from ..memory import require_memory
from ..readers.e57 import each_scan
from ..readers.e57_columns import library_of, reason_of
from ..readers.options import AS_IT_IS
from .point_colors import colors_of_points

SCRIPT = Path(__file__).resolve().parent.parent / "confined" / "e57_colors.py"
_BYTES_PER_POINT = 4
_BASE_BYTES, _BYTES_PER_XML_BYTE = 1 << 29, 80
_BASE_SECONDS, _BYTES_PER_SECOND = 30, 500_000
_LARGEST_XML = 1 << 20


def write_e57_colors(source, colors, path, *, options=AS_IT_IS, progress=None, cancelled=None):
    """Write a copy of an E57 in which points have the colors that their scans were given.

    Points, rows and columns, intensity, poses, names, photos and everything else is copied as it is stored. Points that
    are no part of the scan (not valid, or behind others) are marked ``isColorInvalid``.

    Parameters
    ----------
    source : path-like
        The file that the scans were read from.
    colors : dict of int to (H, W, 3) uint8
        sRGB, by the scan's place among those that `read_scans` returns, from 0.
    path : path-like
    options : ReadOptions
        As the scans were read with.
    progress, cancelled : callable, optional

    Returns
    -------
    list of Message
        What could not be kept, and how many points have no color.

    Raises
    ------
    OutputError
        If the file cannot be written, or its scans are of another size by now.
    Cancelled
        If ``cancelled()`` returned True.
    """
    source, path = Path(source), Path(path)
    warnings = []
    with opened(source, Message("an E57 file"), error=ScanError) as file:
        columns, places = _point_colors(file, source, colors, path, options, warnings, _share(progress, 0.0), cancelled)
        file.seek(0)
        with written_atomically(path) as temporary:
            _copy(file, source, columns, places, temporary, path, warnings, _share(progress, 0.5), cancelled)
    return warnings


def _point_colors(file, source, colors, path, options, warnings, progress, cancelled):
    """Four columns of bytes for every scan that has colors, one after the other, and where each begins."""
    parts, places, at = [], {}, 0
    scans = each_scan(file, source, options=options, progress=progress, cancelled=cancelled)
    for index, scan, rgb, known in colors_of_points(scans, colors, path, source):
        part = np.empty((_BYTES_PER_POINT, len(known)), np.uint8)
        part[:3], part[3] = rgb.T, ~known
        parts.append(part)
        places[index] = [at, len(known), not known.all()]
        at += part.size
        if lost := np.count_nonzero(~known):
            warnings.append(
                Message(
                    "{file}: scan '{scan}': {count:,} of {all:,} points have no color: they are not part of its grid",
                    file=path.name,
                    scan=scan.name,
                    count=lost,
                    all=len(known),
                )
            )
    return parts, places


def _copy(file, source, parts, places, temporary, path, warnings, progress, cancelled):
    size = sum(part.size for part in parts)
    require_memory(size, source.name, error=OutputError)
    library, folders = library_of(source)
    number, shown = shared_file(size)
    limits = {
        "memory": _BASE_BYTES + size + _BYTES_PER_XML_BYTE * min(_LARGEST_XML * 64, size_of(file)),
        # Packets and pages add overhead to every byte, and a point with colors has more bytes.
        "written": 2 * size_of(file) + 16 * size + (1 << 24),
        "seconds": _BASE_SECONDS + (size_of(file) + size) // _BYTES_PER_SECOND,
    }
    try:
        with mmap.mmap(number, size) as memory:
            at = 0
            for part in parts:
                memory[at : at + part.size] = part.tobytes()
                at += part.size
        handed_on = sys.platform != "win32"
        with (
            OneLine(source, "E57"),
            Child(
                SCRIPT,
                inherited=[file.fileno(), number] if handed_on else [],
                cancelled=cancelled,
                memory=limits["memory"],
                seconds=limits["seconds"],
            ) as child,
        ):
            child.ask(
                {
                    "library": str(library),
                    "folders": folders,
                    "file": [file.fileno() if handed_on else None, str(source)],
                    "columns": [number if handed_on else None, shown],
                    "output": str(temporary),
                    "scans": places,
                    **limits,
                }
            )
            _follow(child, source, path, warnings, progress)
    finally:
        os.close(number)
        if shown:
            Path(shown).unlink(missing_ok=True)


def _follow(child, source, path, warnings, progress):
    while True:
        answer = child.answer()
        if "done" in answer:
            return
        if isinstance(answer.get("error"), str):
            reason = reason_of(answer["error"], unknown=Message("see whether the disk is full"))
            raise OutputError("{file}: cannot be written: {reason}", file=path, reason=reason)
        if isinstance(answer.get("lost"), str):
            warnings.append(
                Message(
                    "{file}: the field {field} of {source} holds text and could not be kept",
                    file=path.name,
                    field=answer["lost"],
                    source=source.name,
                )
            )
        elif isinstance(answer.get("at"), int) and progress:
            progress(answer["at"] / 1000, Message("Writing {name}", name=path.name))
        elif not ({"ready", "at"} & answer.keys()):
            raise ChildFailed("garbage")


def _share(progress, start):
    """A ``progress`` for one half of the work."""
    return None if progress is None else lambda fraction, text: progress(start + fraction / 2, text)
