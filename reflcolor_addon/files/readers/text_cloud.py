"""PTS, XYZ and other texts of points, one to a line, without a grid."""

import re

import numpy as np

from ...errors import ReflcolorError, ScanError
from ...scan.limits import MOST_PIXELS
from ..gate import opened
from .cloud import check_size, require_grid, scan_of_columns
from .formats import Format
from .options import AS_IT_IS
from .text_lines import TextLines

_WIDTHS = {3: "", 4: "i", 6: "rgb", 7: "irgb"}
_INTENSITY_LAST = "rgbi"
"""CloudCompare writes colors before all else; lines of 7 are so where the numbers show it."""

_TELLING = slice(0, 20)
_NOT_OF_A_NAME = re.compile(r"[\[(].*|^[/#\"']+|[\"']+$")
_SHORTEST_LINE = 6
# Bytes from the beginning of a file in which a point is looked for.
_START = 4096
_LINES_TO_MEASURE = 4096


def read_text_cloud(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read points, a line each: ``x y z``, ``x y z i``, ``x y z r g b`` or ``x y z i r g b``, between blanks or commas.

    A line of names tells of other columns, in any order. A first line with the number of points (PTS), and lines that
    begin with ``#`` or ``//``, are left out. Parameters and errors are those of `read_scans`.
    """
    lines = TextLines(file, path, telling=_TELLING, progress=progress, cancelled=cancelled)
    parts, width, names, total = [], None, None, 0
    check_size(path, lines.size // _SHORTEST_LINE // 4, 7, by_angle=True)
    first = True
    while chunk := lines.take(1 << 20):
        chunk = [line.replace(",", " ").replace(";", " ") for line in chunk]
        if first:
            names = _names_in(chunk)
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
            names = names if names is not None and len(names) == width else None
        if (names is None and width not in _WIDTHS) or found.shape[1] != width:
            raise lines.error("expected 3, 4, 6 or 7 numbers, found {count}", count=found.shape[1])
        parts.append(found)
        total += len(found)
        if total > MOST_PIXELS:
            raise ScanError("{file}: holds more than {count:,} points", file=path.name, count=MOST_PIXELS)
    if not parts:
        raise ScanError("{file}: holds no points", file=path.name)
    table = np.concatenate(parts)
    if names is None:
        names = [*"xyz", *(_INTENSITY_LAST if _colors_come_first(table) else _WIDTHS[width])]
    return [scan_of_columns(path, dict(zip(names, table.T, strict=True)), options=options)]


def _names_in(chunk):
    """The names of the columns, in lower case, as a line before the first point has them; None where none does."""
    for line in chunk[: _TELLING.stop]:
        if _is_point(line):
            return None
        names = [_NOT_OF_A_NAME.sub("", word).lower() for word in line.split()]
        names = names if names and names[0] else names[1:]
        if set("xyz") <= set(names):
            return names
    return None


def _colors_come_first(table):
    """Whether lines of 7 numbers are x y z r g b i, not x y z i r g b."""
    if table.shape[1] != len("xyz") + len(_INTENSITY_LAST):
        return False

    def are_levels(columns):
        return bool(((columns >= 0) & (columns <= 255) & (columns == np.round(columns))).all())

    return are_levels(table[:, 3:6]) and not are_levels(table[:, 4:7])


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
