"""The luminance of the colors: the reflectance's, the seeds', or a mixture of both.

A seed has a whole color, so its luminance can be spread over the scan as its chrominance is: along paths (eq. 1) and
by kriging. What is blended is its square root, because the same step is seen more in the dark. The paper takes the
luminance from the reflectance instead; that is infrared, in which leaves are white and dark cloth is bright, and it
has no shadows.
"""

import numpy as np

from . import colorspaces
from .tone import toned

CHROMINANCE = slice(0, 2)
"""Slices of the channels that are spread."""
LUMINANCE = slice(2, 3)


def channels_of(settings):
    """Return the slices of the channels that settings ask to be spread, each to be estimated by itself."""
    return (CHROMINANCE, LUMINANCE) if settings.light > 0 else (CHROMINANCE,)


def seed_values(rgb, settings):
    """Return what is spread from seeds of these colors.

    Parameters
    ----------
    rgb : (S, 3) uint8
        sRGB.
    settings : Settings

    Returns
    -------
    (S, C) float32
        Two channels of chrominance and, if ``settings.light`` asks for it, the root sqrt(255 Y) of the luminance, in
        the same units: one unit is as many levels of 8 bits in each.
    """
    values = [colorspaces.chrominance(rgb, settings.color_space)]
    if settings.light > 0:
        root = np.sqrt(255 * colorspaces.luminance(rgb, settings.color_space))
        values.append(root[:, None] / colorspaces.levels_per_unit(settings.color_space))
    return np.concatenate(values, axis=1).astype(np.float32)


def from_one_seed(root, reflectance, own, settings):
    """Return a spread luminance that is the same everywhere, with detail: half of it is the reflectance's.

    One seed does not determine which surfaces are light and which dark, and a picture of one luminance shows nothing.

    Parameters
    ----------
    root : (H, W) float32
        The channel of the luminance, as `seed_values` has it.
    reflectance : (H, W) float32, 0..255
        Normalized; it is exposed so that the seed's own pixel is as light as the seed.
    own : float
        The reflectance at the seed.
    settings : Settings
    """
    unit = colorspaces.levels_per_unit(settings.color_space)
    exposure = (root * unit) ** 2 / 255 / own if own > 0 else 1
    return (root + np.sqrt(255 * np.clip(reflectance * exposure, 0, 255)) / unit) / 2


def lightness(reflectance, values, reached, settings):
    """Return how light a result is.

    Parameters
    ----------
    reflectance : (H, W) float32, 0..255
        Normalized.
    values : (H, W, C) float32
        What was spread; see `seed_values`.
    reached : (H, W) bool
        Where it was; elsewhere a result is as light as the reflectance.
    settings : Settings

    Returns
    -------
    (H, W) float32, 0..255
        With ``light`` 0 the reflectance, with 1 the luminance of the seeds; then the tone.
    """
    mixed = reflectance
    if settings.light > 0:
        root = np.clip(values[..., 2] * colorspaces.levels_per_unit(settings.color_space), 0, 255)
        seen = root * root / 255
        mixed = np.where(reached, (1 - settings.light) * reflectance + settings.light * seen, reflectance)
    return toned(mixed, settings.tone)
