"""Several photos of one site: exposures and white balances reconciled where they overlap."""

import numpy as np

from ...srgb import srgb8_to_linear

_LEAST_OVERLAP = 40
_TRUSTED = (12, 245)
# Light that differs by this much (median deviation of the logarithm) from pixel to pixel is not one photo's gain.
_LARGEST_SPREAD = 0.5
_KEEP = 0.05
_LARGEST_GAIN = np.log(8.0)
# Pixels of a pair of photos that are compared, on each scan.
_MOST_COMPARED = 1 << 18


def gains(views):
    """Return the (P, 3) gains, of linear light, that make P photos agree.

    Parameters
    ----------
    views : sequence of sequences of View or None
        For every scan, for every photo; None where that photo shows nothing of that scan.

    Returns
    -------
    (P, 3) float64
        Ones where a photo overlaps no other, or where what both show differs by more than a gain. Their geometric mean
        over the photos is about 1: no photo is the master.
    """
    count = len(views[0]) if views else 0
    rows, values, weights = [], [], []
    for first in range(count):
        for second in range(first + 1, count):
            ratio, pixels = _ratio([scan[first] for scan in views], [scan[second] for scan in views])
            if ratio is not None:
                row = np.zeros(count)
                row[first], row[second] = 1, -1
                rows.append(row)
                values.append(-ratio)
                weights.append(np.sqrt(pixels))
    if not rows:
        return np.ones((count, 3))
    weights = np.array(weights)[:, None] / max(weights)
    # A weak pull toward the original exposure settles what the differences leave open.
    system = np.vstack([np.array(rows) * weights, np.eye(count) * _KEEP])
    wanted = np.vstack([np.array(values) * weights, np.zeros((count, 3))])
    logarithm = np.linalg.lstsq(system, wanted, rcond=None)[0]
    return np.exp(np.clip(logarithm, -_LARGEST_GAIN, _LARGEST_GAIN))


def _ratio(first, second):
    """(3,) median logarithm of first over second in linear light, over what both show, and how many pixels that is."""
    ratios = []
    for one, other in zip(first, second, strict=True):
        if one is None or other is None:
            continue
        both = np.flatnonzero(one.sure & other.sure & ~one.behind & ~other.behind)
        both = both[:: -(-len(both) // _MOST_COMPARED) or 1]
        colors = [view.rgb.reshape(-1, 3)[both] for view in (one, other)]
        trusted = np.logical_and.reduce(
            [(own.min(axis=1) >= _TRUSTED[0]) & (own.max(axis=1) <= _TRUSTED[1]) for own in colors]
        )
        light = [srgb8_to_linear(own[trusted]) for own in colors]
        ratios.append(np.log(light[0]) - np.log(light[1]))
    ratios = np.concatenate(ratios) if ratios else np.zeros((0, 3))
    if len(ratios) < _LEAST_OVERLAP:
        return None, 0
    middle = np.median(ratios, axis=0)
    if np.median(np.abs(ratios - middle), axis=0).max() > _LARGEST_SPREAD:
        return None, 0
    return middle, len(ratios)
