"""Color spaces that part a color into luminance and two chrominance channels.

Each works on sRGB of 0..255 as stored in 8-bit images. Blending happens on the two chrominance channels (eq. 1);
the luminance of a result is that of the gray value of the reflectance.
"""

import warnings

import numpy as np

# ITU-R BT.601, full range.
LUMA = np.array([0.299, 0.587, 0.114])
# Blue difference and red difference, as multiples of (B - Y) and (R - Y).
_YCBCR_GAINS = np.array([1 / (2 * (1 - 0.114)), 1 / (2 * (1 - 0.299))])
_YUV_GAINS = np.array([0.436 / (1 - 0.114), 0.615 / (1 - 0.299)])

# Ruderman, Cronin and Chiao 1998, with the matrix of Reinhard et al. 2001; every row is scaled to a sum of one, so that
# gray has no chrominance.
_RGB_TO_LMS = np.array([[0.3811, 0.5783, 0.0402], [0.1967, 0.7244, 0.0782], [0.0241, 0.1288, 0.8444]])
_RGB_TO_LMS /= _RGB_TO_LMS.sum(axis=1, keepdims=True)
_LMS_TO_LAB = np.diag(1 / np.sqrt([3.0, 6.0, 2.0])) @ np.array([[1.0, 1, 1], [1, 1, -2], [1, -1, 0]])
# The logarithm needs a floor: 0..255 is taken to _FLOOR..1.
_FLOOR = 1 / 256


class _DifferenceSpace:
    """Y and two color differences: YCbCr and YUV."""

    def __init__(self, gains):
        self._gains = gains

    def chrominance(self, rgb):
        rgb = np.asarray(rgb, np.float64)
        luma = rgb @ LUMA
        return np.stack([rgb[..., 2] - luma, rgb[..., 0] - luma], axis=-1) * self._gains

    def gray(self, rgb):
        return np.asarray(rgb, np.float64) @ LUMA

    def merge(self, gray, chrominance):
        blue_minus_luma, red_minus_luma = np.moveaxis(np.asarray(chrominance, np.float64) / self._gains, -1, 0)
        gray = np.asarray(gray, np.float64)
        red, blue = gray + red_minus_luma, gray + blue_minus_luma
        green = (gray - LUMA[0] * red - LUMA[2] * blue) / LUMA[1]
        return np.stack([red, green, blue], axis=-1)


class _LAlphaBeta:
    """The l-alpha-beta space of natural images: decorrelated logarithms of cone responses."""

    def _split(self, rgb):
        lms = (np.asarray(rgb, np.float64) / 255 * (1 - _FLOOR) + _FLOOR) @ _RGB_TO_LMS.T
        return np.log10(lms) @ _LMS_TO_LAB.T

    def chrominance(self, rgb):
        return self._split(rgb)[..., 1:]

    def gray(self, rgb):
        # A gray has equal cone responses g, and their combination is log10(g) times the first row's sum.
        lightness = self._split(rgb)[..., 0] / _LMS_TO_LAB[0].sum()
        return (10**lightness - _FLOOR) / (1 - _FLOOR) * 255

    def merge(self, gray, chrominance):
        lightness = self._split(np.repeat(np.asarray(gray, np.float64)[..., None], 3, axis=-1))[..., :1]
        lms = 10 ** (np.concatenate([lightness, chrominance], axis=-1) @ np.linalg.inv(_LMS_TO_LAB).T)
        rgb = lms @ np.linalg.inv(_RGB_TO_LMS).T
        return (rgb - _FLOOR) / (1 - _FLOOR) * 255


