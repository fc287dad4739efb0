"""The tone of a result: a gamma on its luminance, and the gamma that a dark scan needs."""

import math

from ..settings import SETTINGS

# Medians of 0..255: below the first a picture counts as dark; the suggested tone raises it to the second. Among the
# scans with truth, the infrared camera's has 6, the others 110 to 144 (docs/quality.md).
DARK_MEDIAN, LIGHT_MEDIAN = 50.0, 100.0


def toned(luminance, tone):
    """Lighten (tone above 1) or darken (below 1) a luminance; black and white stay.

    Parameters
    ----------
    luminance : (H, W) float32, 0..255
    tone : float
        See ``Settings``.

    Returns
    -------
    (H, W) float32, 0..255
        ``255 (luminance / 255)^(1 / tone)``; what was given where the tone is 1.
    """
    if tone == 1:
        return luminance
    return 255 * (luminance / 255) ** float(1 / tone)


def tone_to_try(median, tone):
    """Return the tone that would make a dark picture light enough; None where it is not dark, or no tone helps.

    Parameters
    ----------
    median : float, 0..255
        Of the luminance of all valid pixels, before any tone.
    tone : float
        The present one.
    """
    if median <= 0 or toned(median, tone) >= DARK_MEDIAN:
        return None
    wanted = math.log(median / 255) / math.log(LIGHT_MEDIAN / 255)
    found = min(round(wanted, 1), SETTINGS["tone"].high)
    return found if found > tone else None
