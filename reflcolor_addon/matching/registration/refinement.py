"""Fitting a model to a photo by tiles of the scan, each sought in the photo near where the model puts it.

A tile alone is often wrong, so no tile decides where it is: it gives a surface of scores over all shifts, and the model
whose shifts collect the highest sum wins. That is robust where nine of ten tiles have several peaks, and cheap: once
the surfaces are there, a candidate costs a look-up per tile.
"""

from dataclasses import dataclass

import numpy as np

PENALTY = 0.004
"""Per squared unit, so that what the photo does not tell stays as it is."""

_OUTSIDE = -0.5
_CANDIDATES = 300
_GENERATIONS = 14
_NEAR_TOP = 3.0
# Holds what the tiles do not tell, against their pixels: a unit of change is a pixel's fiftieth.
_HOLD = 0.02
# Pixels by which the top of a tile's surface is off.
_TOP_OFF = 1.5


@dataclass(frozen=True, eq=False)
class HandPairs:
    """Pairs picked by hand, which hold a camera beside the tiles.

    points : (K, 3) float64
        Meters, scanner frame.
    xy : (K, 2) float64
        Pixels from the photo's top left corner.
    sigma : float
        How far they are off, in pixels of the photo.
    weight : float
        Of a pair beside a tile. Tiles overlap, and where the scan's image is finer than its grid, what they say is
        said several times.
    """

    points: np.ndarray
    xy: np.ndarray
    sigma: float
    weight: float = 1.0

    def off(self, model):
        """Return how far the camera is off at the pairs, in their own deviations (root mean square)."""
        return float(np.sqrt(self.doubt(model, np.zeros((1, len(model.ALL))), 1.0)[0] / len(self.xy)))

    def doubt(self, model, candidates, scale):
        """Return (K,) half the squared deviations, summed over the pairs, of candidates."""
        away = model.projections(candidates, self.points, scale) - self.xy
        return 0.5 * (np.nan_to_num(away / self.sigma, nan=1e3) ** 2).sum(axis=(1, 2))


