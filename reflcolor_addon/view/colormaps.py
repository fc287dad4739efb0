"""Colors that stand for values: a gradient for a quantity, a palette for what is only told apart."""

import numpy as np

from ..scan.normalization import PERCENTILES

GRADIENTS = ("viridis", "turbo", "inferno")
UNKNOWN = (96, 96, 96)
"""sRGB of what has no value, or belongs to no region."""
# Hues a golden section apart: however many regions there are, neighbors in the list never look alike.
_GOLDEN = (np.sqrt(5) - 1) / 2
_FIRST_HUE = 0.58
# Saturation and brightness of one region after the other.
_TONES = np.array([(0.60, 0.95), (0.85, 0.75), (0.40, 1.00), (0.70, 0.55)])


def gradient(name):
    """Return the (256, 3) uint8 sRGB of a gradient, from its low to its high end.

    Parameters
    ----------
    name : {"viridis", "turbo", "inferno"}
    """
    import cv2

    steps = np.arange(256, dtype=np.uint8)[:, None]
    return cv2.applyColorMap(steps, getattr(cv2, f"COLORMAP_{name.upper()}"))[:, 0, ::-1].copy()


def painted(values, name, limits):
    """Return the (N, 3) uint8 sRGB that stand for values.

    Parameters
    ----------
    values : (N,) float
        NaN: not known.
    name : str
        A gradient.
    limits : (low, high) of float
        The values at its ends; what lies beyond them gets the color of the end.
    """
    values, (low, high) = np.asarray(values, np.float64), limits
    known = np.isfinite(values)
    share = np.clip((values[known] - low) / (high - low), 0, 1) if high > low else np.zeros(int(known.sum()))
    colors = np.empty((values.size, 3), np.uint8)
    colors[:] = UNKNOWN
    colors[known] = gradient(name)[np.rint(share * 255).astype(np.uint8)]
    return colors


def limits_of(values):
    """Return the robust (low, high) of values, as for the images of a scan; (0, 1) where none is known."""
    known = np.asarray(values, np.float64)
    known = known[np.isfinite(known)]
    if known.size == 0:
        return 0.0, 1.0
    low, high = (float(limit) for limit in np.percentile(known, PERCENTILES))
    return (low, high) if low < high else (float(known.min()), float(known.max()))


def region_colors(indices):
    """Return the (N, 3) uint8 sRGB of regions: the same number has always the same color, whatever the seeds' own.

    Parameters
    ----------
    indices : (N,) int
        Number of the region; negative: none.
    """
    indices = np.asarray(indices, np.int64)
    colors = np.empty((indices.size, 3), np.uint8)
    colors[:] = UNKNOWN
    inside = indices >= 0
    if inside.any():
        colors[inside] = _palette(int(indices.max()) + 1)[indices[inside]]
    return colors


def _palette(count):
    """(count, 3) uint8 from hue, saturation and value."""
    numbers = np.arange(count)
    hue = (_FIRST_HUE + numbers * _GOLDEN) % 1
    saturation, value = _TONES[numbers % len(_TONES)].T
    ramp = np.abs((hue[:, None] + np.array([0, 2 / 3, 1 / 3])) % 1 * 6 - 3) - 1
    rgb = value[:, None] * (1 + saturation[:, None] * (np.clip(ramp, 0, 1) - 1))
    return np.rint(rgb * 255).astype(np.uint8)
