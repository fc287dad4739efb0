"""PTX: text, one or several scans one after another, each a header and its points column by column."""

import re
from functools import partial

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message, of_scan, one_line
from ...scan.coherence import line_length
from ...scan.limits import MOST_PIXELS
from ..memory import require_memory
from .angle import gridded_by_angle
from .cloud import Place
from .colors import scaled_colors
from .formats import Format
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_grid, with_problems
from .options import ANGLE, AS_IT_IS
from .poses import ptx_pose
from .text_lines import TextLines

_SHORTEST_LINE = len("0 0 0 0\n")
_WIDTHS = (4, 7, 10)
"""`x y z i`, with `r g b`, with a normal after them."""

_LINES = 1 << 14
"""Lines that are parsed at once where the fast parser cannot read them."""

_LONGEST_QUOTE = 40
_COUNT = re.compile(r"\d{1,18}(\.0*)?")
_NO_NUMBER = re.compile(r"[-+]?(?:nan\([^)\s]*\)|\d\.#[A-Za-z]+\d*)", re.IGNORECASE)
"""What Windows programs print for NaN and infinity: -nan(ind), 1.#QNAN."""

END_MARKS = "\x1a\x00 \t"


def read_ptx(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read every scan of a PTX file.

    A scan is: columns, rows; the scanner's position and its three axes (4 lines of 3); a 4 x 4 matrix in row-vector
    convention; then columns x rows lines ``x y z intensity [red green blue]`` in the scanner's own frame, column by
    column. ``0 0 0`` is no return, and so is what is no number. CRLF, tabs, blank lines, a byte order mark and what
    old programs put at the end of a file are fine. Of a file that is cut short what is whole is kept.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    options : ReadOptions
    progress, cancelled : callable, optional

    Errors are those of `read_scans`.
    """
    read = [scan for scan, *_ in each_scan(file, path, options=options, progress=progress, cancelled=cancelled)]
    finished = [scan for scan in read if not isinstance(scan, UnusableScan)]
    return with_problems(finished, [scan for scan in read if isinstance(scan, UnusableScan)], len(read), path)


def each_scan(file, path, *, options=AS_IT_IS, progress=None, cancelled=None):
    """Yield for every scan of a PTX file, in its order, (scan, order, cells), as the one of E57 does.

    ``cells()`` has one number for each line of points of the scan.
    """
    stored = _stored_scans(file, path, options, progress, cancelled)
    while stored:
        if cancelled and cancelled():
            raise Cancelled
        scan = stored.pop(0)
        cells = scan.pop("cells")
        try:
            if options.grid == ANGLE:
                by_angle = _by_angle(scan, cells(), path, options)
                cells = partial(np.asarray, by_angle)
            yield (*finish_grid(source=path, **scan), cells)
        except UnusableScan as error:
            yield error, None, None


def _by_angle(stored, cells, path, options):
    """Put the points of stored grids onto one by angle; return where each line of the file goes then."""
    place = Place(file_name=path.name, name=stored["name"])

    def warn(template, **values):
        stored["warnings"].append(of_scan(place.name, template, **values))

    def flat(grid):
        return None if grid is None else grid.reshape(-1, *grid.shape[2:])[np.maximum(cells, 0)]

    points, named = flat(stored["points"]), [np.zeros(3), *stored["places"].values()]
    valid = (cells >= 0) & (points != 0).any(axis=-1)
    strength, color = flat(stored["reflectance"]), flat(stored["color"])
    arrays, cells = gridded_by_angle(place, points, valid, strength, color, named, options, warn)
    stored.update(arrays)
    return cells


def _stored_scans(file, path, options, progress, cancelled):
    """Keyword arguments of `finish_grid` for every scan, and ``cells``."""
    stored = []
    lines = TextLines(file, path, progress=progress, cancelled=cancelled)
    rest = None
    while rest is None and (line := lines.next_line()) is not None:
        lines.check_cancelled()
        if not line.strip(END_MARKS):
            continue
        if stored and not _COUNT.fullmatch(line):
            rest = Message(
                "line {line}: what follows its last scan is not a scan and was left out: '{found}'",
                line=lines.number,
                found=_shortened(line),
            )
            break
        try:
            stored.append(_read_scan(lines, line, after=bool(stored), options=options))
        except _CutShort as cut:
            if not stored:
                raise cut.error from None
            rest = Message("its scan {number} was left out: {reason}", number=len(stored) + 1, reason=cut.error.message)
    if not stored:
        raise ScanError("{file}: holds no text, expected the header of a PTX scan", file=path.name)
    for index, scan in enumerate(stored):
        scan["name"] = path.stem if len(stored) == 1 else f"{path.stem} {index + 1}"
        position, axes, matrix = scan.pop("placed")
        scan["pose"], notes = ptx_pose(position, axes, matrix, scan["name"])
        scan["places"] = {
            name: place for name, place in (("matrix", matrix[3, :3]), ("position", position)) if place.any()
        }
        if np.array_equal(matrix[3, :3], position):
            scan["places"].pop("position", None)
        scan["options"] = options
        scan["warnings"] = notes + [
            Message("scan '{scan}': {note}", scan=scan["name"], note=note) for note in scan["warnings"]
        ]
    if rest is not None:
        stored[-1]["warnings"].append(Message("scan '{scan}': {note}", scan=stored[-1]["name"], note=rest))
    return stored


class _CutShort(Exception):
    """A scan ends before it is whole."""

    def __init__(self, error):
        self.error = error
        super().__init__(str(error))


def _read_scan(lines, first, *, after, options):
    try:
        columns = _count(lines, first, Message("columns"), after)
        header = lines.number
        rows = _count(lines, _header_line(lines, Message("the number of rows")), Message("rows"), False)
        position = _numbers(lines, 3, Message("the scanner's position"))
        axes = np.array([_numbers(lines, 3, Message("a scanner axis")) for _ in range(3)])
        matrix = np.array([_numbers(lines, 4, Message("a row of the matrix")) for _ in range(4)])
    except ScanError as error:
        if lines.at_end():
            raise _CutShort(error) from None
        raise
    count, left = columns * rows, lines.bytes_left()
    room = (left + 1) // _SHORTEST_LINE
    short = count > room and (after or count > MOST_PIXELS or room < 2 * rows)
    if short:
        announced = lines.error(
            "{columns} columns x {rows} rows announced, but the rest of the file ({left} bytes) has room for at most "
            "{most} points; it is cut short, or its header is wrong",
            number=header,
            columns=columns,
            rows=rows,
            left=left,
            most=room,
        )
        raise _CutShort(announced)
    count = min(count, room)
    require_memory(
        count * BYTES_PER_PIXEL,
        Message("{file}: {columns} columns x {rows} rows", file=lines.path.name, columns=columns, rows=rows),
        error=ScanError,
    )
    body = _Body(lines, count)
    found = body.read()
    notes = body.notes()
    if found < columns * rows:
        ended = lines.error(
            "the file ends after {at} of {count} points ({columns} columns x {rows} rows); it is cut short",
            at=found,
            count=columns * rows,
            columns=columns,
            rows=rows,
        )
        # If there is only one scan, its complete columns are better than nothing.
        if after or found < 2 * rows:
            raise _CutShort(ended)
        notes.append(Message("{reason}; its complete columns were read", reason=ended.message))
    return {**_in_lines(body, found, columns, rows, notes), "placed": (position, axes, matrix), "warnings": notes}


def _in_lines(body, found, columns, rows, notes):
    """The body as grids: one line of the file after the other is a column, unless its points tell otherwise."""
    length = rows
    if rows != columns:
        x, y, z = body.points[:found].T
        length = line_length(body.points[:found], (x != 0) | (y != 0) | (z != 0), (rows, columns))
    if length != rows:
        notes.append(
            Message(
                "its points follow each other in lines of {length}, not of {rows} as its header says; they were read "
                "that way",
                length=length,
                rows=rows,
            )
        )
    lines = found // length

    def grid(values):
        return (
            None
            if values is None
            else values[: lines * length].reshape(lines, length, *values.shape[1:]).swapaxes(0, 1)
        )

    return {
        "cells": partial(_cells, found, lines, length),
        "points": grid(body.points),
        "reflectance": grid(body.intensity),
        "valid": np.ones((length, lines), bool),
        "color": grid(body.color_in_8_bits(notes)),
    }


def _cells(found, lines, length):
    """(N,) pixel of each line of points of the file, in a grid of so many columns; -1 behind the last whole one."""
    cells = np.full(found, -1)
    cells[: lines * length] = np.arange(length * lines).reshape(length, lines).T.ravel()
    return cells


class _Body:
    """The lines of points of one scan, in the order of the file."""

    def __init__(self, lines, count):
        self._lines = lines
        self.points = np.zeros((count, 3))
        self.intensity = np.zeros(count, np.float32)
        self._color = None
        self._no_color, self._colorless = False, 0

    def read(self):
        """Read as many points as were announced, or as there are; return how many."""
        count, at = len(self.points), 0
        while at < count:
            values = self._lines.take_numbers(count - at, _WIDTHS)
            plain = values is not None
            if not plain:
                first = self._lines.number + 1
                chunk = self._lines.take(min(count - at, _LINES))
                if not chunk:
                    break
                if not any(line and not line.isspace() for line in chunk):
                    continue
                values = self._parsed(chunk, first)
            self._keep(values, at, plain)
            at += len(values)
        return at

    def notes(self):
        """What is to be said about this body."""
        notes = []
        if self._color is not None and self._colorless:
            notes.append(
                Message("{count:,} points have no color although others do; they are black", count=self._colorless)
            )
        return notes

    def color_in_8_bits(self, notes):
        """(N, 3) uint8 of the colors, None where there are none; what is to be said of them is added to the notes."""
        if self._color is None:
            return None
        # Values of 8 bits are kept as they are, unless they are all zeros and ones.
        if self._color.dtype == np.uint8 and self._color.max() > 1:
            return self._color
        return scaled_colors(self._color, None, lambda template, **values: notes.append(Message(template, **values)))

    def _keep(self, values, at, plain):
        """Keep values as the points from ``at`` on; plain ones are all numbers."""
        here = slice(at, at + len(values))
        self.points[here] = values[:, :3]
        with np.errstate(over="ignore", invalid="ignore"):
            self.intensity[here] = values[:, 3]
        colored = values.shape[1] > 4
        if plain and colored and self._color is not None and self._color.dtype == np.uint8:
            with np.errstate(invalid="ignore"):
                self._color[here] = values[:, 4:7]
            if np.array_equal(self._color[here], values[:, 4:7]):
                return
        color = values[:, 4:7] if colored else np.full((len(values), 3), np.nan)
        given = ~np.isnan(color).all(axis=-1)
        self._colorless += np.count_nonzero((values[~given, :3] != 0).any(axis=-1))
        if not given.any():
            return
        color = color[given]
        if self._color is None:
            self._color = np.zeros((len(self.points), 3), np.uint8)
        if self._color.dtype == np.uint8 and not ((color >= 0) & (color <= 255) & (color == np.round(color))).all():
            self._color = self._color.astype(np.float32)
        with np.errstate(over="ignore", invalid="ignore"):
            self._color[here][given] = color

    def _parsed(self, chunk, first):
        """(n, 4, 7 or 10) float64 of the lines that are not blank; NaN for colors that a line does not have."""
        if any("#" in line or "(" in line for line in chunk):
            chunk = [_NO_NUMBER.sub("nan", line) for line in chunk]
        try:
            values = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
        except ValueError:
            return self._parsed_one_by_one(chunk, first)
        return values if values.shape[1] in _WIDTHS else self._parsed_one_by_one(chunk, first)

    def _parsed_one_by_one(self, chunk, first):
        """Slower: for lines that differ in length, and to find the one that is wrong."""
        parsed = []
        for number, line in enumerate(chunk, first):
            words = line.strip(END_MARKS).split()
            if not words:
                continue
            try:
                if len(words) not in _WIDTHS:
                    raise self._lines.error("expected 4 or 7 values, found {found}", number=number, found=_found(words))
                values = [_number(self._lines, word, number) for word in words]
            except ScanError:
                # The last line of the file was cut off, not written wrongly.
                if number == self._lines.number and self._lines.at_end():
                    break
                raise
            parsed.append(values + [np.nan] * (max(_WIDTHS) - len(values)))
        return np.array(parsed, np.float64).reshape(-1, max(_WIDTHS))


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


def _is_ptx(start):
    text = start.removeprefix(b"\xef\xbb\xbf").split()
    return len(text) > 2 and text[0].isdigit() and text[1].isdigit() and len(start.splitlines()[0].split()) == 1


FORMAT = Format(
    name="PTX",
    suffixes=(".ptx",),
    read=read_ptx,
    sniff=_is_ptx,
    about="one or several scans, in any order of rows and columns",
)
