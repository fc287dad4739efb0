"""PTX: text, one or several scans one after another, each a header and its points column by column."""

import re

import numpy as np

from ...errors import ScanError
from ...messages import Message, one_line
from ..memory import require_memory
from .grid import BYTES_PER_PIXEL, finish_scans
from .poses import ptx_pose
from .text_lines import TextLines

_SHORTEST_LINE = len("0 0 0 0\n")
_WIDTHS = (4, 7, 10)
"""`x y z i`, with `r g b`, with a normal after them."""

_LONGEST_QUOTE = 40
_COUNT = re.compile(r"\d{1,18}(\.0*)?")


def read_ptx(file, path, *, outside=False, progress=None, cancelled=None):
    """Read every scan of a PTX file.

    A scan is: columns, rows; the scanner's position and its three axes (4 lines of 3); a 4 x 4 matrix in row-vector
    convention; then columns x rows lines ``x y z intensity [red green blue]`` in the scanner's own frame, column by
    column. ``0 0 0`` is no return. CRLF, tabs, blank lines and a byte order mark are fine.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    progress, cancelled : callable, optional

    Errors are those of `read_scans`.
    """
    stored = []
    lines = TextLines(file, path, progress=progress, cancelled=cancelled)
    while (line := lines.next_line()) is not None:
        lines.check_cancelled()
        stored.append(_read_scan(lines, line, after=bool(stored)))
    if not stored:
        raise ScanError("{file}: holds no text, expected the header of a PTX scan", file=path.name)
    for index, scan in enumerate(stored):
        scan["name"] = path.stem if len(stored) == 1 else f"{path.stem} {index + 1}"
        scan["pose"], notes = ptx_pose(*scan.pop("placed"), scan["name"])
        scan["warnings"] = notes + [
            Message("scan '{scan}': {note}", scan=scan["name"], note=note) for note in scan["warnings"]
        ]
    return finish_scans(stored, path, cancelled=cancelled)


def _read_scan(lines, first, *, after):
    columns = _count(lines, first, "columns", after)
    header = lines.number
    rows = _count(lines, _header_line(lines, "the number of rows"), "rows", False)
    position = _numbers(lines, 3, "the scanner's position")
    axes = np.array([_numbers(lines, 3, "a scanner axis") for _ in range(3)])
    matrix = np.array([_numbers(lines, 4, "a row of the matrix") for _ in range(4)])

    count, left = columns * rows, lines.bytes_left()
    if count * _SHORTEST_LINE > left + 1:
        raise lines.error(
            "{columns} columns x {rows} rows announced, but the rest of the file ({left} bytes) has room for at most "
            "{most} points; it is cut short, or its header is wrong",
            number=header,
            columns=columns,
            rows=rows,
            left=left,
            most=(left + 1) // _SHORTEST_LINE,
        )
    require_memory(count * BYTES_PER_PIXEL, f"{lines.path.name}: {columns} columns x {rows} rows", error=ScanError)
    body = _Body(lines, columns, rows)
    body.read()
    return {
        "points": body.points.reshape(columns, rows, 3).transpose(1, 0, 2),
        "reflectance": body.intensity.reshape(columns, rows).T,
        "valid": np.ones((rows, columns), bool),
        "color": None if body.color is None else body.color.reshape(columns, rows, 3).transpose(1, 0, 2),
        "placed": (position, axes, matrix),
        "warnings": body.notes(),
    }


class _Body:
    """The lines of points of one scan, in the order of the file."""

    def __init__(self, lines, columns, rows):
        self._lines, self._grid = lines, (columns, rows)
        self.points = np.empty((columns * rows, 3))
        self.intensity = np.empty(columns * rows, np.float32)
        self.color = None
        self._no_color, self._colorless = False, 0

    def read(self):
        count, at = len(self.points), 0
        while at < count:
            first = self._lines.number + 1
            chunk = self._lines.take(count - at)
            if not chunk:
                columns, rows = self._grid
                raise self._lines.error(
                    "the file ends after {at} of {count} points ({columns} columns x {rows} rows); it is cut short",
                    at=at,
                    count=count,
                    columns=columns,
                    rows=rows,
                )
            if any(line and not line.isspace() for line in chunk):
                values = self._parsed(chunk, first)
                self._keep(values, at)
                at += len(values)

    def notes(self):
        """What is to be said about this body."""
        notes = []
        if self._no_color:
            notes.append(Message("its values 5 to 7 are not whole numbers 0..255; taken as a scan without color"))
        elif self.color is not None and self._colorless:
            notes.append(
                Message("{count:,} points have no color among others that have; they are black", count=self._colorless)
            )
        return notes

    def _keep(self, values, at):
        here = slice(at, at + len(values))
        self.points[here] = values[:, :3]
        with np.errstate(over="ignore", invalid="ignore"):
            self.intensity[here] = values[:, 3]
        colored = values.shape[1] > 4
        color = values[:, 4:7] if colored else np.full((len(values), 3), np.nan)
        given = ~np.isnan(color).all(axis=-1)
        self._colorless += np.count_nonzero((values[~given, :3] != 0).any(axis=-1))
        if self._no_color or not given.any():
            return
        color = color[given]
        if not ((color >= 0) & (color <= 255) & (color == np.round(color))).all():
            self.color, self._no_color = None, True
            return
        if self.color is None:
            self.color = np.zeros((len(self.points), 3), np.uint8)
        self.color[here][given] = color

    def _parsed(self, chunk, first):
        """(n, 4, 7 or 10) float64 of the lines that are not blank; NaN for colors that a line does not have."""
        try:
            values = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
        except ValueError:
            return self._parsed_one_by_one(chunk, first)
        return values if values.shape[1] in _WIDTHS else self._parsed_one_by_one(chunk, first)

    def _parsed_one_by_one(self, chunk, first):
        """Slower: for lines that differ in length, and to find the one that is wrong."""
        parsed = []
        for number, line in enumerate(chunk, first):
            words = line.split()
            if words and len(words) not in _WIDTHS:
                raise self._lines.error("expected 4 or 7 values, found {found}", number=number, found=_found(words))
            if words:
                values = [_number(self._lines, word, number) for word in words]
                parsed.append(values + [np.nan] * (max(_WIDTHS) - len(values)))
        return np.array(parsed, np.float64)


def _header_line(lines, what):
    line = lines.next_line()
    if line is None:
        raise lines.error("the file ends where {what} was expected; it is cut short", what=what)
    return line


def _count(lines, line, what, after):
    if _COUNT.fullmatch(line) and (value := int(line.partition(".")[0])) > 0:
        return value
    found = _shortened(line)
    if after:
        raise lines.error(
            "expected the end of the file or the number of columns of the next scan, found '{found}'", found=found
        )
    raise lines.error("expected the number of {what} (a whole number above 0), found '{found}'", what=what, found=found)


def _numbers(lines, count, what):
    words = _header_line(lines, what).split()
    if len(words) != count:
        raise lines.error(
            "expected {what} ({count} numbers), found {found}", what=what, count=count, found=_found(words)
        )
    return np.array([_number(lines, word, lines.number) for word in words])


def _number(lines, word, number):
    try:
        if "_" in word:
            raise ValueError
        return float(word)
    except ValueError:
        raise lines.error("expected a number, found '{found}'", number=number, found=_shortened(word)) from None


def _found(words):
    return f"{len(words)}: '{_shortened(' '.join(words))}'" if len(words) < 4 else str(len(words))


def _shortened(text):
    return one_line(text, _LONGEST_QUOTE)
