"""Several photos of one site: exposures and white balances reconciled where they overlap, and their colors blended."""

import numpy as np

from ...srgb import linear_to_srgb8, srgb8_to_linear

_LEAST_OVERLAP = 40
_TRUSTED = (12, 245)
# Light that differs by this much (median deviation of the logarithm) from pixel to pixel is not one photo's gain.
_LARGEST_SPREAD = 0.5
_KEEP = 0.05
_FAVORING_THE_BEST = 4.0
_LARGEST_GAIN = np.log(8.0)


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
    # A weak wish to stay as it is settles what only differences are known of.
    system = np.vstack([np.array(rows) * weights, np.eye(count) * _KEEP])
    wanted = np.vstack([np.array(values) * weights, np.zeros((count, 3))])
    logarithm = np.linalg.lstsq(system, wanted, rcond=None)[0]
    return np.exp(np.clip(logarithm, -_LARGEST_GAIN, _LARGEST_GAIN))


def blended(views, photo_gains):
    """Blend the photos of one scan.

    Parameters
    ----------
    views : sequence of View or None
    photo_gains : (P, 3) float64
        See `gains`.

    Returns
    -------
    rgb : (h, w, 3) uint8
    source : (h, w) int
        The photo that contributes most; -1 where none shows the pixel.
    quality : (h, w) float32
        Of that photo.
    """
    shape = next(view.usable.shape for view in views if view is not None)
    total, weight = np.zeros((*shape, 3)), np.zeros(shape)
    best, source = np.zeros(shape, np.float32), np.full(shape, -1)
    for index, view in enumerate(views):
        if view is None:
            continue
        # The fourth power of a tenth: a view from behind counts for nothing beside one from the front.
        own = np.where(view.usable, view.quality.astype(np.float64) ** _FAVORING_THE_BEST + 1e-12, 0)
        total += own[..., None] * (srgb8_to_linear(np.rint(view.rgb).astype(np.uint8)) * photo_gains[index])
        weight += own
        better = view.usable & (view.quality >= best)
        source[better] = index
        best[better] = view.quality[better]
    light = total / np.maximum(weight, 1e-300)[..., None]
    return linear_to_srgb8(np.clip(light, 0, 1)), source, best


def _ratio(first, second):
    """(3,) median logarithm of first over second in linear light, over what both show, and how many pixels that is."""
    ratios = []
    for one, other in zip(first, second, strict=True):
        if one is None or other is None:
            continue
        both = one.usable & other.usable & ~one.behind & ~other.behind
        for view in (one, other):
            both &= (view.rgb.min(axis=-1) >= _TRUSTED[0]) & (view.rgb.max(axis=-1) <= _TRUSTED[1])
        light = [srgb8_to_linear(np.rint(view.rgb[both]).astype(np.uint8)) for view in (one, other)]
        ratios.append(np.log(light[0]) - np.log(light[1]))
    ratios = np.concatenate(ratios) if ratios else np.zeros((0, 3))
    if len(ratios) < _LEAST_OVERLAP:
        return None, 0
    middle = np.median(ratios, axis=0)
    if np.median(np.abs(ratios - middle), axis=0).max() > _LARGEST_SPREAD:
        return None, 0
    return middle, len(ratios)
