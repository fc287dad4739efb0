"""PTS, XYZ and other texts of points, one to a line, without a grid."""

import numpy as np

from ...errors import ReflcolorError, ScanError
from ...scan.limits import MOST_PIXELS
from ..gate import opened
from .cloud import check_size, require_grid, scan_of_columns
from .formats import Format
from .options import AS_IT_IS
from .text_lines import TextLines

_WIDTHS = {3: "", 4: "i", 6: "rgb", 7: "irgb"}
_SHORTEST_LINE = 6
# Bytes from the beginning of a file in which a point is looked for.
_START = 4096
_LINES_TO_MEASURE = 4096


def read_text_cloud(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read points, a line each: ``x y z``, ``x y z i``, ``x y z r g b`` or ``x y z i r g b``, between blanks or commas.

    A first line with their number (PTS), a line of names, and lines that begin with ``#`` or ``//`` are left out.
    Parameters and errors are those of `read_scans`.
    """
    lines = TextLines(file, path, progress=progress, cancelled=cancelled)
    parts, width, total = [], None, 0
    check_size(path, lines.size // _SHORTEST_LINE // 4, 7)
    first = True
    while chunk := lines.take(1 << 20):
        chunk = [line.replace(",", " ").replace(";", " ") for line in chunk]
        chunk = [line for line in chunk if line and not line.isspace() and not line.lstrip().startswith(("#", "//"))]
        if first and chunk:
            chunk, first = chunk[_lines_before(chunk) :], False
        if not chunk:
            continue
        try:
            found = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
        except ValueError:
            raise lines.error("expected points as lines of 3, 4, 6 or 7 numbers, all lines alike") from None
        if width is None:
            width = found.shape[1]
        if width not in _WIDTHS or found.shape[1] != width:
            raise lines.error("expected 3, 4, 6 or 7 numbers, found {count}", count=found.shape[1])
        parts.append(found)
        total += len(found)
        if total > MOST_PIXELS:
            raise ScanError("{file}: holds more than {count:,} points", file=path.name, count=MOST_PIXELS)
    if not parts:
        raise ScanError("{file}: holds no points", file=path.name)
    table = np.concatenate(parts)
    columns = dict(zip("xyz", table.T, strict=False)) | dict(zip(_WIDTHS[width], table.T[3:], strict=True))
    return [scan_of_columns(path, columns, options=options)]


def text_cloud_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return about how many points a text has, by the length of its lines; see `scan_pixels`."""
    require_grid(path, "xyz", options=options)
    lines = TextLines(file, path)
    some = lines.take(_LINES_TO_MEASURE)
    return [max(1, round(lines.size * len(some) / max(sum(len(line) + 1 for line in some), 1)))]


def begins_with_points(path):
    """Whether a text file holds a point within its first lines; also where it cannot be opened, which is told later."""
    try:
        with opened(path, "a scan file", may_be_empty=True) as file:
            start = file.read(_START).decode("utf-8", errors="replace")
    except ReflcolorError:
        return True
    return any(_is_point(line) for line in start.replace(",", " ").replace(";", " ").splitlines())


def _is_point(line):
    try:
        return len([float(word) for word in line.split()]) >= min(_WIDTHS)
    except ValueError:
        return False


def _lines_before(chunk):
    """How many lines stand before the first point: a count, or names."""
    for number, line in enumerate(chunk[:2]):
        words = line.split()
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            continue
        if len(numbers) > 1:
            return number
    return min(2, len(chunk)) if len(chunk[0].split()) == 1 else 1


FORMAT = Format(
    name="PTS and texts",
    suffixes=(".pts", ".xyz", ".txt", ".asc", ".csv"),
    read=read_text_cloud,
    pixels=text_cloud_pixels,
    sniff=None,
    about="points without a grid, a line each, with --grid angle",
)
