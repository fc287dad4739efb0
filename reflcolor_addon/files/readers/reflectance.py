"""Chooses a file's reflectance: the intensity, a gray color image in its place, or the luminance of its colors."""

import numpy as np

_GRAY_SHARE = 0.999
"""Share of equal channels that makes a color image a gray one; a stray pixel is no color."""

_LOOKED_AT = 64
"""Rows and columns that are looked at first."""

_LUMA = np.array([0.299, 0.587, 0.114], np.float32)


def told_apart(reflectance, color, valid, warn):
    """Return the reflectance and the colors of a scan.

    Some files store the intensity as three equal colors: it is no color, and may be the only intensity there is. Some
    store one and the same intensity everywhere, because their writer knew none; then the luminance of the colors
    stands in for it.

    Parameters
    ----------
    reflectance : (H, W) float32 or None
    color : (H, W, 3) uint8 or None
    valid : (H, W) bool
    warn : callable
        Takes what `Message` takes.

    Returns
    -------
    reflectance : (H, W) float32
        The same everywhere where the file has none at all.
    color : (H, W, 3) uint8 or None
    """
    constant = reflectance is None or is_constant(reflectance, valid)
    if color is not None and gray_is_no_color(color, valid):
        gray, color = color[..., 0], None
        if gray[valid].any():
            if constant and not is_constant(gray, valid):
                warn("no intensity but gray colors; they are taken as the intensity")
                return gray.astype(np.float32), None
            warn("its colors are gray (red = green = blue); taken as a scan without color")
    if not constant:
        return reflectance, color
    if color is not None:
        luminance = color @ _LUMA
        if not is_constant(luminance, valid):
            if reflectance is None:
                warn("has no intensity; the luminance of its colors stands in for the reflectance")
            else:
                warn(
                    "its intensity is {value:g} everywhere, as where a program knew none; the luminance of its colors "
                    "stands in for the reflectance",
                    value=_value(reflectance, valid),
                )
            return luminance.astype(np.float32), color
    if reflectance is None:
        warn("has no intensity, and nothing that could stand in for it: it can be viewed, but not colorized")
        return np.zeros(valid.shape, np.float32), color
    warn(
        "its intensity is {value:g} everywhere, as where a program knew none: it can be viewed, but not colorized",
        value=_value(reflectance, valid),
    )
    return reflectance, color


def is_constant(values, valid):
    """Return whether an (H, W) array is the same at all valid pixels; what is not finite does not count."""
    # A few of them usually suffice.
    some = tuple(slice(None, None, max(1, size // _LOOKED_AT)) for size in valid.shape)
    for part in (some, ...):
        seen = values[part][valid[part]]
        seen = seen[np.isfinite(seen)] if seen.dtype.kind == "f" else seen
        if seen.size and seen.min() != seen.max():
            return False
    return True


def gray_is_no_color(color, valid):
    """True where red, green and blue are the same: an intensity stored as a color, or nothing stored at all."""
    equal = valid & (color[..., 0] == color[..., 1]) & (color[..., 0] == color[..., 2])
    return np.count_nonzero(equal) >= _GRAY_SHARE * np.count_nonzero(valid)


def _value(values, valid):
    seen = values[valid]
    seen = seen[np.isfinite(seen)]
    return float(seen[0]) if seen.size else float("nan")
