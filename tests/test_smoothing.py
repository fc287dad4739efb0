"""Smoothing of images with holes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from reflcolor_addon.geodesic.smoothing import smooth

images = hnp.arrays(
    np.float32, hnp.array_shapes(min_dims=2, max_dims=2, max_side=12), elements=st.floats(0, 255, width=32)
)


def gaussian_mean(image, valid, sigma, row, col, wrap):
    """The weighted mean at one pixel, by definition; the Gaussian ends after four standard deviations."""
    rows, cols = np.indices(image.shape)
    reach, total, weights = int(np.ceil(4 * sigma)), 0.0, 0.0
    for turn in range(-reach - 1, reach + 2) if wrap else (0,):
        down, right = rows - row, cols + turn * image.shape[1] - col
        weight = np.exp(-(down**2 + right**2) / (2 * sigma**2)) * valid
        weight = weight * (np.abs(down) <= reach) * (np.abs(right) <= reach)
        total, weights = total + (weight * image).sum(), weights + weight.sum()
    return total / weights


@given(image=images, data=st.data(), sigma=st.floats(0.3, 3), wrap=st.booleans())
def test_it_is_the_gaussian_mean_of_the_valid_pixels(image, data, sigma, wrap):
    valid = data.draw(hnp.arrays(bool, image.shape))
    smoothed = smooth(image, valid, sigma, wrap=wrap)
    assert smoothed.dtype == np.float32
    for row, col in np.argwhere(valid)[:5]:
        assert smoothed[row, col] == pytest.approx(gaussian_mean(image, valid, sigma, row, col, wrap), abs=0.02)
    assert (smoothed[~valid] == 0).all()


@given(image=images)
def test_sigma_0_leaves_the_image_as_it_is(image):
    assert (smooth(image, np.ones(image.shape, bool), 0.0) == image).all()


def test_what_is_not_valid_has_no_influence():
    valid = np.ones((5, 6), bool)
    valid[2, 3] = False
    image = np.full((5, 6), 7.0, np.float32)
    image[2, 3] = np.nan
    assert smooth(image, valid, 1.5)[valid] == pytest.approx(7.0)
