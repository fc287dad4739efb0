"""The weighted mean of eq. 1 in NumPy: over all seeds, one after another, or over the nearest of every pixel.

The weights r^-alpha (eq. 2) overflow for small r, so they are taken relative to the least distance r_min of a pixel:
w = (r / r_min)^-alpha, at most 1. Seeds at distance 0 share the pixel equally.
"""

import numpy as np

from .kernel import Mean

# Size of the tables of the seeds' values, as in the kernel, and how many chords bound the change of a mean.
_BINS, _CHORDS, _FINE = 256, 3, 0.25
_RAISED = 1.0001


class Blend:
    """Sums eq. 1 over seeds that come one after another; when a nearer seed comes, the sums are scaled down.

    Parameters
    ----------
    shape : (H, W)
    alpha : float
    channels : int
        How many values a seed has.
    """

    def __init__(self, shape, alpha, channels=2):
        self._alpha = alpha
        self._count = 0
        self._weight = np.zeros(shape)
        self._sums = np.zeros((channels, *shape))
        self._least = np.full(shape, np.inf)
        self._nearest_seed = np.full(shape, -1, np.int32)

    def add(self, distances, values, control=None):
        """Add a seed: its (H, W) distances, infinite where it does not reach, and its value in each channel."""
        distances = np.asarray(distances, np.float64)
        nearer = distances < self._least
        farther, least = np.where(nearer, self._least, distances), np.where(nearer, distances, self._least)
        weight = _relative_weight(farther, least, self._alpha)
        own, kept = np.where(nearer, 1.0, weight), np.where(nearer, weight, 1.0)
        self._weight = self._weight * kept + own
        self._sums = self._sums * kept + own * np.reshape(values, (-1, 1, 1))
        self._least = least
        self._nearest_seed[nearer] = self._count
        self._count += 1

    def add_all(self, fields, values, control=None, run=map):
        """Add several seeds."""
        for distances, own in zip(fields, values, strict=True):
            self.add(distances, own)

    def mean(self, keep=True):
        """Return the Mean of the seeds so far; more can be added afterwards, if the sums are kept."""
        reached = np.isfinite(self._least)
        means = np.where(reached, self._sums, 0) / np.where(reached, self._weight, 1)
        single = (array.astype(np.float32) for array in (means, np.where(reached, self._weight, 0), self._least))
        means, weight, least = single
        return Mean(
            values=means,
            weight=weight,
            nearest_seed=self._nearest_seed.copy() if keep else self._nearest_seed,
            least=least,
        )


def blend_nearest(distances, seeds, values, alpha):
    """Take eq. 1 over the k nearest seeds of every pixel.

    Parameters
    ----------
    distances : (H, W, k) float32
        Ascending; infinite in empty places.
    seeds : (H, W, k) int32
        -1 in empty places.
    values : (S, C) float
        What is blended, of all seeds.
    alpha : float

    Returns
    -------
    mean : Mean
    bound : (H, W) float32
        The most by which the seeds left out could change any channel, if each lies no nearer than the k-th:
        then each has a weight from 0 to that of the k-th, w_k. If the mean m of weight W moves by t, those beyond
        m + t have pushed it there, W t <= w_k q(t), with q(t) the sum of how far they lie beyond. q is convex, so that
        chords between places where it is known lie above it, and where they meet W t / w_k bounds t.
    """
    values = np.asarray(values, np.float64)
    means, weights = weighted_mean(distances, seeds, values, alpha)
    total = weights.sum(axis=-1)
    reached = total > 0
    means = np.moveaxis(means, -1, 0)
    every = seeds.shape[-1] < len(values)
    each = np.where((seeds[..., -1] >= 0) & every, weights[..., -1], 0)
    bound = np.max(
        [
            _shift(values[:, i], means[i], seeds, np.where(reached, total, 1), each, side)
            for i in range(len(means))
            for side in (1, -1)
        ],
        axis=0,
    )
    mean = Mean(
        values=means.astype(np.float32),
        weight=total.astype(np.float32),
        nearest_seed=seeds[..., 0].copy(),
        least=distances[..., 0].copy(),
    )
    return mean, np.where(reached, bound, 0).astype(np.float32)


