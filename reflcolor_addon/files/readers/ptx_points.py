"""The lines of points of one scan of a PTX file, laid on a grid as they are read."""

import re
from functools import partial

import numpy as np

from ...errors import ScanError
from ...messages import Message, one_line
from ...scan.coherence import LineLength
from .colors import scaled_colors
from .text_lines import TextLines

_WIDTHS, _BARE = (4, 7, 10), (3, 6)
"""`x y z i`, with `r g b`, with a normal after them; and of programs that know no intensity."""

_LINES = 1 << 14
"""Lines that are parsed at once where the fast parser cannot read them."""

_LONGEST_QUOTE = 40
_NO_NUMBER = re.compile(r"[-+]?(?:nan\([^)\s]*\)|\d\.#[A-Za-z]+\d*)", re.IGNORECASE)
"""What Windows programs print for NaN and infinity: -nan(ind), 1.#QNAN."""

_TELLING = slice(2, 11)
"""The rest of the header, and the first point."""

END_MARKS = "\x1a\x00 \t"


def ptx_lines(file, path, *, progress=None, cancelled=None):
    """Return the TextLines of a PTX file."""
    return TextLines(file, path, telling=_TELLING, progress=progress, cancelled=cancelled)


class PointLines:
    """Reads the points of a scan: one line of the file after the other is a column, unless the points tell otherwise.

    Parameters
    ----------
    lines : TextLines
        Behind the header.
    count : int
        Points to read at most.
    sizes : (rows, columns)
        As the header states them.
    step : int
        Which rows and columns to keep: the first, and every one so many behind; the others never take memory.
    """

    def __init__(self, lines, count, sizes, step):
        self._lines, self._count, self._step = lines, count, step
        lengths = dict.fromkeys(sizes)
        self._length = LineLength(count, tuple(lengths)) if len(lengths) > 1 else None
        self._seen = np.zeros((0 if self._length is None else len(self._length.places), 3))
        # Whole grids can be laid anew; of thinned ones every length has its own.
        self._stated = sizes[0]
        self._grids = {length: _Grid(count, length, step) for length in (lengths if step > 1 else sizes[:1])}
        self._has_color, self._colorless = False, 0
        # Which of the two groups of widths the lines have, as the first point tells.
        self._bare = None

    def read(self):
        """Read as many points as were announced, or as there are; return how many."""
        count, at = self._count, 0
        while at < count:
            values = self._lines.take_numbers(count - at, self._widths)
            plain = values is not None
            if not plain:
                first = self._lines.number + 1
                chunk = self._lines.take(min(count - at, _LINES))
                if not chunk:
                    break
                if not any(line and not line.isspace() for line in chunk):
                    continue
                values = self._parsed(chunk, first)
            if self._bare is None and (values.shape[1] not in _BARE or values.any()):
                self._bare = values.shape[1] in _BARE
            self._keep(values, at, plain)
            at += len(values)
        return at

    @property
    def _widths(self):
        return (*_WIDTHS, *_BARE) if self._bare is None else _BARE if self._bare else _WIDTHS

    def notes(self):
        """What is to be said about this body."""
        if not self._has_color or not self._colorless:
            return []
        return [Message("{count:,} points have no color although others do; they are black", count=self._colorless)]

    def grids(self, found, notes):
        """Keyword arguments of `finish_grid` for the first ``found`` points; what is to be said is added to the notes.

        Returns
        -------
        dict
            ``points``, ``reflectance``, ``valid``, ``color``, and ``cells``: a function that returns (N,) int64, the
            pixel of each line of points, row by row; -1 behind the last whole column.
        """
        length = self._stated
        if self._length is not None:
            length = self._length.of(self._seen, (self._seen != 0).any(axis=-1))
        if length != self._stated:
            notes.append(
                Message(
                    "its points follow each other in lines of {length}, not of {rows} as its header says; they were "
                    "read that way",
                    length=length,
                    rows=self._stated,
                )
            )
        grid = self._grids.get(length) or self._grids[self._stated].in_lines_of(length)
        points, intensity, color = grid.columns(found // length)
        return {
            "cells": partial(grid.cells, found),
            "points": points,
            "reflectance": None if self._bare else intensity,
            "valid": np.ones(intensity.shape, bool),
            "color": None if color is None else _in_8_bits(color, notes),
        }

    def _keep(self, values, at, plain):
        """Keep values as the points from ``at`` on; plain ones are all numbers."""
        if self._length is not None:
            first, behind = np.searchsorted(self._length.places, (at, at + len(values)))
            self._seen[first:behind] = values[self._length.places[first:behind] - at, :3]
        if values.shape[1] in _BARE:
            # No intensity; the colors, where there are any, in their usual place.
            values = np.insert(values, 3, 0.0, axis=1)
        with np.errstate(over="ignore", invalid="ignore"):
            intensity = values[:, 3].astype(np.float32)
        color = self._color(values, plain)
        self._has_color |= color is not None
        for grid in self._grids.values():
            grid.lay(at, values[:, :3], intensity, color)

    def _color(self, values, plain):
        """(n, 3) uint8 of values, or float32 where they are no such numbers; None where there are none."""
        colored = values.shape[1] > 4
        if plain and colored:
            with np.errstate(invalid="ignore"):
                levels = values[:, 4:7].astype(np.uint8)
            if np.array_equal(levels, values[:, 4:7]):
                return levels
        color = values[:, 4:7] if colored else np.full((len(values), 3), np.nan)
        given = ~np.isnan(color).all(axis=-1)
        self._colorless += np.count_nonzero((values[~given, :3] != 0).any(axis=-1))
        if not given.any():
            return None
        some = color[given]
        whole = ((some >= 0) & (some <= 255) & (some == np.round(some))).all()
        with np.errstate(over="ignore", invalid="ignore"):
            return np.where(given[:, None], color, 0).astype(np.uint8 if whole else np.float32)

    def _parsed(self, chunk, first):
        """(n, width) float64 of the lines that are not blank; NaN for colors that a line does not have."""
        if any("#" in line or "(" in line for line in chunk):
            chunk = [_NO_NUMBER.sub("nan", line) for line in chunk]
        try:
            values = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
        except ValueError:
            return self._parsed_one_by_one(chunk, first)
        return values if values.shape[1] in self._widths else self._parsed_one_by_one(chunk, first)

    def _parsed_one_by_one(self, chunk, first):
        """Slower: for lines that differ in length, and to find the one that is wrong."""
        parsed = []
        for number, line in enumerate(chunk, first):
            words = line.strip(END_MARKS).split()
            if not words:
                continue
            try:
                if len(words) not in self._widths and not _is_nothing(words):
                    raise self._lines.error("expected 4 or 7 values, found {found}", number=number, found=shown(words))
                values = [number_of(self._lines, word, number) for word in words]
            except ScanError:
                # The last line of the file was cut off, not written wrongly.
                if number == self._lines.number and self._lines.at_end():
                    break
                raise
            if len(values) in _BARE:
                values.insert(3, 0.0)
            parsed.append(values + [np.nan] * (max(_WIDTHS) - len(values)))
            if self._bare is None and any(values[:3]):
                self._bare = len(words) in _BARE
        return np.array(parsed, np.float64).reshape(-1, max(_WIDTHS))


class _Grid:
    """Points that follow each other in lines of some length, each line a column; of these every ``step``-th is kept."""

    def __init__(self, count, length, step):
        self.length, self._step = length, step
        lines = -(-count // length)
        self._shape = (-(-length // step), -(-lines // step))
        self._points, self._intensity = np.zeros((*self._shape, 3)), np.zeros(self._shape, np.float32)
        self._color = None

    def lay(self, at, points, intensity, color):
        """Lay points of the file from number ``at`` on."""
        if color is not None:
            if self._color is None:
                self._color = np.zeros((*self._shape, 3), color.dtype)
            elif color.dtype != self._color.dtype and self._color.dtype == np.uint8:
                self._color = self._color.astype(color.dtype)
        for grid, values in ((self._points, points), (self._intensity, intensity), (self._color, color)):
            if values is not None and self._step == 1:
                _lay(grid, at, values)
        if self._step > 1:
            line, place = np.divmod(np.arange(at, at + len(points)), self.length)
            kept = (line % self._step == 0) & (place % self._step == 0)
            where = place[kept] // self._step, line[kept] // self._step
            for grid, values in ((self._points, points), (self._intensity, intensity), (self._color, color)):
                if values is not None:
                    grid[where] = values[kept]

    def in_lines_of(self, length):
        """The same points in lines of another length."""
        count = self._intensity.size
        other = _Grid(count, length, 1)
        arrays = (self._points, self._intensity, self._color)
        flat = [None if array is None else _in_file_order(array)[:count] for array in arrays]
        other.lay(0, *flat)
        return other

    def columns(self, lines):
        """Points, intensity and colors or None of the first lines of the file."""
        kept = -(-lines // self._step)
        arrays = (self._points, self._intensity, self._color)
        return [None if array is None else array[:, :kept] for array in arrays]

    def cells(self, found):
        """(N,) pixel of each of the first points, row by row; -1 behind the last whole line."""
        lines, cells = found // self.length, np.full(found, -1)
        rows, columns = np.arange(self.length) // self._step, np.arange(lines) // self._step
        cells[: lines * self.length] = (rows * -(-lines // self._step) + columns[:, None]).ravel()
        return cells


def _lay(grid, at, values):
    """Fill an (H, W, ...) grid column by column, from point number ``at`` on."""
    height = grid.shape[0]
    while len(values):
        column, row = divmod(at, height)
        if row or len(values) < height:
            done = min(height - row, len(values))
            grid[row : row + done, column] = values[:done]
        else:
            columns = len(values) // height
            done = columns * height
            lines = values[:done].reshape(columns, height, *values.shape[1:])
            # One channel after the other: many times faster than three numbers at a time.
            for channel in np.ndindex(values.shape[1:]):
                grid[(slice(None), slice(column, column + columns), *channel)] = lines[(..., *channel)].T
        at, values = at + done, values[done:]


def _in_file_order(grid):
    return grid.swapaxes(0, 1).reshape(-1, *grid.shape[2:])


def _in_8_bits(color, notes):
    """(H, W, 3) uint8, or None where the values are no colors."""
    # Values of 8 bits are kept as they are, unless they are all zeros and ones.
    if color.dtype == np.uint8 and color.max() > 1:
        return color
    return scaled_colors(color, None, lambda template, **values: notes.append(Message(template, **values)))


def _is_nothing(words):
    """Whether they are three zeros, which some programs write where there is no return, whatever other lines hold."""
    return len(words) == 3 and not "".join(words).strip("+-0.")


def number_of(lines, word, number):
    """The float of a word; a ScanError that names its line where it is none."""
    try:
        if "_" in word:
            raise ValueError
        return float(word)
    except ValueError:
        raise lines.error("expected a number, found '{found}'", number=number, found=shortened(word)) from None


def shown(words):
    """Words of a line, or how many there are, for messages."""
    return f"{len(words)}: '{shortened(' '.join(words))}'" if len(words) < 4 else str(len(words))


def shortened(text):
    """A piece of the file, for messages."""
    return one_line(text, _LONGEST_QUOTE)
