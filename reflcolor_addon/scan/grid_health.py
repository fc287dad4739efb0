"""Checks whether a grid of numbered pixels is complete: skipped rows and columns, and grids that were thinned out."""

import math
from dataclasses import dataclass

import numpy as np

_THINNED = 0.6
"""Share of returns with a return beside them, below which a grid was thinned; whole scans have 0.9 and more."""

_WHOLE = 0.75
"""The share that a coarser grid must reach to replace it."""

_COARSEST = 8
_FEWEST_LINES = 3
_FEWEST_RETURNS = 64
"""Fewer are not conclusive."""
_SAMPLES = 1 << 22


@dataclass(frozen=True, eq=False, kw_only=True)
class Cells:
    """Where the rows and columns of a stored grid go in one that has fewer.

    Parameters
    ----------
    rows : (H,) int32
        New row of every stored one; -1 for those that hold nothing.
    cols : (W,) int32
    shape : (height, width)
        Of the new grid.
    stride : (rows, columns)
        How many stored rows and columns make one.
    thinned : bool
        Whether several stored pixels may have a return in the same new one.
    """

    rows: np.ndarray
    cols: np.ndarray
    shape: tuple[int, int]
    stride: tuple[int, int]
    thinned: bool


def compacted(valid):
    """Return the Cells of a grid whose numbers count by twos or threes, or None where they count by ones.

    Parameters
    ----------
    valid : (H, W) bool
        Where there is a return.
    """
    used = [np.flatnonzero(valid.any(axis=axis)) for axis in (1, 0)]
    strides = [_stride(lines) for lines in used]
    if strides == [1, 1]:
        return None
    places, shape = [], []
    for lines, stride, size in zip(used, strides, valid.shape, strict=True):
        first = lines[0] % stride
        place = np.full(size, -1, np.int32)
        place[first::stride] = np.arange(len(range(first, size, stride)), dtype=np.int32)
        places.append(place)
        shape.append(int(place.max()) + 1)
    return Cells(rows=places[0], cols=places[1], shape=tuple(shape), stride=tuple(strides), thinned=False)


def coarser(valid):
    """Return the Cells of the finest coarser grid that is whole, for a grid that was thinned out.

    Parameters
    ----------
    valid : (H, W) bool

    Returns
    -------
    Cells or None
        None where the grid was not thinned.

    Raises
    ------
    ValueError
        If it was thinned so far that no grid of at most a few pixels in one is whole.
    """
    if min(valid.shape) < 2 or np.count_nonzero(valid) < _FEWEST_RETURNS:
        return None
    # A scan of few columns has no neighbors across, but has them along; one that was thinned has them nowhere.
    if max(_neighbor_shares(valid), default=1.0) >= _THINNED:
        return None
    for stride in range(2, _COARSEST + 1):
        if min(valid.shape) < 2 * stride:
            break
        if neighbor_share(_blocks(valid, stride)) >= _WHOLE:
            rows, cols = ((np.arange(size) // stride).astype(np.int32) for size in valid.shape)
            shape = tuple(-(-size // stride) for size in valid.shape)
            return Cells(rows=rows, cols=cols, shape=shape, stride=(stride, stride), thinned=True)
    raise ValueError("no coarser grid is whole")


def neighbor_share(valid):
    """Return the share of returns, 0..1, that have a return to the right, averaged with that below; 1 for no
    returns."""
    shares = _neighbor_shares(valid)
    return float(np.mean(shares)) if shares else 1.0


def _neighbor_shares(valid):
    """The share of returns that have one to the right, and of those that have one below."""
    step = max(1, valid.size // _SAMPLES)
    shares = []
    for one, other in ((valid[:, :-1], valid[:, 1:]), (valid[:-1], valid[1:])):
        one, other = one[::step], other[::step]
        count = np.count_nonzero(one)
        if count:
            shares.append(np.count_nonzero(one & other) / count)
    return shares


def nearest_to_center(rows, cols, cells):
    """Return how far stored pixels are from the middle of their new one, in new pixels; see `Cells`.

    Parameters
    ----------
    rows, cols : (N,) int
        Of the stored grid.
    cells : Cells

    Returns
    -------
    (N,) float32
    """
    away = [
        (index % stride - (stride - 1) / 2) / stride for index, stride in zip((rows, cols), cells.stride, strict=True)
    ]
    return np.hypot(*away).astype(np.float32)


def _stride(lines):
    """The step by which the numbers of used rows, or columns, grow."""
    if len(lines) < _FEWEST_LINES:
        return 1
    return math.gcd(*np.diff(lines).tolist())


def _blocks(valid, stride):
    """Whether there is a return in each block of that many rows and columns; a rest at the edges is left out."""
    height, width = (size // stride for size in valid.shape)
    blocks = valid[: height * stride, : width * stride].reshape(height, stride, width, stride)
    return blocks.any(axis=(1, 3))
