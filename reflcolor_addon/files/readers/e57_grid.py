"""From the list of points that an E57 file holds to a grid: rows and columns, and which of several returns counts."""

import math

import numpy as np

from ...errors import ScanError
from ...messages import Message
from ..memory import require_memory
from .grid import BYTES_PER_PIXEL, UnusableScan

_CELLS_PER_POINT = 1000
# How many times larger than the extent of the points the bounds stated in a file may be: a small scene under a large
# sky, but not the range of the file's number format.
_MOST_MARGIN = 16
"""A grid emptier than this is no scan: its row or column numbers are wrong."""

_LARGEST_INDEX = 2**40
_ONE_DIRECTION_DEG = 2.0
"""Largest angle between the returns of one pulse, with the scanner slightly away from its stated position."""

_TAKEN = {
    "first": "{pixels:,} pixels have several returns; the first was taken, {count:,} others were left out",
    "strongest": "{pixels:,} pixels have several returns; the strongest was taken, {count:,} others were left out",
    "last": "{pixels:,} pixels have several returns; the last was taken, {count:,} others were left out",
}


class IndexGrid:
    """Where the points of a scan belong.

    Parameters
    ----------
    rows, columns : (N,) float64
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
            error=ScanError,
        )
        self.shape = (height, width)
        self.cells = (rows - first_row).astype(np.int64) * width + (columns - first_column).astype(np.int64)
        """(N,) pixel of every point, row by row."""
        self._points = self._pixels = None

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
        there = np.flatnonzero(valid)
        cells = self.cells[there]
        if there.size == 0 or np.bincount(cells).max() == 1:
            self._points, self._pixels = there, cells
            return
        distance = np.einsum("ij,ij->i", points[there], points[there])
        number = distance if returns is None else returns[there]
        if wanted == "strongest" and strength is not None:
            number = -strength[there]
        elif wanted == "last":
            number = -number
        order = np.lexsort((number, cells))
        first = np.concatenate([[True], np.diff(cells[order]) != 0])
        self._points, self._pixels = there[order[first]], cells[order[first]]
        others = there.size - self._pixels.size
        if returns is None and self._scattered(points, there[order], first):
            raise UnusableScan(
                "{file}: scan '{scan}': rowIndex and columnIndex do not tell its points apart ({count:,} points, "
                "{pixels:,} pixels); export it as PTX or as a structured (gridded) E57, or have a grid laid over its "
                "points: --grid angle, or Grid by Angle in the import dialog",
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
    def _scattered(points, order, first):
        """Whether the points of one pixel lie in different directions; ``order`` lists them pixel by pixel."""
        with np.errstate(all="ignore"):
            directions = points[order] / np.sqrt(np.einsum("ij,ij->i", points[order], points[order]))[:, None]
            cosine = np.einsum("ij,ij->i", directions, directions[np.flatnonzero(first)[np.cumsum(first) - 1]])
        cosine = cosine[~first & np.isfinite(cosine)]
        return cosine.size > 0 and np.median(cosine) < np.cos(np.radians(_ONE_DIRECTION_DEG))

    def spread(self, values, dtype=None):
        """(H, W, ...) grid of (N, ...) values of the points; zeros in pixels without a return."""
        grid = np.zeros((self.shape[0] * self.shape[1], *values.shape[1:]), dtype or values.dtype)
        with np.errstate(over="ignore", invalid="ignore"):
            grid[self._pixels] = values if len(self._points) == len(values) else values[self._points]
        return grid.reshape(*self.shape, *values.shape[1:])

    def _extent(self, index, field, limits):
        """First number and count. The file's own bounds are believed where they hold all points and are not absurd."""
        with np.errstate(invalid="ignore"):
            whole = (np.abs(index) < _LARGEST_INDEX) & (index == np.floor(index))
        if not whole.all():
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
