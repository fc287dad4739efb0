"""Colors estimated by kriging: regression on what the scan knows of every pixel.

Surfaces of one material tend to have one color. Two pixels are likely to be of one material if they have a like
reflectance and a like normal, and lie close together; a path between them, as the geodesic distance asks for, is not
needed. Ordinary kriging (Matheron 1963; Gaussian process regression with a constant mean) takes

    k(i, j) = exp(-|f_i - f_j|)

as the covariance of chrominance, and of luminance by itself, f being the features below, and estimates
m + k(i, .) (K + N)^-1 (c - m). N is a diagonal of nuggets: the variance of a seed's color about that of its
surroundings, as a share of the whole variance. The seeds themselves tell how large it is, because the error of
estimating each from all others has a closed form.
"""

import numpy as np

from ..native import library
from ..native.kriging import FEATURES, exponential_sums
from ..scan.normals import surface_normals

# What makes two pixels different: each of these is one unit of distance between their features.
SCALES = {
    # As a share of the scan's angular extent: the side of a square with the same spread of directions.
    "direction": 0.5,
    # Of the range 0..255.
    "luminance": 0.5,
    # Natural logarithm: a factor of 2 in range.
    "log_range": 0.7,
    # Opposite walls are 0.5 apart.
    "normal": 4.0,
}
NUGGETS = (0.02, 0.04, 0.08, 0.16, 0.32)
MAX_SEEDS = 8000
"""The matrix of their covariances takes 0.5 GB."""

# A seed whose error is this many times the median is noisy; its nugget grows with the excess, to the limit.
_OUTLIER = 4.0
_OUTLIER_GAIN, _OUTLIER_LIMIT = 0.1, 5.0
# Seeds are left out one by one in groups of at most this many: the cost grows with the cube.
_GROUP = 1000
# Covariances computed between two checks for cancellation, about 0.1 s; without the kernel, the size of the matrix in
# memory.
_CHUNK_VALUES, _CHUNK_VALUES_HELD = 1 << 26, 1 << 21


def pixel_features(scan, luminance):
    """Return the (H * W, 8) float32 features of all pixels, in units of likeness; zeros where not valid.

    Parameters
    ----------
    scan : Scan
    luminance : (H, W) float32
        Normalized reflectance, 0..255.
    """
    valid = scan.valid
    distance = np.maximum(scan.range, np.finfo(np.float32).tiny)
    features = np.empty((*scan.shape, FEATURES), np.float32)
    direction = np.divide(scan.points, distance[..., None], out=features[..., 0:3], casting="same_kind")
    # Of unit vectors; and a square of side s has a mean squared distance from its center of s^2 / 6.
    variance = 1 - np.sum(direction[valid].mean(axis=0, dtype=np.float64) ** 2)
    # An array of one number: by a number alone NumPy 1 would divide in single precision, NumPy 2 does not.
    direction /= np.array([max(np.sqrt(6 * max(variance, 0)), 1e-6) * SCALES["direction"]])
    features[..., 3] = luminance / (255 * SCALES["luminance"])
    features[..., 4] = np.log(distance) / SCALES["log_range"]
    features[..., 5:8] = surface_normals(scan.points, valid, wrap=scan.full_turn) / SCALES["normal"]
    features[~valid] = 0
    return features.reshape(-1, FEATURES)


