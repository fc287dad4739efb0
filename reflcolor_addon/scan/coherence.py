"""Checks whether neighbors in a stored order are neighbors in space, as in a scanner's grid but not in a list of
points."""

import math

import numpy as np

_PAIRS = 1 << 15
_PAIRS_OF_LINES = 1 << 12
_FEWEST = 30
"""Fewer pairs of points are not conclusive."""

_CLEARLY_NEARER = 0.5
"""How much nearer neighbors must be in another order before it is taken instead of the stated one."""

_UNORDERED = 0.8
"""From here on neighbors are about as far apart as any two points of the scan."""

_ROUNDS = 3.0
"""A scanner's profile goes around once; a list of the points of a whole grid goes back and forth many times."""

_LINES = 32
"""Rows, and columns, of which this is asked."""

_NEAR = 0.1
"""Returns nearer than this share of the usual distance are noise beside the scanner, in any direction."""


class LineLength:
    """Finds how long the lines are that a list of points was cut from, by a few of the points.

    Parameters
    ----------
    count : int
        Points of the list.
    candidates : sequence of int
        Divisors of it; the first is taken unless another is clearly better.

    Attributes
    ----------
    places : (S,) int64
        The numbers of the points that are looked at, in order.
    """

    def __init__(self, count, candidates):
        self._candidates = candidates
        self._pairs = [_between_lines(count, length) for length in candidates]
        places = np.sort(np.concatenate([place for pair in self._pairs for place in pair]))
        self.places = places[np.diff(places, prepend=-1) > 0]

    def of(self, points, valid):
        """Return the length of line, given the (S, 3) points at ``places`` and which of them are returns."""
        apart = []
        for here, there in (np.searchsorted(self.places, pair) for pair in self._pairs):
            both = valid[here] & valid[there]
            few = np.count_nonzero(both) < _FEWEST
            apart.append(np.nan if few else float(np.median(_distances(points[here][both], points[there][both]))))
        best = int(np.nanargmin(apart)) if np.isfinite(apart).any() else 0
        stated = apart[0]
        clear = np.isfinite(stated) and apart[best] < _CLEARLY_NEARER * stated
        return self._candidates[best if clear else 0]


def is_unordered(points, valid):
    """Return whether the neighbors of a grid are no nearer to each other than any two of its points.

    A grid of one row or column is also unordered where its points go back and forth, as those of a whole scan do.

    Parameters
    ----------
    points : (H, W, 3) float64
    valid : (H, W) bool
    """
    height, width = valid.shape
    count = np.count_nonzero(valid)
    if count < _FEWEST:
        return False
    some = _sample(points, valid)
    one, other = np.random.default_rng(0).integers(0, len(some), (2, _PAIRS))
    any_two = np.median(_distances(some[one], some[other]))
    if 1 in (height, width):
        flat, there = points.reshape(-1, 3), np.flatnonzero(valid)
        return _goes_back_and_forth(flat[there]) or _apart(flat, there[:-1], there[1:]) > _UNORDERED * any_two
    apart = [_from_neighbor(points, valid, rows, cols) for rows, cols in ((0, 1), (1, 0))]
    return not np.isnan(apart).all() and np.nanmin(apart) > _UNORDERED * any_two


def is_cut_anywhere(points, valid):
    """Return whether rows or columns of a grid go back and forth, as where a list was cut into lines of any length.

    Parameters
    ----------
    points : (H, W, 3) float64
        Measured from the scanner.
    valid : (H, W) bool
    """
    for grid, there in ((points, valid), (points.swapaxes(0, 1), valid.T)):
        lines = np.flatnonzero(there.any(axis=1))
        seen = [grid[line][there[line]] for line in lines[:: max(1, len(lines) // _LINES)]]
        ranges = [np.linalg.norm(line, axis=1) for line in seen]
        near = _NEAR * np.median(np.concatenate(ranges)) if ranges else 0.0
        back = [_goes_back_and_forth(line[away > near]) for line, away in zip(seen, ranges, strict=True)]
        if len(back) > 1 and np.median(back) > 0.5:
            return True
    return False


def _sample(points, valid):
    """(N, 3) points of every n-th row and column; all of a grid that has too few there."""
    step = math.isqrt(valid.size // _PAIRS) + 1
    found = points[::step, ::step][valid[::step, ::step]]
    return found if len(found) >= _FEWEST else points[valid]


def _from_neighbor(points, valid, rows, cols):
    """Median distance from a pixel to the one so many rows and columns on; NaN where too few tell."""
    height, width = valid.shape
    for every in (math.isqrt(valid.size // _PAIRS) + 1, 1):
        here = slice(0, height - rows, every), slice(0, width - cols, every)
        there = slice(rows, None, every), slice(cols, None, every)
        both = valid[here] & valid[there]
        if np.count_nonzero(both) >= _FEWEST:
            return float(np.median(_distances(points[here][both], points[there][both])))
    return np.nan


def _between_lines(count, length):
    """Numbers of some points, and of those at the same place of the next line."""
    here = np.arange(0, max(0, count - length), max(1, (count - length) // _PAIRS_OF_LINES))
    return here, here + length


def _apart(points, one, other):
    step = max(1, len(one) // _PAIRS)
    return float(np.median(_distances(points[one[::step]], points[other[::step]])))


def _distances(one, other):
    difference = one - other
    return np.sqrt(np.einsum("ij,ij->i", difference, difference))


def _goes_back_and_forth(points):
    """Whether the directions of a line of points, one after the other, turn through more than a few full turns."""
    distance = np.sqrt(np.einsum("ij,ij->i", points, points))
    directions = points[distance > 0] / distance[distance > 0, None]
    steps = np.einsum("ij,ij->i", directions[:-1], directions[1:])
    return float(np.arccos(np.clip(steps, -1, 1)).sum()) > _ROUNDS * 2 * np.pi