class _CieLab:
    """CIE 1976 L*a*b*, D65."""

    def chrominance(self, rgb):
        from skimage.color import rgb2lab

        return rgb2lab(np.asarray(rgb, np.float64) / 255)[..., 1:]

    def gray(self, rgb):
        from skimage.color import lab2rgb, rgb2lab

        lab = rgb2lab(np.asarray(rgb, np.float64) / 255)
        lab[..., 1:] = 0
        return lab2rgb(lab)[..., 1] * 255

    def merge(self, gray, chrominance):
        from skimage.color import lab2rgb, rgb2lab

        gray = np.asarray(gray, np.float64)[..., None] / 255
        lightness = rgb2lab(np.repeat(gray, 3, axis=-1))[..., :1]
        with warnings.catch_warnings():
            # A dark pixel with a strong chrominance lies outside the gamut; it is clipped, which is what we want.
            warnings.filterwarnings("ignore", message=".*negative Z values.*")
            return lab2rgb(np.concatenate([lightness, chrominance], axis=-1)) * 255


_SPACES = {
    "ycbcr": _DifferenceSpace(_YCBCR_GAINS),
    "yuv": _DifferenceSpace(_YUV_GAINS),
    "lalphabeta": _LAlphaBeta(),
    "cielab": _CieLab(),
}
# Few enough pixels that the arrays in use stay in the cache.
_CHUNK_PIXELS = 1 << 15


def chrominance(rgb, color_space):
    """Return the two chrominance channels of colors.

    Parameters
    ----------
    rgb : (..., 3) array of numbers 0..255
        sRGB.
    color_space : str
        A choice of the setting ``color_space``.

    Returns
    -------
    (..., 2) float64
        (0, 0) is neutral gray in every space.
    """
    return _SPACES[color_space].chrominance(rgb)


def luminance(rgb, color_space):
    """Return the luminance of colors, as the gray value that has the same.

    Parameters
    ----------
    rgb : (..., 3) array of numbers 0..255
        sRGB.
    color_space : str
        One of ``settings.COLOR_SPACES``.

    Returns
    -------
    (...,) float64, 0..255
        With the chrominance, ``merge`` makes the same color of it.
    """
    return _SPACES[color_space].gray(rgb)


def merge(gray, chrominance_image, color_space):
    """Join the luminance of gray values with chrominance channels to sRGB, clipped to 0..255 and rounded.

    Parameters
    ----------
    gray : (H, W) float, 0..255
    chrominance_image : (H, W, 2) float
    color_space : str
        A choice of the setting ``color_space``.

    Returns
    -------
    (H, W, 3) uint8
    """
    space = _SPACES[color_space]
    rgb = np.empty((*np.shape(gray), 3), np.uint8)
    # In strips, because the conversions hold several float64 copies of their input.
    rows = max(1, _CHUNK_PIXELS // max(1, rgb.shape[1]))
    for top in range(0, rgb.shape[0], rows):
        strip = slice(top, top + rows)
        joined = space.merge(gray[strip], np.asarray(chrominance_image[strip], np.float64))
        rgb[strip] = np.rint(np.clip(joined, 0, 255))
    return rgb


def lost_levels(rgb, chrominance_image, color_space):
    """Return how much of the chrominance was clipped away, because no sRGB color of that luminance has it.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        What ``merge`` made.
    chrominance_image : (H, W, 2) float
        What it was given.
    color_space : str
        A choice of the setting ``color_space``.

    Returns
    -------
    (H, W) float32
        8-bit levels, as ``levels_per_unit`` has them; what rounding alone can do counts as none.
    """
    levels = np.empty(rgb.shape[:2], np.float32)
    scale = levels_per_unit(color_space)
    rows = max(1, _CHUNK_PIXELS // max(1, rgb.shape[1]))
    for top in range(0, rgb.shape[0], rows):
        strip = slice(top, top + rows)
        difference = chrominance(rgb[strip], color_space) - chrominance_image[strip]
        levels[strip] = np.hypot(difference[..., 0], difference[..., 1]) * scale
    return np.maximum(levels - 1, 0)


def levels_per_unit(color_space):
    """Return how many 8-bit levels of red, green or blue one unit of chrominance is worth, at most, at middle gray."""
    space, gray, step = _SPACES[color_space], np.full(2, 127.5), 1e-3
    return max(
        float(np.abs(np.diff(space.merge(gray, np.array([[0.0, 0.0], change])), axis=0)).max()) / step
        for change in ([step, 0.0], [0.0, step])
    )
