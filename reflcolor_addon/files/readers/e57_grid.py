"""From the list of points that an E57 file holds to a grid: rows and columns, and which of several returns counts."""

import math

import numpy as np

from ...errors import ScanError
from ...messages import Message
from ..memory import require_memory
from .grid import BYTES_PER_PIXEL, UnusableScan
from .grid_memory import strips
from .options import BY_ANGLE, LIGHTER

_CELLS_PER_POINT = 1000
# How many times larger than the extent of the points the bounds stated in a file may be: a small scene under a large
# sky, but not the range of the file's number format.
_MOST_MARGIN = 16
"""A grid emptier than this is no scan: its row or column numbers are wrong."""

_LARGEST_INDEX = 2**40
_ONE_DIRECTION_DEG = 2.0
"""Largest angle between the returns of one pulse, with the scanner slightly away from its stated position."""

_COUNTED_BACK = 0.9
"""Share of returns that are nearer than the one before them, from which on the numbers count from the farthest. A pulse
meets what is nearest first."""

_TAKEN = {
    "first": "{pixels:,} pixels have several returns; the first was taken, {count:,} others were left out",
    "strongest": "{pixels:,} pixels have several returns; the strongest was taken, {count:,} others were left out",
    "last": "{pixels:,} pixels have several returns; the last was taken, {count:,} others were left out",
}


