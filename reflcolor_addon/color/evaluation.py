"""How far colors are from the true ones: CIEDE2000, and the signal-to-noise ratio of the chrominance."""

import math

import numpy as np

from ..errors import ScanError
from .colorspaces import LUMA, chrominance, merge

# A color difference holds some thirty float64 values per pixel.
_CHUNK_PIXELS = 1 << 17


def evaluate(rgb, truth, valid):
    """Compare colors with the true ones.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        sRGB.
    truth : (H, W, 3) uint8
        The true sRGB.
    valid : (H, W) bool
        Pixels to compare.

    Returns
    -------
    dict
        ``pixels``, how many were compared, and twice the same three figures: under ``color_alone`` with the true
        luminance put into ``rgb``, because a method that spreads chrominance is not to blame for the reflectance; under
        ``as_is`` as the colors come. ``ciede2000_mean`` and ``ciede2000_p95`` are mean and 95th percentile of the color
        difference (1 is about what an eye can tell); ``chrominance_psnr_db`` is the peak signal-to-noise ratio of Cb
        and Cr together (peak 255; infinite where nothing differs).

    Raises
    ------
    ScanError
        If the shapes disagree, or no pixel is to be compared.
    """
    _check(rgb, truth, valid)
    alone = with_luminance_of(rgb, truth)
    figures = {name: _figures(colors[valid], truth[valid]) for name, colors in (("color_alone", alone), ("as_is", rgb))}
    return {"pixels": int(np.count_nonzero(valid)), **figures}


def error_map(rgb, truth, valid):
    """Return the (H, W) float32 CIEDE2000 of color alone at every pixel; NaN where not valid. As in `evaluate`."""
    _check(rgb, truth, valid)
    errors = np.full(valid.shape, np.nan, np.float32)
    errors[valid] = _color_difference(with_luminance_of(rgb, truth)[valid], truth[valid])
    return errors


def with_luminance_of(rgb, truth):
    """Return (H, W, 3) uint8: the chrominance of one image with the luminance (Y of YCbCr) of another."""
    return merge(truth @ LUMA, chrominance(rgb, "ycbcr"), "ycbcr")


def _check(rgb, truth, valid):
    expected = (*np.shape(valid), 3)
    for name, image in (("colors", rgb), ("true colors", truth)):
        if np.shape(image) != expected:
            raise ScanError(f"{name}: expected an image of shape {expected}, found {np.shape(image)}")
    if not np.any(valid):
        raise ScanError("no pixel has both a return and a true color, so there is nothing to compare")


def _figures(rgb, truth):
    """Of (N, 3) uint8 each."""
    difference = _color_difference(rgb, truth)
    squared = np.mean((chrominance(rgb, "ycbcr") - chrominance(truth, "ycbcr")) ** 2)
    return {
        "ciede2000_mean": float(difference.mean()),
        "ciede2000_p95": float(np.percentile(difference, 95)),
        "chrominance_psnr_db": float(10 * np.log10(255**2 / squared)) if squared > 0 else math.inf,
    }


def _color_difference(rgb, truth):
    """(N,) float64 CIEDE2000 of (N, 3) uint8."""
    from skimage.color import deltaE_ciede2000, rgb2lab

    difference = np.empty(len(rgb))
    for start in range(0, len(rgb), _CHUNK_PIXELS):
        part = slice(start, start + _CHUNK_PIXELS)
        difference[part] = deltaE_ciede2000(rgb2lab(truth[part]), rgb2lab(rgb[part]))
    return difference
