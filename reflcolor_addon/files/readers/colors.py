"""Colors brought to 8 bits by what their values are, for files whose headers say otherwise, or nothing."""

import numpy as np

_DARKEST = 16.0
"""Levels of 255 that the brightest color must reach on a stated scale for that scale to be believed."""


def stacked(channels):
    """Return the (N, 3) of three (N,) columns, in 8 bits where they hold nothing else: an eighth of the memory."""
    levels = [_levels(channel) for channel in channels]
    return np.stack(channels if any(level is None for level in levels) else levels, axis=-1)


def scaled_colors(values, limits, warn):
    """Return colors in 8 bits.

    Parameters
    ----------
    values : (N, 3) float
        As stored; what is not finite is black.
    limits : (low, high) of float, or None
        The scale that the file states; None where it states none.
    warn : callable
        Takes what `Message` takes; told where scale and values disagree.

    Returns
    -------
    (N, 3) uint8 or None
        None where the values are no colors.
    """
    levels = _levels(values)
    if levels is not None and _in_8_bits(levels, limits):
        return levels
    values = np.nan_to_num(np.asarray(values, np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    least, most = (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)
    low, high = limits or (None, None)
    if low is None or high is None or not 0 < high - low <= 2**32:
        low, high = _scale_of(least, most)
        if high is None:
            warn(
                "its colors hold values from {least:g} to {most:g}; taken as a scan without color",
                least=least,
                most=most,
            )
            return None
    elif _counts_in_8_bits(low, high):
        low, high = 0.0, 255.0
    fits = low <= least and most <= high
    # A picture may be dark, in whole steps of 8 bits; darker than that it is on another scale.
    if not (high == 255.0 and (values == np.round(values)).all()):
        fits = fits and (most - low) * 255 / (high - low) >= _DARKEST
    if not fits:
        found = _scale_of(least, most)
        if found[1] is not None and found != (low, high):
            warn(
                "its colors hold values from {least:g} to {most:g}, which does not fit the scale from {low:g} to "
                "{high:g} in its header; they are taken as {scale}",
                least=least,
                most=most,
                low=low,
                high=high,
                scale=f"0 to {found[1]:g}",
            )
            low, high = found
    return np.round(np.clip((values - low) * (255 / (high - low)), 0, 255)).astype(np.uint8)


def _levels(values):
    """The same numbers as uint8, None where that cannot hold them."""
    with np.errstate(invalid="ignore"):
        levels = values.astype(np.uint8)
    return levels if np.array_equal(levels, values) else None


def _in_8_bits(levels, limits):
    """Whether whole numbers from 0 to 255 are the levels of an image of 8 bits as they are."""
    low, high = limits or (None, None)
    if low is None or high is None or not 0 < high - low <= 2**32:
        return levels.max(initial=0) > 1
    return _counts_in_8_bits(low, high)


def _counts_in_8_bits(low, high):
    """Whether limits are the least and greatest level that occur in an image of 8 bits, or the ends of its scale."""
    return low >= 0 and 128 <= high <= 255


def _scale_of(least, most):
    """(low, high) of the scale that values are most likely on: of 8, 10, 12 or 16 bits, or 0 to 1; (0, None) for none.

    In 16 bits, what fits into 12 would be a picture that is black nearly everywhere.
    """
    if least < 0 or most > 65535:
        return 0.0, None
    return 0.0, next(high for high in (1.0, 255.0, 1023.0, 4095.0, 65535.0) if most <= high)