def fitted(surfaces, model, free, *, blur, spread, rng, pairs=None):
    """Return the model near ``model`` that collects the highest mean score, and that score.

    Parameters
    ----------
    surfaces : Surfaces
    model : Camera or GridHomography
    free : sequence of int
        Which of the model's numbers may change.
    blur : float
        Pixels by which the surfaces are smoothed, so that the way to the top is found.
    spread : float
        How far around candidates are sought, in the model's units.
    rng : numpy.random.Generator
    pairs : HandPairs, optional
        They count as the tiles do: a tile's score is taken as the logarithm of how likely its place is.
    """
    import cv2

    free = list(free)
    # All surfaces side by side in one image; their borders are repeated far enough not to mix.
    reach = int(3 * blur) + 1
    stacked = np.pad(surfaces.scores, ((0, 0), (reach, reach), (reach, reach)), mode="edge")
    blurred = cv2.GaussianBlur(stacked.reshape(-1, stacked.shape[2]), (2 * reach + 1, 2 * reach + 1), blur)
    scores = np.ascontiguousarray(blurred.reshape(stacked.shape)[:, reach:-reach, reach:-reach])
    count = 8 if model.kind == "homography" else len(model.UNITS)

    def value(candidates):
        shift = surfaces.shifts(model.projections(candidates, surfaces.sites, surfaces.scale))
        worth = looked_up(scores, shift).mean(axis=1) - PENALTY * (candidates**2).sum(axis=1)
        if pairs is not None:
            worth -= pairs.weight * pairs.doubt(model, candidates, surfaces.scale) / len(scores)
        return worth

    parents = np.zeros((1, count))
    spread_now = spread
    for generation in range(_GENERATIONS):
        children = np.repeat(parents, -(-(_CANDIDATES if generation == 0 else 120) // len(parents)), axis=0)
        children[:, free] += rng.standard_normal((len(children), len(free))) * spread_now
        candidates = np.vstack([parents, children])
        values = value(candidates)
        best = np.argsort(-values, kind="stable")[: 6 if generation < 6 else 3]
        parents = candidates[best]
        spread_now *= 0.7
    return model.moved(parents[0], surfaces.scale), float(values[best[0]])


def tightened(surfaces, model, free, pairs=None):
    """Return the model fitted by least squares to the tiles that lie nearly where it puts them, or the same one.

    Only its ``free`` numbers change. What `fitted` leaves, a pixel or so, is taken away: the tops of the tiles'
    surfaces are known to a fraction of that.
    """
    from scipy.optimize import least_squares

    shift = _tops(surfaces.scores)
    near = np.hypot(*shift.T) <= _NEAR_TOP
    free = list(free)
    if near.sum() < 2 * len(free):
        return model
    sites, forward = surfaces.sites[near], np.linalg.pinv(surfaces.inverse[near])
    targets = surfaces.places[near] + np.einsum("nij,nj->ni", forward, shift[near])

    def candidate(values):
        all_numbers = np.zeros(len(model.ALL))
        all_numbers[free] = values
        return all_numbers

    def off(values):
        places = model.projections(candidate(values)[None], sites, surfaces.scale)[0]
        pixels = np.einsum("nij,nj->ni", surfaces.inverse[near], np.nan_to_num(places - targets, nan=1e3))
        held = [pixels.ravel(), _HOLD * np.sqrt(len(sites)) * values]
        if pairs is not None:
            picked = model.projections(candidate(values)[None], pairs.points, surfaces.scale)[0] - pairs.xy
            held.append(np.sqrt(pairs.weight) * _TOP_OFF / pairs.sigma * np.nan_to_num(picked, nan=1e3).ravel())
        return np.concatenate(held)

    solved = least_squares(off, np.zeros(len(free)), loss="soft_l1", f_scale=0.7, max_nfev=60)
    # So that what NumPy's releases round differently far behind the point does not grow from round to round.
    return model.moved(candidate(np.round(solved.x, 4)), surfaces.scale)


def _tops(scores):
    """(N, 2): shift right and down to the highest score of each surface, to a fraction of a pixel."""
    count, window = scores.shape[:2]
    row, col = np.divmod(scores.reshape(count, -1).argmax(axis=1), window)
    tile = np.arange(count)

    def fraction(before, top, after):
        bend = before - 2 * top + after
        return np.where(bend < -1e-6, 0.5 * (before - after) / np.minimum(bend, -1e-6), 0.0)

    inside = [np.clip(index, 1, window - 2) for index in (row, col)]
    top = scores[tile, row, col]
    right = fraction(scores[tile, row, inside[1] - 1], top, scores[tile, row, inside[1] + 1])
    down = fraction(scores[tile, inside[0] - 1, col], top, scores[tile, inside[0] + 1, col])
    edge = (row != inside[0]) | (col != inside[1])
    shift = np.column_stack([col + np.where(edge, 0, right), row + np.where(edge, 0, down)])
    return shift - window // 2


def looked_up(scores, shift):
    """Return the (K, N) scores at (K, N, 2) shifts (right, down), bilinearly; low where beyond the surfaces or NaN."""
    count, window = scores.shape[:2]
    places = np.moveaxis(shift, -1, 0) + window // 2
    inside = ((places >= 0) & (places <= window - 1)).all(axis=0)
    places = np.where(inside, np.minimum(places, window - 1 - 1e-6), 0)
    whole = places.astype(int)
    right, down = places - whole
    # Counted through all surfaces, one after the other.
    at = (np.arange(count) * window + whole[1]) * window + whole[0]
    every = scores.ravel()
    top = every[at] * (1 - right) + every[at + 1] * right
    bottom = every[at + window] * (1 - right) + every[at + window + 1] * right
    return np.where(inside, top * (1 - down) + bottom * down, _OUTSIDE)
