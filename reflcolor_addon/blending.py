"""The weighted mean of eq. 1, taken seed by seed in memory that does not grow with the number of seeds."""

import numpy as np


class Blend:
    """Sums eq. 1 over seeds that come one after another.

    The weights r^-alpha (eq. 2) overflow for small r, so the sums are kept relative to the least distance so far:
    w = (r / r_min)^-alpha, at most 1. When a nearer seed comes, the sums are scaled down. Seeds at distance 0 share the
    pixel equally.

    Parameters
    ----------
    shape : (H, W)
    alpha : float
    """

    def __init__(self, shape, alpha):
        self._alpha = alpha
        self._count = 0
        self._weights = np.zeros(shape)
        self._sums = np.zeros((*shape, 2))
        self.least = np.full(shape, np.inf)
        self.nearest_seed = np.full(shape, -1, np.int32)

    def add(self, distance, chrominance):
        """Add one seed: (H, W) distances (infinite where it does not reach) and its (2,) chrominance."""
        distance = np.asarray(distance, np.float64)
        nearer = distance < self.least
        farther, nearest = np.where(nearer, self.least, distance), np.where(nearer, distance, self.least)
        weight = _relative_weight(farther, nearest, self._alpha)
        own, kept = np.where(nearer, 1.0, weight), np.where(nearer, weight, 1.0)
        self._weights = self._weights * kept + own
        self._sums = self._sums * kept[..., None] + own[..., None] * np.asarray(chrominance)
        self.least = nearest
        self.nearest_seed[nearer] = self._count
        self._count += 1

    def chrominance(self):
        """Return the (H, W, 2) float64 chrominance of every pixel; 0 where no seed reaches."""
        reached = np.isfinite(self.least)
        return np.where(reached[..., None], self._sums, 0) / np.where(reached, self._weights, 1)[..., None]


def _relative_weight(farther, nearest, alpha):
    """(farther / nearest)^-alpha, in 0..1; 1 for two zeros, 0 for anything against zero or for the unreached."""
    weight = np.zeros(farther.shape)
    weight[farther == 0] = 1.0
    proper = (farther > 0) & np.isfinite(farther)
    # This way around nothing can overflow.
    weight[proper] = (nearest[proper] / farther[proper]) ** alpha
    return weight