def weighted_mean(distances, seeds, values, alpha):
    """Take eq. 1 over lists of seeds.

    Parameters
    ----------
    distances, seeds : (..., k) float32, (..., k) int32
        As in `blend_nearest`.
    values : (S, C) float
    alpha : float

    Returns
    -------
    means : (..., C) float64
        0 where a list is empty.
    weights : (..., k) float64
        Relative to that of the nearest; 0 in empty places.
    """
    each = distances.astype(np.float64)
    weights = _relative_weight(each, np.broadcast_to(each[..., :1], each.shape), alpha)
    total = weights.sum(axis=-1, keepdims=True)
    sums = (weights[..., None] * np.asarray(values, np.float64)[seeds]).sum(axis=-2)
    return sums / np.where(total > 0, total, 1), weights


def _shift(values, mean, seeds, total, each, side):
    """Bound how far the seeds that are not listed can move a mean up (side 1) or down (side -1).

    A seed that is not listed has a weight of at most w (``each``); the listed ones have the mean m and together the
    weight W (``total``). If the others move the mean up by t, then W t = sum of w_j (v_j - m - t) over them. Only
    values beyond m + t pull up, so that W t <= w q(t), with q(t) = sum of max(v_j - m - t, 0). As q falls with t, the
    bound is where w q(t) = W t. It is enclosed from above:

    - ``table`` has q of all seeds at a few values. q is convex, so linear interpolation is never below it. At t = 0
      the listed seeds are subtracted (``beyond``), and q is never larger than there.
    - The first bound is where the chord from q(0) = ``beyond`` to q(``span``) = 0 meets W t / w; ``span`` is the
      distance from the mean to the largest value.
    - Each round halves the bracket from t0 to t, keeps the half that holds the solution, and takes the place where its
      chord meets W t / w. A bound that is small already stays.

    Down is the same with all values negated.
    """
    values, mean = side * values, side * mean
    edges = np.linspace(values.min(), values.max(), _BINS + 1)
    table = _RAISED * np.maximum(values[:, None] - edges, 0).sum(axis=0)
    listed = np.where(seeds >= 0, np.maximum(values[seeds] - mean[..., None], 0), 0).sum(axis=-1)
    beyond, span = np.interp(mean, edges, table) - listed, values.max() - mean
    moved = (each > 0) & (beyond > 0) & (span > 0)
    beyond, each = np.where(moved, beyond, 1), np.where(moved, each, 1)
    t0, q0, t = np.zeros(mean.shape), beyond, each * beyond / (total + each * beyond / np.where(moved, span, 1))
    for _ in range(_CHORDS):
        q = np.minimum(np.minimum(np.interp(mean + t, edges, table), beyond), total * t / each)
        middle = (t0 + t) / 2
        q_middle = np.minimum(np.interp(mean + middle, edges, table), beyond)
        farther = each * q_middle > total * middle
        t0, q0 = np.where(farther, middle, t0), np.where(farther, q_middle, q0)
        end, q = np.where(farther, t, middle), np.where(farther, q, q_middle)
        slope = (q0 - q) / np.where(moved, end - t0, 1)
        met = each * (q0 + slope * t0) / (total + each * slope)
        t = np.where(t > _FINE, np.minimum(met, end), t)
    return np.where(moved, t, 0)


def leave_one_out(distances, seeds, values, alpha):
    """Take eq. 1 at every seed's own pixel, over the other seeds near it.

    Parameters
    ----------
    distances : (S, k) float32
        From each seed's pixel to the k nearest seeds, itself among them or not; infinite in empty places.
    seeds : (S, k) int32
        Which these are; -1 in empty places.
    values : (S, C) float
    alpha : float

    Returns
    -------
    (S, C) float32
        0 where no other seed is near.
    """
    own = seeds == np.arange(len(values))[:, None]
    distances = np.where(own, np.inf, distances)
    order = np.argsort(distances, axis=1, kind="stable")
    distances, seeds = (np.take_along_axis(array, order, axis=1) for array in (distances, seeds))
    return weighted_mean(distances, seeds, values, alpha)[0].astype(np.float32)


def _relative_weight(distance, least, alpha):
    """(distance / least)^-alpha, in 0..1; 1 for two zeros, 0 for any other distance against zero or if unreached."""
    weight = np.zeros(distance.shape)
    weight[(distance == 0) & (least == 0)] = 1.0
    proper = (least > 0) & np.isfinite(distance)
    # Not (distance / least)^-alpha, which overflows if the least distance is close to the smallest float.
    weight[proper] = (least[proper] / distance[proper]) ** alpha
    return weight
