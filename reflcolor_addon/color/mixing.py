"""How much of each estimate a pixel gets: eq. 1, along paths, or kriging.

Near a seed a path is the better guide, far from all seeds kriging is. The share of kriging therefore grows with the
geodesic distance r to the nearest seed,

    s(r) = sqrt(r) / (sqrt(r) + q sqrt(R)),

and q is the one with which the seeds are estimated best when each is left out. Seeds that a person picked are no such
test: one on each surface, they are far from each other, while most pixels are near to one. There the paths are trusted,
and with up to twice the alpha, as the paper has it. Where paths over the smoothed reflectance do not tell several such
seeds apart, smoothing has opened the border between two surfaces, and paths over the reflectance as it is take over,
the sooner, the better these estimate left-out seeds.
"""

import math
from typing import NamedTuple

import numpy as np

# R, in units of the geodesic distance: an eighth of the reflectance's whole range.
_MIDDLE = 32.0
# The values of q that are tried, and the one for seeds picked by a person.
_ODDS, _PICKED_ODDS = np.exp(np.linspace(-5, 5, 41)), math.exp(5)
PICKED_GAIN = 2.0
"""Factor of alpha for seeds picked by a person."""
# The weight of the expected share at R, in seeds.
_EXPECTED_SEEDS = 30
# Between the first and the second value seeds count as picked by a person to a growing degree. First pair: variation of
# the angles between neighbors, relative to their mean. Second: median distance from pixels to seeds, relative to that
# between seeds.
_UNEVEN, _NEAR = (0.22, 0.31), (0.85, 0.7)
# From the first to the second value of the error of left-out seeds along smoothed paths, relative to that along paths
# over the reflectance as it is, the latter take over sooner.
_BETTER = (1.0, 1.05)


class Mixture(NamedTuple):
    """What the share of kriging is."""

    odds: float
    """q: the share of eq. 1 to that of kriging at R."""

    def share(self, distances):
        """Return the share of kriging, float32 of 0 to 1, at geodesic distances to the nearest seed."""
        root = np.sqrt(np.where(np.isfinite(distances), distances, 1e6), dtype=np.float32)
        total = root + np.float32(self.odds * math.sqrt(_MIDDLE))
        # With kriging alone, even a seed's own pixel is estimated by kriging.
        return np.divide(root, total, out=np.ones_like(root), where=total > 0)


def mixture(kriging_residuals, path_residuals, apart, expected, picked):
    """Return the Mixture that estimates left-out seeds best.

    Parameters
    ----------
    kriging_residuals, path_residuals : (S, C) float
        Values of each seed, less the estimate of either from the others.
    apart : (S,) float
        Geodesic distance from each seed to the nearest other one; infinite where none reaches it.
    expected : float, 0 to 1
        What the share at R is drawn to, the more so the fewer seeds there are.
    picked : float, 0 to 1
        How much the seeds pass for picked by a person; see `picked_by_a_person`.
    """
    if expected in (0, 1):
        return Mixture(math.inf if expected == 0 else 0.0)
    shares = [Mixture(odds).share(apart)[:, None] for odds in _ODDS]
    errors = [np.linalg.norm(s * kriging_residuals + (1 - s) * path_residuals, axis=1).sum() for s in shares]
    least, odds = min(errors), 1 / expected - 1
    if least > 0:
        cost = len(apart) * np.array(errors) / least + _EXPECTED_SEEDS * (1 / (1 + _ODDS) - expected) ** 2
        odds = float(_ODDS[np.argmin(cost)])
    # The share at R lies between the two.
    return Mixture(1 / ((1 - picked) / (1 + odds) + picked / (1 + _PICKED_ODDS)) - 1)


def picked_by_a_person(directions, apart, least):
    """Return how much seeds look as if a person had picked them, one on each surface: 0 to 1.

    Parameters
    ----------
    directions : (S, 3) float
        From the scanner, in any unit.
    apart : (S,) float
        As in `mixture`.
    least : (N,) float
        Geodesic distance from each pixel to the nearest seed; infinite where none reaches.
    """
    from scipy.spatial import cKDTree

    apart, least = apart[np.isfinite(apart)], least[np.isfinite(least)]
    if not len(apart):
        return 0.0
    between = cKDTree(directions).query(directions, k=2)[0][:, 1]
    uneven = between.std() / between.mean() if between.any() else 0.0
    between_seeds = float(np.median(apart))
    near = float(np.median(least)) / between_seeds if between_seeds > 0 else 1.0
    return float(_step(uneven, *_UNEVEN) * _step(near, *_NEAR))


def unsmoothed_share(weight, picked, smoothed_residuals, residuals):
    """Return the share of the paths over the reflectance as it is, beside those over the smoothed one: float32, 0 to 1.

    Parameters
    ----------
    weight : (H, W) float32
        Of all seeds together, that of the nearest one being 1, along paths over the smoothed reflectance: 1 where one
        seed alone counts, 2 where two are equally near, and so on.
    picked : float, 0 to 1
        As in `mixture`.
    smoothed_residuals, residuals : (S, C) float
        Values of each seed, less the estimate from the others along either kind of paths.
    """
    smoothed, unsmoothed = (np.linalg.norm(off, axis=1).sum() for off in (smoothed_residuals, residuals))
    better = np.float32(_step(smoothed / unsmoothed, *_BETTER)) if unsmoothed > 0 else np.float32(smoothed > 0)
    squared = np.maximum(weight, np.float32(1)) ** 2
    fourth = squared * squared
    alone = 1 / squared
    return np.float32(picked) * (1 - alone + better * (alone - 1 / (fourth * fourth)))


def nearest_other(distances, seeds):
    """Return the (S,) distance from each seed to the nearest other one, from (S, k) lists of what lies near it."""
    own = (seeds == np.arange(len(seeds))[:, None]) | (seeds < 0)
    return np.where(own, np.inf, distances).min(axis=1)


def _step(value, start, end):
    """0 up to the start, 1 from the end on, straight between them."""
    return np.clip((value - start) / (end - start), 0, 1)
