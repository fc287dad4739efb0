"""Reflectance and range brought to 0..255, as eq. 6 expects them."""

import numpy as np

PERCENTILES = (1.0, 99.0)


def normalize(values, valid):
    """Stretch the valid values between their robust percentiles to 0..255.

    Parameters
    ----------
    values : (H, W) float
        Raw reflectance, or range in meters.
    valid : (H, W) bool

    Returns
    -------
    image : (H, W) float32
        0..255, clipped; 0 where not valid, and everywhere if the valid values are all the same.
    limits : (low, high) of float
        The values that became 0 and 255: the percentiles ``PERCENTILES`` of the valid pixels, or their least and
        greatest value where the percentiles coincide.
    """
    values = np.asarray(values)
    inside = values[valid].astype(np.float64)
    image = np.zeros(values.shape, np.float32)
    if inside.size == 0:
        return image, (0.0, 0.0)
    low, high = (float(limit) for limit in np.percentile(inside, PERCENTILES))
    if low == high:
        # Nearly all pixels are equal; the little contrast there is lies beyond the percentiles.
        low, high = float(inside.min()), float(inside.max())
    if low < high:
        image[valid] = np.clip((inside - low) / (high - low), 0, 1) * 255
    return image, (low, high)