class Kriging:
    """Fitted to seeds; estimates the values of pixels.

    Parameters
    ----------
    features : (S, 8) float
        Of the seeds; at most `MAX_SEEDS`.
    values : (S, C) float
        Their chrominance, and what else is to be estimated.
    parts : sequence of slice, optional
        Of the channels; how noisy the seeds are is told apart for each part. By default all channels are one.
    """

    def __init__(self, features, values, parts=(slice(None),)):
        self._features = np.asarray(features, np.float64)
        values = np.asarray(values, np.float64)
        covariance = _covariance(self._features, self._features)
        groups = _groups(len(values))
        self._mean, self._weights = np.empty(values.shape[1]), np.empty_like(values)
        self.residuals = np.empty_like(values)
        """(S, C): values of each seed, less what is estimated from the others."""
        for part, nuggets in zip(parts, _nuggets(covariance, values, groups, parts), strict=True):
            own = values[:, part]
            weights = np.linalg.solve(covariance + np.diag(nuggets), np.column_stack([np.ones(len(own)), own]))
            self._mean[part] = weights[:, 1:].sum(axis=0) / weights[:, 0].sum()
            self._weights[:, part] = weights[:, 1:] - weights[:, :1] * self._mean[part]
            for group in groups:
                among = covariance[np.ix_(group, group)]
                self.residuals[group, part], _ = _residuals(among, own[group], nuggets[group])

    def chunks(self, count, least=1):
        """Return slices that part ``count`` pixels: at least so many, and each fits well into memory."""
        values = _CHUNK_VALUES if library.available() else _CHUNK_VALUES_HELD
        step = max(1, min(values // len(self._features), -(-count // least)))
        return [slice(start, min(count, start + step)) for start in range(0, count, step)]

    def estimate(self, features):
        """Return the (N, C) values of pixels with (N, 8) features: float32 by the kernel, else float64.

        The two differ by 1e-3 at most (docs/performance.md).
        """
        if library.available():
            return exponential_sums(features, self._features, self._weights) + self._mean.astype(np.float32)
        covariance = _covariance(np.asarray(features, np.float64), self._features)
        return np.einsum("ns,sc->nc", covariance, self._weights) + self._mean


def _covariance(one, other):
    """exp(-|f_i - f_j|) for (N, F) and (S, F) features: (N, S)."""
    # Without BLAS, whose own threads would compete with those that estimate chunks.
    squared = np.einsum("nf,fs->ns", one, np.ascontiguousarray(-2 * other.T))
    squared += np.einsum("ij,ij->i", one, one)[:, None]
    squared += np.einsum("ij,ij->i", other, other)
    # The difference of large numbers may fall below zero.
    np.maximum(squared, 0, out=squared)
    np.sqrt(squared, out=squared)
    np.negative(squared, out=squared)
    return np.exp(squared, out=squared)


def _groups(count):
    """Index arrays that part the seeds evenly, each small enough to leave its seeds out one by one."""
    number = -(-count // _GROUP)
    return [np.arange(first, count, number) for first in range(number)]


def _nuggets(covariance, values, groups, parts):
    """For each part of the channels, (S,) nuggets: the one of NUGGETS that foretells left-out seeds best, more for
    seeds that fit badly."""
    seen = [(covariance[np.ix_(group, group)], values[group]) for group in groups]
    trials = [[_residuals(*of, np.full(len(of[1]), nugget)) for of in seen] for nugget in NUGGETS]
    found = []
    for part in parts:
        totals = [sum(np.linalg.norm(off[:, part], axis=1).sum() for off, _ in trial) for trial in trials]
        best = int(np.argmin(totals))
        nuggets = np.empty(len(values))
        for group, (residuals, precision) in zip(groups, trials[best], strict=True):
            # Relative to the error expected from the covariance alone.
            error = np.linalg.norm(residuals[:, part], axis=1) * np.sqrt(precision)
            median = np.median(error)
            excess = (error / median / _OUTLIER) ** 2 - 1 if median > 0 else np.zeros(len(group))
            nuggets[group] = NUGGETS[best] + np.clip(_OUTLIER_GAIN * excess, 0, _OUTLIER_LIMIT)
        found.append(nuggets)
    return found


def _residuals(covariance, values, nuggets):
    """(S, C) values less what is estimated from the other seeds, and (S,) reciprocal variances of that."""
    inverse = np.linalg.inv(covariance + np.diag(nuggets))
    mean = (inverse @ values).sum(axis=0) / inverse.sum()
    precision = np.diag(inverse)
    return inverse @ (values - mean) / precision[:, None], precision