class IndexGrid:
    """Where the points of a scan belong.

    Parameters
    ----------
    rows, columns : (N,) int32 or float64
        Index of every point, of any sign, from any start.
    limits : dict
        (low, high) of ``rowIndex`` and ``columnIndex`` as the file states them, each may be None.
    header : E57Header
        For messages.

    Raises
    ------
    UnusableScan
        If the indices are no whole numbers, or span a grid that is nearly empty.
    ScanError
        If the grid does not fit into memory.

    Attributes
    ----------
    shape, first : (H, W), (row, column)
        Size of the grid, and the index that its first row and column have.
    """

    def __init__(self, rows, columns, limits, header):
        self._place = header.place
        most = _CELLS_PER_POINT * (len(rows) + 1000)
        # The file's own bounds show margins without points; they are ignored where they are far larger than the points'
        # extent.
        for stated in (limits, {field: (None, None) for field in limits}):
            first_row, height = self._extent(rows, "rowIndex", stated)
            first_column, width = self._extent(columns, "columnIndex", stated)
            if height * width <= most:
                break
        if height * width > most:
            raise UnusableScan(
                "{file}: scan '{scan}': its row and column numbers span {rows:,} x {columns:,} pixels for {count:,} "
                "points; export it again as a gridded E57 or as PTX",
                rows=height,
                columns=width,
                count=len(rows),
                **self._place,
            )
        require_memory(
            height * width * BYTES_PER_PIXEL,
            Message(
                "{file}: scan '{scan}': {rows} rows x {columns} columns", rows=height, columns=width, **self._place
            ),
            way=LIGHTER,
            error=ScanError,
        )
        self.shape, self.first = (height, width), (first_row, first_column)
        self._rows, self._columns = rows, columns
        self._points = self._pixels = self._valid = None
        self._by_columns = False

    def place(self, valid, returns, points, strength, wanted, warn):
        """Give every pixel its point.

        Parameters
        ----------
        valid : (N,) bool
        returns : (N,) float64 or None
            Number of each return of its pixel, as the file has it.
        points : (N, 3) float64
        strength : (N,) float64 or None
        wanted : {"first", "strongest", "last"}
            Which of several returns of a pixel to take. Without numbers the nearest is the first.
        warn : callable
            Takes what `Message` takes.

        Raises
        ------
        UnusableScan
            If the numbers do not tell the points apart.
        """
        for by_columns in (False, True):
            if self._is_complete(by_columns):
                self._valid, self._by_columns = valid, by_columns
                return
        there = slice(None) if valid.all() else np.flatnonzero(valid)
        cells = self.cells(there)
        taken = np.zeros(self.shape[0] * self.shape[1], bool)
        taken[cells] = True
        if np.count_nonzero(taken) == len(cells):
            self._points, self._pixels = there, cells
            return
        there = np.flatnonzero(valid)
        distance = np.einsum("ij,ij->i", points[there], points[there])
        number = distance if returns is None else self._number(returns[there], distance, cells, warn)
        # Where numbers are equal, the nearest is the first.
        keys = [distance, number]
        if wanted == "strongest" and strength is not None:
            keys = [distance, -strength[there]]
        elif wanted == "last":
            keys = [-distance, -number]
        order = np.lexsort((*keys, cells))
        first = np.concatenate([[True], np.diff(cells[order]) != 0])
        self._points, self._pixels = there[order[first]], cells[order[first]]
        others = there.size - self._pixels.size
        if returns is None and self._scattered(points, there[order], first):
            raise UnusableScan(
                "{file}: scan '{scan}': rowIndex and columnIndex do not tell its points apart ({count:,} points, "
                "{pixels:,} pixels); export it as PTX or as a structured (gridded) E57, or {way}",
                way=BY_ANGLE,
                count=there.size,
                pixels=self._pixels.size,
                **self._place,
            )
        warn(
            _TAKEN[wanted],
            pixels=int(np.count_nonzero(np.diff(np.append(np.flatnonzero(first), len(first))) > 1)),
            count=others,
        )

    @staticmethod
    def _number(returns, distance, cells, warn):
        """The numbers of the returns of each pixel, from the nearest on: some files count from the farthest."""
        order = np.lexsort((returns, cells))
        same = np.diff(cells[order]) == 0
        farther = np.diff(distance[order])[same & (np.diff(returns[order]) > 0)]
        if np.count_nonzero(farther < 0) <= _COUNTED_BACK * farther.size or not farther.size:
            return returns
        warn("its return numbers count from the farthest to the nearest; they were turned around")
        return -returns

    @staticmethod
    def _scattered(points, order, first):
        """Whether the points of one pixel lie in different directions; ``order`` lists them pixel by pixel."""
        with np.errstate(all="ignore"):
            directions = points[order] / np.sqrt(np.einsum("ij,ij->i", points[order], points[order]))[:, None]
            cosine = np.einsum("ij,ij->i", directions, directions[np.flatnonzero(first)[np.cumsum(first) - 1]])
        cosine = cosine[~first & np.isfinite(cosine)]
        return cosine.size > 0 and np.median(cosine) < np.cos(np.radians(_ONE_DIRECTION_DEG))

    def spread(self, values, dtype=None):
        """(H, W, ...) grid of (N, ...) values of the points; zeros in pixels without a return."""
        height, width = self.shape
        more, dtype = values.shape[1:], np.dtype(dtype or values.dtype)
        with np.errstate(over="ignore", invalid="ignore"):
            values = np.ascontiguousarray(values, dtype)
        if self._valid is not None:
            # The points are the pixels, in one order or the other.
            values[~self._valid] = 0
            if self._by_columns:
                return values.reshape(width, height, *more).swapaxes(0, 1)
            return values.reshape(height, width, *more)
        grid = np.zeros((height * width, *more), dtype)
        # One item for all values of a point: many times faster than one for each.
        item = np.dtype((np.void, dtype.itemsize * math.prod(more)))
        items, laid = (array.reshape(len(array), -1).view(item) for array in (values, grid))
        laid[self._pixels] = items[self._points]
        return grid.reshape(height, width, *more)

    def cells(self, which=slice(None)):
        """(n,) pixel of each of some points, or of all, row by row."""
        height, width = self.shape
        kind = np.int32 if height * width < 2**31 else np.int64
        rows, columns = (np.asarray(values[which], kind) for values in (self._rows, self._columns))
        return (rows - kind(self.first[0])) * kind(width) + (columns - kind(self.first[1]))

    def _is_complete(self, by_columns):
        """Whether the points are all pixels of the grid, row by row, or column by column."""
        lines, places = (self._columns, self._rows) if by_columns else (self._rows, self._columns)
        first, (count, length) = self.first, self.shape
        if by_columns:
            first, (count, length) = first[::-1], self.shape[::-1]
        if len(lines) != count * length:
            return False
        expected = np.arange(first[1], first[1] + length)
        for rows in strips((count, length)):
            here = slice(rows.start * length, rows.stop * length)
            numbers = np.arange(first[0] + rows.start, first[0] + rows.stop)[:, None]
            if not (lines[here].reshape(-1, length) == numbers).all():
                return False
            if not (places[here].reshape(-1, length) == expected).all():
                return False
        return True

    def _extent(self, index, field, limits):
        """First number and count. The file's own bounds are believed where they hold all points and are not absurd."""
        with np.errstate(invalid="ignore"):
            whole = index.dtype.kind == "i" or ((np.abs(index) < _LARGEST_INDEX) & (index == np.floor(index))).all()
        if not whole:
            raise UnusableScan(
                "{file}: scan '{scan}': {field} holds values that are not whole numbers; export it as PTX",
                field=field,
                **self._place,
            )
        first, last = int(index.min()), int(index.max())
        low, high = limits[field]
        stated = low is not None and high is not None and low <= first and last <= high
        if stated and high - low < _MOST_MARGIN * (last - first + 1):
            first, last = math.ceil(low), math.floor(high)
        return first, last - first + 1
