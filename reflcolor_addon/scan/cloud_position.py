"""Finds the scanner's position for points without a grid that are still in the order of measurement.

Points that follow each other lie in one upright plane through the scanner, however far away each of them is.
"""

import numpy as np

from .origin import meeting_point

_RUN = 64
_RUNS = 512
_HEIGHTS = 65
_ROUNDS = 4
_MOST_CONFLICTS = 0.15
"""Share of points behind others above which a place cannot be the scanner's."""

_EXACT = 1.3
"""How much better a computed place must be than a stated one, because stated places are exact."""

_IN_CELL = 8
_BEHIND = 0.1
"""As a share of the cloud's extent."""

_SAMPLES = 1 << 18


def position_of_cloud(points, named=()):
    """Return the (3,) place that a cloud was scanned from, or None if none is found.

    Parameters
    ----------
    points : (N, 3) float64
        In the order of the file, Z up.
    named : sequence of (3,) float64
        Places that the file names; the first that is possible is taken before any that is found.
    """
    places = [np.asarray(place, np.float64) for place in named]
    scores = [conflicts(points, place) for place in places]
    found = _found(points)
    if found is not None:
        places.append(found)
        scores.append(conflicts(points, found))
    if not places or min(scores) > _MOST_CONFLICTS:
        return None
    best = int(np.argmin(scores))
    exact = [
        place for place, score in zip(places[: len(named)], scores, strict=False) if score <= _EXACT * scores[best]
    ]
    return exact[0] if exact else places[best]


def conflicts(points, place):
    """Return the share, 0..1, of the points that lie behind another surface as seen from a place.

    Parameters
    ----------
    points : (N, 3) float64
    place : (3,) float64
    """
    relative = points[:: max(1, len(points) // _SAMPLES)] - place
    distance = np.sqrt(np.einsum("ij,ij->i", relative, relative))
    azimuth = np.arctan2(relative[:, 1], relative[:, 0])
    elevation = np.arctan2(relative[:, 2], np.hypot(relative[:, 0], relative[:, 1]))
    # Upright slabs of directions with equally many points, and cells of a few points in each.
    slabs = max(1, int(np.sqrt(len(distance) / _IN_CELL)))
    slab = np.argsort(np.argsort(azimuth)) * slabs // len(azimuth)
    order = np.lexsort((elevation, slab))
    count = len(order) // _IN_CELL * _IN_CELL
    cells = distance[order[:count]].reshape(-1, _IN_CELL)
    extent = np.median(np.abs(points - np.median(points, axis=0)).sum(axis=1))
    return float(np.mean(cells - cells.min(axis=1, keepdims=True) > _BEHIND * extent)) if count else 1.0


def _found(points):
    if len(points) < 16 * _RUN:
        return None
    starts = np.linspace(0, len(points) - _RUN, min(_RUNS, len(points) // _RUN)).astype(np.int64)
    # One run of consecutive points per column, as `meeting_point` expects the columns of a grid.
    runs = points[starts[None, :] + np.arange(_RUN)[:, None]]
    middle = np.median(points[:: max(1, len(points) // 10_000)], axis=0)
    ground = meeting_point(runs - middle, np.ones(runs.shape[:2], bool))
    if ground is None:
        return None
    ground = ground + middle[:2]
    level = np.hypot(runs[..., 0] - ground[0], runs[..., 1] - ground[1])
    low, high = np.percentile(points[:, 2], (0, 100))
    for _ in range(_ROUNDS):
        heights = np.linspace(low, high, _HEIGHTS)
        uneven = [_unevenness(level, runs[..., 2] - height) for height in heights]
        best, step = heights[int(np.argmin(uneven))], heights[1] - heights[0]
        low, high = best - 2 * step, best + 2 * step
    return np.array([*ground, best])


def _unevenness(level, height):
    """How much the steps of the elevation differ within a run; 0 for a scanner's own place."""
    steps = np.diff(np.arctan2(height, level), axis=0)
    usual = np.median(steps, axis=0)
    moving = np.abs(usual) > 1e-9
    if not moving.any():
        return np.inf
    away = np.median(np.abs(steps[:, moving] - usual[moving]), axis=0)
    return float(np.median(away / np.abs(usual[moving])))
