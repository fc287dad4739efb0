"""Where the scanner stood, for files whose points are measured from somewhere else.

A turning scanner sees each column of its grid in one vertical plane and each row on one cone. Only from its own place
does every column have one azimuth, and every row one elevation.
"""

from dataclasses import dataclass

import numpy as np

_LINES = 256
"""Rows and columns that are looked at."""

_CLEARLY_BETTER = 0.25
"""How much smaller the spread must be from another place than from the stated one."""

_REGULAR = 1.0
"""Largest spread, in steps of the grid, of a credible place."""

_FEWEST_IN_LINE = 5
_FEWEST_LINES = 4
_REPEATED_SHARE = 0.002
_FEWEST_REPEATED = 8
_ROUNDS = 4
_HASH = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
"""Large odd numbers: equal sums mean equal points."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Origin:
    """A place that the points of a grid were measured from.

    Parameters
    ----------
    place : (3,) float64
        In the frame of the points.
    spread : float
        How far the directions of a line of the grid are apart, in steps of the grid; 0 for a perfect one.
    """

    place: np.ndarray
    spread: float


def better_origin(points, valid, candidates, *, fit=True):
    """Return an Origin from which a grid is regular, or None where it is no worse as it is.

    Parameters
    ----------
    points : (H, W, 3) float64
        Z up.
    valid : (H, W) bool
    candidates : dict of str to (3,) float64
        Places that the file names, by what named them.
    fit : bool
        Whether to look for a place that the file does not name.

    Returns
    -------
    (str, Origin) or None
        What named the place: a key of ``candidates``, or ``"fit"``.
    """
    points, valid = _sampled(points, valid)
    if np.count_nonzero(valid) < _FEWEST_LINES * _FEWEST_IN_LINE:
        return None
    stated = _spread(points, valid, np.zeros(3), enough=_REGULAR)
    if not stated > _REGULAR:
        return None
    places = {name: np.asarray(place, np.float64) for name, place in candidates.items()}
    found = fitted_origin(points, valid) if fit else None
    if found is not None:
        places["fit"] = found
    spreads = {name: _spread(points, valid, place) for name, place in places.items()}
    spreads = {name: spread for name, spread in spreads.items() if np.isfinite(spread)}
    if not spreads:
        return None
    # A place that the file names is exact; a fit is taken only where it is clearly better.
    best = min(spreads, key=lambda name: spreads[name] * (2.0 if name == "fit" else 1.0))
    if spreads[best] > _REGULAR or spreads[best] > _CLEARLY_BETTER * stated:
        return None
    return best, Origin(place=places[best], spread=spreads[best])


def repeated_point(points):
    """Return the point that many of a list repeat exactly, or None: how some programs write that there is no return.

    Parameters
    ----------
    points : (N, 3) float64
        All numbers of them finite.
    """
    if len(points) < 2 * _FEWEST_REPEATED:
        return None
    # Many times faster than sorting by three numbers; 0 and -0 count as equal.
    hashes = (points + 0.0).view(np.uint64) @ _HASH
    ordered = np.sort(hashes)
    starts = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    counts = np.diff(np.concatenate([starts, [len(points)]]))
    most = int(np.argmax(counts))
    second = np.partition(counts, -2)[-2] if len(counts) > 1 else 0
    if counts[most] < max(_FEWEST_REPEATED, _REPEATED_SHARE * len(points), 4 * second):
        return None
    return points[np.argmax(hashes == ordered[starts[most]])]


def fitted_origin(points, valid):
    """Return the (3,) place from which columns, or rows, are vertical planes and the others cones, or None.

    The planes' traces on the ground meet at the scanner. On a cone the height grows evenly with the distance on the
    ground, from the same height for all. Both are linear.

    Parameters
    ----------
    points : (H, W, 3) float64
        Z up.
    valid : (H, W) bool
    """
    choices = []
    for grid, there in ((points, valid), (points.swapaxes(0, 1), valid.T)):
        ground = meeting_point(grid, there)
        if ground is None:
            continue
        height = _common_apex(grid, there, ground)
        if height is not None:
            place = _refined(grid, there, np.array([*ground, height]))
            choices.append((_spread(points, valid, place), place))
    choices = [choice for choice in choices if np.isfinite(choice[0])]
    return min(choices, key=lambda choice: choice[0])[1] if choices else None


def meeting_point(points, valid):
    """(2,) where the lines meet on the ground that the columns of a grid lie on."""
    lines, weights = [], []
    for col in range(valid.shape[1]):
        ground = points[valid[:, col], col, :2]
        if len(ground) < _FEWEST_IN_LINE:
            continue
        middle = ground.mean(axis=0)
        _, length, axes = np.linalg.svd(ground - middle, full_matrices=False)
        if length[0] > 0:
            lines.append([*axes[1], axes[1] @ middle])
            # A column that sees only one upright wall gives no direction; one that sees floor and wall does.
            weights.append(length[0])
    if len(lines) < _FEWEST_LINES:
        return None
    lines, weights = np.array(lines), np.array(weights)
    for _ in range(_ROUNDS):
        scaled = lines * weights[:, None]
        solution, _, rank, _ = np.linalg.lstsq(scaled[:, :2], scaled[:, 2], rcond=1e-6)
        if rank < 2:
            return None
        miss = np.abs(lines[:, :2] @ solution - lines[:, 2])
        usual = np.median(miss)
        if usual == 0:
            break
        weights = weights * np.minimum(1, 3 * usual / np.maximum(miss, 1e-12))
    return solution


def _common_apex(points, valid, ground):
    """Height from which, row by row, the height grows evenly with the distance on the ground."""
    distance = np.hypot(*(points[..., :2] - ground).transpose(2, 0, 1))
    slopes, apexes, weights = [], [], []
    for row in range(valid.shape[0]):
        there = valid[row]
        if np.count_nonzero(there) < _FEWEST_IN_LINE:
            continue
        x, z = distance[row, there], points[row, there, 2]
        spread = np.ptp(x)
        if spread > 0.05 * x.mean():
            slope, apex = np.polyfit(x, z, 1)
            slopes.append(slope)
            apexes.append(apex)
            weights.append(spread / x.mean())
    if len(apexes) < _FEWEST_LINES:
        return None
    order = np.argsort(apexes)
    share = np.cumsum(np.array(weights)[order]) / np.sum(weights)
    return float(np.array(apexes)[order][np.searchsorted(share, 0.5)])


def _refined(points, valid, place):
    """The place moved so that azimuths of each column, and elevations of each row, agree best (Gauss-Newton)."""
    for _ in range(_ROUNDS):
        relative = points - place
        level, distance, there = _levels(relative, valid)
        x, y, z = (relative[..., axis] for axis in range(3))
        azimuth, elevation = np.arctan2(y, x), np.arctan2(z, level)
        turn = np.stack([y, -x, np.zeros_like(x)], axis=-1) / level[..., None] ** 2
        rise = np.stack([x * z / level, y * z / level, -level], axis=-1) / distance[..., None] ** 2
        normal, right = np.zeros((3, 3)), np.zeros(3)
        for angle, slope, mask, wraps in (
            (azimuth, turn, there, True),
            (elevation.T, rise.swapaxes(0, 1), there.T, False),
        ):
            columns = np.flatnonzero(mask.sum(axis=0) >= _FEWEST_IN_LINE)
            if len(columns) < _FEWEST_LINES:
                continue
            away, _ = _from_middle(angle[:, columns], mask[:, columns], wraps=wraps)
            mask, slope = mask[:, columns], slope[:, columns]
            usual = max(np.median(np.abs(away[mask])), 1e-12)
            weight = np.where(mask, 1 / (1 + (away / (3 * usual)) ** 2), 0.0)
            whole = weight.sum(axis=0)
            slope = slope - np.einsum("ij,ijk->jk", weight, slope) / whole[:, None]
            away = away - (weight * away).sum(axis=0) / whole
            normal += np.einsum("ij,ijk,ijl->kl", weight, slope, slope) / usual**2
            right += np.einsum("ij,ijk,ij->k", weight, slope, away) / usual**2
        step, _, rank, _ = np.linalg.lstsq(normal, right, rcond=1e-9)
        if rank < 3 or not np.isfinite(step).all():
            break
        place = place - step
    return place


def _levels(relative, valid):
    """(H, W) distances on the ground, and in space, and where an azimuth means something."""
    distance = np.sqrt(np.einsum("ijk,ijk->ij", relative, relative))
    level = np.hypot(relative[..., 0], relative[..., 1])
    there = valid & (level > 0.1 * distance) & (distance > 0)
    return np.where(there, level, 1.0), np.where(there, distance, 1.0), there


def _spread(points, valid, place, enough=-1.0):
    """How far apart the angles of a line of the grid are, in steps from line to line: the better of both ways round, or
    the first one that is small enough."""
    relative = points - place
    level, _, valid = _levels(relative, valid)
    azimuth = np.arctan2(relative[..., 1], relative[..., 0])
    elevation = np.arctan2(relative[..., 2], level)
    by_column = max(_spread_of_lines(azimuth, valid, wraps=True), _spread_of_lines(elevation.T, valid.T))
    if by_column <= enough:
        return by_column
    by_row = max(_spread_of_lines(azimuth.T, valid.T, wraps=True), _spread_of_lines(elevation, valid))
    return min(by_column, by_row)


def _spread_of_lines(angle, valid, *, wraps=False):
    """Median distance of an angle from its column's middle, over the median step between columns; inf if unknown."""
    columns = np.flatnonzero(valid.sum(axis=0) >= _FEWEST_IN_LINE)
    if len(columns) < _FEWEST_LINES:
        return np.inf
    away, middle = _from_middle(angle[:, columns], valid[:, columns], wraps=wraps)
    step = np.diff(middle)
    if wraps:
        step = (step + np.pi) % (2 * np.pi) - np.pi
    step = float(np.median(np.abs(step / np.diff(columns))))
    return float(np.median(np.abs(away[valid[:, columns]]))) / step if step > 0 else np.inf


def _from_middle(angle, valid, *, wraps):
    """(H, W) angles less their column's median, and the (W,) medians; every column has valid ones."""
    first = angle[np.argmax(valid, axis=0), np.arange(valid.shape[1])]
    around = angle - first
    if wraps:
        around = (around + np.pi) % (2 * np.pi) - np.pi
    middle = _medians(around, valid)
    return around - middle, first + middle


def _medians(values, valid):
    """(W,) medians of the valid (H, W) values of each column; every column has some."""
    # A masked median would be many times slower.
    ordered = np.sort(np.where(valid, values, np.inf), axis=0)
    count, columns = valid.sum(axis=0), np.arange(valid.shape[1])
    return (ordered[(count - 1) // 2, columns] + ordered[count // 2, columns]) / 2


def _sampled(points, valid):
    """Every n-th row and column, so that a large grid takes no longer than a small one."""
    steps = tuple(slice(None, None, max(1, size // _LINES)) for size in valid.shape)
    return points[steps], valid[steps]
