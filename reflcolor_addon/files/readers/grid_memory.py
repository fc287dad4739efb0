"""Work on large grids piece by piece, so that it takes little memory beyond the grid's own."""

import numpy as np

from ...scan.orientation import turned

_STRIP = 1 << 15
"""Pixels that are worked on at once: few enough that they stay in the processor's cache."""

_BLOCK = 128


def strips(shape):
    """Slices of rows, one strip of a grid after the other."""
    rows = max(1, _STRIP // max(1, shape[1]))
    return [slice(first, min(first + rows, shape[0])) for first in range(0, shape[0], rows)]


def in_order(grid):
    """Return an (H, W, ...) array row by row in memory: its own memory, in which rows and columns change places, if it
    is but turned; else a copy."""
    vertical, horizontal = (grid.strides[axis] < 0 for axis in (0, 1))
    stored = grid[turned(vertical, horizontal)]
    if stored.flags.c_contiguous:
        if vertical:
            _turn_rows(stored)
        if horizontal:
            for rows in strips(stored.shape):
                stored[rows] = stored[rows, ::-1].copy()
        return stored
    # Block by block, because neighbors in one order are far apart in the other.
    made = np.empty(grid.shape, grid.dtype)
    for row in range(0, grid.shape[0], _BLOCK):
        for column in range(0, grid.shape[1], _BLOCK):
            block = slice(row, row + _BLOCK), slice(column, column + _BLOCK)
            made[block] = grid[block]
    return made


def _turn_rows(grid):
    height = len(grid)
    for rows in strips((height // 2, *grid.shape[1:])):
        other = slice(height - rows.stop, height - rows.start)
        upper = grid[rows].copy()
        grid[rows] = grid[other][::-1]
        grid[other] = upper[::-1]
