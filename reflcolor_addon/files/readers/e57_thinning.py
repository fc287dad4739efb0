"""Which points of an E57 are read when only every n-th row and column is wanted."""

from functools import partial

import numpy as np

from .e57_header import INDEX
from .growing import Growing


class Thinning:
    """Keeps every n-th row and column of points that come piece by piece, counted from those of the first point.

    Rows and columns whose numbers go up by twos or threes are counted as what they are.

    Parameters
    ----------
    step : int
    count : int
        Points of the file.
    with_cells : bool
        Whether to remember the numbers of all points.
    """

    def __init__(self, step, count, with_cells):
        self._step, self._first, self._strides = step, None, [0, 0]
        self._numbers = [Growing((count,), np.int32) for _ in INDEX] if with_cells else None

    def kept(self, *numbers):
        """(n,) bool: which of the next points are kept, by the row and the column of each."""
        if self._first is None:
            self._first = [float(np.floor(values[0])) if np.isfinite(values[0]) else 0.0 for values in numbers]
        kept = np.ones(len(numbers[0]), bool)
        for axis, values in enumerate(numbers):
            away = values - self._first[axis]
            # What is no whole number is kept, and refused later.
            kept &= (away % self._step == 0) | (away != np.floor(away))
            if self._strides[axis] != 1:
                whole = away[np.abs(away) < 2**31].astype(np.int64)
                self._strides[axis] = int(np.gcd(self._strides[axis], np.gcd.reduce(whole, initial=0)))
            if self._numbers is not None:
                self._numbers[axis].add(values, exactly=True)
        return kept

    def numbered(self, rows, columns, limits):
        """New numbers for the points that were kept.

        Returns
        -------
        rows, columns : (M,) float64
        taken : (M,) int64
            Which of the points that were kept stay.
        limits : dict of str to (low, high)
        """
        away = [
            np.asarray(values, np.float64) - first for values, first in zip((rows, columns), self._first, strict=True)
        ]
        coarse = [(values % self._coarse(axis) == 0) | (values != np.floor(values)) for axis, values in enumerate(away)]
        taken = np.flatnonzero(coarse[0] & coarse[1])
        found = dict(limits)
        for axis, name in enumerate(INDEX):
            low, high = limits[name]
            if low is not None and high is not None:
                ends = (low - self._first[axis]) / self._step, (high - self._first[axis]) / self._step
                found[name] = (float(np.ceil(ends[0])), float(np.floor(ends[1])))
        return *(values[taken] / self._step for values in away), taken, found

    def cells(self, grid):
        """A function that returns (N,) int64: the pixel of every point of the file, of those left out that of the
        nearest one before it that was not."""
        return partial(self._cells, grid.first, grid.shape)

    def _coarse(self, axis):
        return max(1, self._strides[axis]) * self._step

    def _cells(self, first, shape):
        places = []
        for axis, numbers in enumerate(self._numbers):
            away = numbers.whole().astype(np.int64) - int(self._first[axis])
            stride = max(1, self._strides[axis])
            place = away // self._coarse(axis) * stride - first[axis]
            places.append(np.clip(place, 0, shape[axis] - 1))
        return places[0] * shape[1] + places[1]
