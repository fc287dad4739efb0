"""Compares colors with the true ones: CIEDE2000, structural similarity, signal-to-noise ratio of chrominance."""

import math

import numpy as np

from ..errors import ScanError
from ..messages import Message
from ..srgb import linear_to_srgb8, srgb8_to_linear
from .colorspaces import LUMA, chrominance, merge

# A color difference holds some thirty float64 values per pixel.
_CHUNK_PIXELS = 1 << 17
# Side of the window of the structural similarity: what scikit-image takes by default.
_WINDOW = 7


def evaluate(rgb: np.ndarray, truth: np.ndarray, valid: np.ndarray) -> dict:
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
        ``pixels``, how many were compared; ``structural_similarity`` of the luminance (Y of YCbCr; Wang et al. 2004,
        1 where nothing differs), the mean over all windows of 7 x 7 pixels that are compared as a whole, None if there
        is none; and three times the same three figures: under ``as_is`` as the colors come; under ``after_gain`` when
        they are made lighter or darker as by one exposure, so that the mean of the linear light is the true one
        (``gain`` is the factor); under ``color_alone`` with the true luminance put in, which leaves hue and
        saturation. ``ciede2000_mean`` and ``ciede2000_p95`` are mean and 95th percentile of the color difference (1 is
        about what an eye can tell); ``chrominance_psnr_db`` is the peak signal-to-noise ratio of Cb and Cr together
        (peak 255; infinite where nothing differs).

    Raises
    ------
    ScanError
        If shapes or types disagree, or no pixel is to be compared.

    Examples
    --------
    >>> import numpy as np
    >>> from reflcolor_addon import evaluate
    >>> truth = np.full((8, 8, 3), (200, 80, 40), np.uint8)
    >>> figures = evaluate(truth // 2, truth, np.ones((8, 8), bool))
    >>> figures["pixels"], figures["as_is"]["ciede2000_mean"] > figures["after_gain"]["ciede2000_mean"]
    (64, True)
    """
    _check(rgb, truth, valid)
    seen, true = rgb[valid], truth[valid]
    exposed, gain = _exposed_like(seen, true)
    return {
        "pixels": int(np.count_nonzero(valid)),
        "structural_similarity": _structural_similarity(rgb, truth, valid),
        "as_is": _figures(seen, true),
        "after_gain": _figures(exposed, true) | {"gain": gain},
        "color_alone": _figures(with_luminance_of(seen[None], true[None])[0], true),
    }


def error_map(rgb: np.ndarray, truth: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Return the (H, W) float32 CIEDE2000 of the colors as they come at every pixel; NaN where not valid.

    Parameters and errors are those of `evaluate`.

    Examples
    --------
    >>> import numpy as np
    >>> from reflcolor_addon import error_map
    >>> image = np.zeros((2, 2, 3), np.uint8)
    >>> error_map(image, image, np.array([[True, True], [True, False]])).tolist()
    [[0.0, 0.0], [0.0, nan]]
    """
    _check(rgb, truth, valid)
    errors = np.full(valid.shape, np.nan, np.float32)
    errors[valid] = _color_difference(rgb[valid], truth[valid])
    return errors


def with_luminance_of(rgb, truth):
    """Return (H, W, 3) uint8: the chrominance of one image with the luminance (Y of YCbCr) of another."""
    return merge(truth @ LUMA, chrominance(rgb, "ycbcr"), "ycbcr")


def _check(rgb, truth, valid):
    kind = np.asarray(valid).dtype
    if kind.kind != "b":
        raise ScanError("valid: expected booleans, found {kind}; write valid > 0", kind=str(kind))
    expected = (*np.shape(valid), 3)
    for name, image in ((Message("colors"), rgb), (Message("true colors"), truth)):
        if np.shape(image) != expected:
            raise ScanError(
                "{image}: expected an image of shape {shape}, found {found}",
                image=name,
                shape=expected,
                found=np.shape(image),
            )
        if (found := np.asarray(image).dtype) != np.uint8:
            raise ScanError("{image}: expected uint8, found {found}", image=name, found=str(found))
    if not np.any(valid):
        raise ScanError("no pixel has both a return and a true color, so there is nothing to compare")


def _exposed_like(rgb, truth):
    """(N, 3) uint8 with the mean linear light of the truth, and the factor that it takes."""
    parts = [slice(start, start + _CHUNK_PIXELS) for start in range(0, len(rgb), _CHUNK_PIXELS)]
    light, wanted = (sum(float(srgb8_to_linear(image[part]).sum()) for part in parts) for image in (rgb, truth))
    gain = wanted / light if light > 0 else 1.0
    exposed = np.empty_like(rgb)
    for part in parts:
        exposed[part] = linear_to_srgb8(gain * srgb8_to_linear(rgb[part]))
    return exposed, gain


def _structural_similarity(rgb, truth, valid):
    """Mean over whole windows, None without any. What is not compared is filled, and no window of it counts."""
    import cv2
    from skimage.metrics import structural_similarity

    height, width = valid.shape
    if min(height, width) < _WINDOW:
        return None
    window = np.ones((_WINDOW, _WINDOW), np.uint8)
    whole = cv2.erode(valid.astype(np.uint8), window, borderType=cv2.BORDER_CONSTANT, borderValue=0) > 0
    total, margin, rows = 0.0, _WINDOW // 2, max(1, _CHUNK_PIXELS // width)
    for top in range(0, height, rows):
        # Strips that overlap, so that every window of the rows that count is whole.
        low, high = max(0, top - margin), min(height, top + rows + margin)
        low, high = max(0, min(low, high - _WINDOW)), max(high, low + _WINDOW)
        images = [np.where(valid[low:high], image[low:high] @ LUMA, 0).astype(np.float32) for image in (rgb, truth)]
        _, similarity = structural_similarity(*images, win_size=_WINDOW, data_range=255, full=True)
        strip = slice(top, min(top + rows, height))
        inside = similarity[strip.start - low : strip.stop - low]
        total += float(inside[whole[strip]].sum(dtype=np.float64))
    count = np.count_nonzero(whole)
    return total / count if count else None


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
