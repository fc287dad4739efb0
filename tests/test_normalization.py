"""Bringing raw values to 0..255."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from reflcolor_addon.scan.normalization import PERCENTILES, normalize

EVERYWHERE = np.ones((10, 101), bool)


def test_the_percentiles_of_the_valid_pixels_become_0_and_255():
    values = np.linspace(3.0, 7.0, EVERYWHERE.size).reshape(EVERYWHERE.shape)
    image, (low, high) = normalize(values, EVERYWHERE)
    assert PERCENTILES == (1.0, 99.0)
    assert (low, high) == pytest.approx((3.04, 6.96))
    inside = (values >= low) & (values <= high)
    assert image[inside] == pytest.approx((values[inside] - low) / (high - low) * 255, abs=1e-4)
    assert image.dtype == np.float32


def test_outliers_are_clipped_and_do_not_shrink_the_rest():
    values = np.linspace(0.0, 1.0, EVERYWHERE.size).reshape(EVERYWHERE.shape)
    values[0, 0], values[5, 5] = -1e9, 1e9
    image, (low, high) = normalize(values, EVERYWHERE)
    assert image[0, 0] == 0
    assert image[5, 5] == 255
    assert (low, high) == pytest.approx((0.01, 0.99), abs=2e-3)


def test_pixels_without_return_count_for_nothing_and_become_0():
    rng = np.random.default_rng(0)
    values, valid = rng.random((20, 20)), rng.random((20, 20)) > 0.3
    spoiled = np.where(valid, values, np.nan)
    image, limits = normalize(spoiled, valid)
    assert limits == tuple(np.percentile(values[valid], PERCENTILES))
    assert (image[~valid] == 0).all()
    assert np.isfinite(image).all()


def test_a_flat_image_becomes_0():
    image, limits = normalize(np.full((4, 5), 7.5), np.ones((4, 5), bool))
    assert (image == 0).all()
    assert limits == (7.5, 7.5)


def test_contrast_beyond_the_percentiles_is_kept_where_there_is_no_other():
    values = np.full((30, 30), 2.0)
    values[3, 4] = 6.0
    image, limits = normalize(values, np.ones((30, 30), bool))
    assert limits == (2.0, 6.0)
    assert image[3, 4] == 255
    assert (np.delete(image.ravel(), 3 * 30 + 4) == 0).all()


def test_without_a_return_everything_is_0():
    image, limits = normalize(np.full((2, 3), 5.0), np.zeros((2, 3), bool))
    assert (image == 0).all()
    assert limits == (0.0, 0.0)


@given(
    values=arrays(np.float64, (4, 6), elements=st.integers(-1000, 1000).map(float)),
    gain=st.sampled_from([0.25, 1.0, 64.0]),
    offset=st.integers(-500, 500),
)
def test_neither_unit_nor_offset_of_the_raw_values_matters(values, gain, offset):
    valid = np.ones(values.shape, bool)
    image, _ = normalize(values, valid)
    other, _ = normalize(values * gain + offset, valid)
    assert other == pytest.approx(image, abs=1e-3)
    assert ((image >= 0) & (image <= 255)).all()
