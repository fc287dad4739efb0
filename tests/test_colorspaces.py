"""The four color spaces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from reflcolor_addon.color import colorspaces
from reflcolor_addon.settings import SETTINGS

GRAYS = np.arange(256)
CUBE = np.stack(np.meshgrid(*[np.linspace(0, 255, 18).round()] * 3), axis=-1).reshape(1, -1, 3)
every_space = pytest.mark.parametrize("space", [choice.value for choice in SETTINGS["color_space"].choices])


def luminance_as_gray(rgb, space):
    """The gray value that has the same luminance channel as the color, from each space's definition."""
    if space in ("ycbcr", "yuv"):
        return rgb @ [0.299, 0.587, 0.114]
    if space == "cielab":
        from skimage.color import rgb2xyz

        luminance = rgb2xyz(rgb / 255)[..., 1]  # L* depends on Y alone
        return 255 * np.where(luminance <= 0.0031308, 12.92 * luminance, 1.055 * luminance ** (1 / 2.4) - 0.055)
    # l is the mean of three logarithms, and gray has three equal cone responses.
    return (np.exp(np.log(cone_responses(rgb)).mean(axis=-1)) - 1 / 256) / (1 - 1 / 256) * 255


def cone_responses(rgb):
    """Reinhard et al. 2001, each row scaled so that gray stays gray, 0..255 taken to 1/256..1."""
    matrix = np.array([[0.3811, 0.5783, 0.0402], [0.1967, 0.7244, 0.0782], [0.0241, 0.1288, 0.8444]])
    return (rgb / 255 * (255 / 256) + 1 / 256) @ (matrix / matrix.sum(axis=1, keepdims=True)).T


@every_space
def test_gray_has_no_chrominance(space):
    chrominance = colorspaces.chrominance(np.repeat(GRAYS[:, None], 3, axis=1), space)
    # The white point and matrix of CIELAB are rounded to a few digits.
    assert np.abs(chrominance).max() < 0.02


@every_space
def test_no_chrominance_gives_gray(space):
    merged = colorspaces.merge(GRAYS[None], np.zeros((1, 256, 2)), space)
    assert (merged == GRAYS[None, :, None]).all()


@every_space
def test_a_color_parted_and_joined_is_the_same_color(space):
    merged = colorspaces.merge(luminance_as_gray(CUBE, space), colorspaces.chrominance(CUBE, space), space)
    assert np.abs(merged.astype(int) - CUBE).max() == 0


@every_space
def test_the_luminance_of_a_color_is_the_gray_that_has_the_same(space):
    np.testing.assert_allclose(colorspaces.luminance(CUBE, space), luminance_as_gray(CUBE, space), atol=0.02)


@every_space
@given(colors=arrays(np.uint8, (1, 5, 3)))
def test_any_color_parted_and_joined_is_the_same_color(space, colors):
    gray, chrominance = luminance_as_gray(colors.astype(float), space), colorspaces.chrominance(colors, space)
    merged = colorspaces.merge(gray, chrominance, space)
    assert np.abs(merged.astype(int) - colors).max() == 0


@pytest.mark.parametrize(
    ("space", "rgb", "expected", "tolerance"),
    [
        # BT.601, full range: half of 255 at the primary, the rest by the luma coefficients over 2 (1 - coefficient).
        ("ycbcr", (255, 0, 0), (-0.299 / 1.772 * 255, 127.5), 1e-9),
        ("ycbcr", (0, 0, 255), (127.5, -0.114 / 1.402 * 255), 1e-9),
        ("yuv", (0, 0, 255), (0.436 * 255, -0.615 * 0.114 / 0.701 * 255), 1e-9),
        ("yuv", (255, 0, 0), (-0.436 * 0.299 / 0.886 * 255, 0.615 * 255), 1e-9),
        # Published coordinates of the sRGB primaries under D65.
        ("cielab", (255, 0, 0), (80.09, 67.20), 0.02),
        ("cielab", (0, 255, 0), (-86.18, 83.18), 0.02),
        ("cielab", (0, 0, 255), (79.19, -107.86), 0.02),
    ],
)
def test_the_primaries_have_their_known_chrominance(space, rgb, expected, tolerance):
    assert colorspaces.chrominance(np.array(rgb), space) == pytest.approx(np.array(expected), abs=tolerance)


@given(rgb=arrays(np.uint8, 3))
def test_yuv_agrees_with_another_implementation(rgb):
    from skimage.color import rgb2yuv

    # Its matrix is rounded to eight digits, and so not quite BT.601's.
    assert colorspaces.chrominance(rgb, "yuv") == pytest.approx(rgb2yuv(rgb / 255)[1:] * 255, abs=0.02)


@given(rgb=arrays(np.uint8, 3))
def test_l_alpha_beta_follows_its_definition(rgb):
    long, medium, short = np.log10(cone_responses(rgb.astype(float)))
    expected = [(long + medium - 2 * short) / np.sqrt(6), (long - medium) / np.sqrt(2)]
    assert colorspaces.chrominance(rgb, "lalphabeta") == pytest.approx(expected, abs=1e-12)


@every_space
@given(gray=st.floats(0, 255), channels=st.tuples(*[st.floats(-300, 300)] * 2))
def test_what_lies_outside_the_gamut_is_clipped(space, gray, channels):
    # The logarithmic channels of l-alpha-beta stay within a few units.
    scale = 0.01 if space == "lalphabeta" else 1.0
    merged = colorspaces.merge(np.array([[gray]]), np.array([[channels]]) * scale, space)
    assert merged.shape == (1, 1, 3)
    assert merged.dtype == np.uint8


@every_space
def test_an_image_of_many_strips_is_joined_like_its_pixels(space, monkeypatch):
    rng = np.random.default_rng(1)
    rgb = rng.integers(0, 256, (7, 5, 3))
    gray, chrominance = rgb.mean(axis=-1), colorspaces.chrominance(rgb, space)
    whole = colorspaces.merge(gray, chrominance, space)
    monkeypatch.setattr(colorspaces, "_CHUNK_PIXELS", 10)
    assert (colorspaces.merge(gray, chrominance, space) == whole).all()
