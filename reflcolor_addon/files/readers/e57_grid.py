"""From the list of points that an E57 file holds to a grid: rows and columns, and colors in 8 bits."""

import math

import numpy as np

from ...errors import ScanError
from ..memory import require_memory
from .grid import BYTES_PER_PIXEL, UnusableScan

_CELLS_PER_POINT = 1000
# How many times what the points span the bounds of a file may be: a little scene under much sky, but not the range of
# the numbers that the file could have held.
_MOST_MARGIN = 16
"""A grid emptier than this is no scan: its row or column numbers are wrong."""

_LARGEST_INDEX = 2**40


class IndexGrid:
    """Where the points of a scan belong.

    Parameters
    ----------
    rows, columns : (N,) float64
        Index of every point, of any sign, from any start.
    limits : dict
        (low, high) of ``rowIndex`` and ``columnIndex`` as the file states them, each may be None.
    file_name, name : str
        Of the file and the scan, for messages.

    Raises
    ------
    UnusableScan
        If the indices are no whole numbers, or span a grid that is nearly empty.
    ScanError
        If the grid does not fit into memory.
    """

    def __init__(self, rows, columns, limits, file_name, name):
        self._place = {"file": file_name, "scan": name}
        most = _CELLS_PER_POINT * (len(rows) + 1000)
        # The file's own bounds tell of margins without a point; not where they claim far more than the points fill.
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
            f"{file_name}: scan '{name}': {height} rows x {width} columns",
            error=ScanError,
        )
        self.shape = (height, width)
        self._flat = (rows - first_row).astype(np.int64) * width + (columns - first_column).astype(np.int64)
        self._points = self._pixels = None

    def place(self, valid):
        """Give every pixel its point: of several the first of the file that is a return.

        Parameters
        ----------
        valid : (N,) bool

        Returns
        -------
        int
            How many returns were left out because an earlier one has their pixel.

        Raises
        ------
        UnusableScan
            If that is most of them.
        """
        returns = np.flatnonzero(valid)
        self._pixels, first = np.unique(self._flat[returns], return_index=True)
        self._points = returns[first]
        doubled = returns.size - self._pixels.size
        if doubled > 0.5 * returns.size:
            raise UnusableScan(
                "{file}: scan '{scan}': rowIndex and columnIndex do not tell its points apart ({count:,} points, "
                "{pixels:,} pixels); export it as PTX or as a structured (gridded) E57",
                count=returns.size,
                pixels=self._pixels.size,
                **self._place,
            )
        return doubled

    def spread(self, values, dtype=None):
        """(H, W, ...) grid of (N, ...) values of the points; zeros in pixels without a return."""
        grid = np.zeros((self.shape[0] * self.shape[1], *values.shape[1:]), dtype or values.dtype)
        with np.errstate(over="ignore", invalid="ignore"):
            grid[self._pixels] = values[self._points]
        return grid.reshape(*self.shape, *values.shape[1:])

    def _extent(self, index, field, limits):
        """First number and count. The file's own bounds are believed where they hold all points and are not absurd."""
        with np.errstate(invalid="ignore"):
            whole = (np.abs(index) < _LARGEST_INDEX) & (index == np.floor(index))
        if not whole.all():
            raise UnusableScan(
                "{file}: scan '{scan}': {field} holds what is no whole number; export it as PTX",
                field=field,
                **self._place,
            )
        first, last = int(index.min()), int(index.max())
        low, high = limits[field]
        stated = low is not None and high is not None and low <= first and last <= high
        if stated and high - low < _MOST_MARGIN * (last - first + 1):
            first, last = math.ceil(low), math.floor(high)
        return first, last - first + 1


def in_8_bits(values, low, high):
    """Colors brought to 0..255 by the limits of their file.

    Parameters
    ----------
    values : (N,) float64
        One channel.
    low, high : float or None
        What the file states. Limits within 0..255 that go beyond its half say that it counts in 8 bits, whether they
        are the ends of the scale or the least and greatest that occur. Without limits it counts in 8 or 16 bits.

    Returns
    -------
    (N,) uint8
    """
    values = np.nan_to_num(values, nan=0.0)
    if low is None or high is None or not 0 < high - low <= 2**32:
        low, high = 0, 255 if values.max(initial=0) <= 255 else 65535
    elif low >= 0 and 128 <= high <= 255:
        low, high = 0, 255
    return np.round(np.clip((values - low) * (255 / (high - low)), 0, 255)).astype(np.uint8)
