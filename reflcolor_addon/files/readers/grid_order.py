"""The way from the grid that a file stores to the grid of a scan: taken by every array, and back by the colors."""

import numpy as np

from ...scan.grid_health import nearest_to_center
from ...scan.orientation import turned


class GridOrder:
    """Steps that close gaps, make a grid coarser, turn it, or thin it out; applied one after the other.

    Parameters
    ----------
    shape : (H, W)
        Of the stored grid.

    Attributes
    ----------
    stored, shape : (H, W)
        Of the stored grid, and of the one that the steps lead to.
    """

    def __init__(self, shape):
        self.shape = self.stored = tuple(shape)
        self._steps = []

    def closed_up(self, cells, valid):
        """Add the step of `Cells`; ``valid`` is the grid's as it is now."""
        self._add(_Thinned(cells, valid) if cells.thinned else _ClosedUp(cells), cells.shape)

    def turned(self, turn):
        """Add a `Turn`."""
        height, width = self.shape[::-1] if turn.transposed else self.shape
        self._add(_Turned(turn, height, width), (height, width))

    def by_hand(self, turn_deg, vertical, horizontal):
        """Add a turn clockwise and flips after it."""
        height, width = self.shape[::-1] if turn_deg % 180 else self.shape
        self._add(_ByHand(turn_deg, vertical, horizontal, self.shape), (height, width))

    def every(self, step):
        """Add that only every ``step``-th row and column is kept."""
        self._add(_Every(step), tuple(-(-size // step) for size in self.shape))

    def of(self, grid):
        """Return an (H, W, ...) array of the stored grid as one of the scan's; None for None."""
        for step in self._steps if grid is not None else ():
            grid = step.of(grid)
        return grid

    def pixels(self, rows, cols):
        """Return the pixel of the scan, row by row, for pixels of the stored grid; -1 where there is none.

        Parameters
        ----------
        rows, cols : (N,) int

        Returns
        -------
        (N,) int64
        """
        rows, cols = np.asarray(rows, np.int64), np.asarray(cols, np.int64)
        gone = np.zeros(rows.shape, bool)
        for step in self._steps:
            rows, cols = step.places(rows, cols)
            gone |= (rows < 0) | (cols < 0)
        return np.where(gone, -1, rows * self.shape[1] + cols)

    def _add(self, step, shape):
        self._steps.append(step)
        self.shape = tuple(shape)


class _ClosedUp:
    def __init__(self, cells):
        self._cells = cells
        self._index = tuple(np.flatnonzero(places >= 0) for places in (cells.rows, cells.cols))

    def of(self, grid):
        return grid[np.ix_(*self._index)]

    def places(self, rows, cols):
        return self._cells.rows[rows].astype(np.int64), self._cells.cols[cols].astype(np.int64)


class _Thinned:
    def __init__(self, cells, valid):
        self._cells = cells
        rows, cols = np.nonzero(valid)
        pixel = cells.rows[rows].astype(np.int64) * cells.shape[1] + cells.cols[cols]
        # Of several returns the one in the middle, so that the new grid is as even as it can be.
        order = np.lexsort((nearest_to_center(rows, cols, cells), pixel))
        first = np.concatenate([[True], np.diff(pixel[order]) != 0])
        self._pixels = pixel[order][first]
        self._taken = (rows[order][first], cols[order][first])

    def of(self, grid):
        found = np.zeros((self._cells.shape[0] * self._cells.shape[1], *grid.shape[2:]), grid.dtype)
        found[self._pixels] = grid[self._taken]
        return found.reshape(*self._cells.shape, *grid.shape[2:])

    def places(self, rows, cols):
        return self._cells.rows[rows].astype(np.int64), self._cells.cols[cols].astype(np.int64)


class _Turned:
    def __init__(self, turn, height, width):
        self._turn, self._height, self._width = turn, height, width

    def of(self, grid):
        return self._turn.of(grid)

    def places(self, rows, cols):
        if self._turn.transposed:
            rows, cols = cols, rows
        return (
            self._height - 1 - rows if self._turn.vertical else rows,
            self._width - 1 - cols if self._turn.horizontal else cols,
        )


class _ByHand:
    def __init__(self, turn_deg, vertical, horizontal, shape):
        self._turns, self._shape = turn_deg // 90, shape
        self._vertical, self._horizontal = vertical, horizontal

    def of(self, grid):
        return np.rot90(grid, -self._turns)[turned(self._vertical, self._horizontal)]

    def places(self, rows, cols):
        height, width = self._shape
        for _ in range(self._turns):
            rows, cols, height, width = cols, height - 1 - rows, width, height
        return (
            height - 1 - rows if self._vertical else rows,
            width - 1 - cols if self._horizontal else cols,
        )


class _Every:
    def __init__(self, step):
        self._step = step

    def of(self, grid):
        return grid[:: self._step, :: self._step]

    def places(self, rows, cols):
        return rows // self._step, cols // self._step
