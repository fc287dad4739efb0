"""Colors that stand for values."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.view.colormaps import GRADIENTS, UNKNOWN, gradient, limits_of, painted, region_colors


@pytest.mark.parametrize("name", GRADIENTS)
def test_a_gradient_never_repeats_its_ends(name):
    colors = gradient(name).astype(int)
    assert colors.shape == (256, 3)
    assert np.abs(colors[0] - colors[-1]).sum() > 100
    assert np.abs(np.diff(colors, axis=0)).max() <= 12


def test_viridis_gets_lighter_with_the_value():
    luminance = gradient("viridis") @ np.array([0.299, 0.587, 0.114])
    assert (np.diff(luminance) > -0.7).all() and luminance[-1] - luminance[0] > 150


def test_values_are_painted_between_the_limits_and_clipped_beyond():
    colors = painted([-5.0, 2.0, 3.0, 4.0, 9.0], "viridis", (2.0, 4.0))
    ramp = gradient("viridis")
    np.testing.assert_array_equal(colors, ramp[[0, 0, 128, 255, 255]])


def test_what_is_not_known_is_gray():
    colors = painted([np.nan, 1.0], "inferno", (0.0, 1.0))
    assert tuple(colors[0]) == UNKNOWN and tuple(colors[1]) == tuple(gradient("inferno")[255])
    assert painted([], "inferno", (0.0, 1.0)).shape == (0, 3)


def test_equal_limits_paint_the_low_end():
    np.testing.assert_array_equal(painted([3.0, 3.0], "turbo", (3.0, 3.0)), gradient("turbo")[[0, 0]])


def test_limits_leave_outliers_out():
    low, high = limits_of(np.append(np.linspace(1, 2, 999), 1e6))
    assert 1.0 <= low < 1.05 and 1.95 < high <= 2.0
    assert limits_of([np.nan]) == (0.0, 1.0)
    assert limits_of([7.0, 7.0]) == (7.0, 7.0)


def test_regions_that_follow_each_other_are_told_apart():
    colors = region_colors(np.arange(500)).astype(int)
    for step in (1, 2, 3):
        assert np.abs(colors[step:] - colors[:-step]).max(axis=1).min() > 30
    assert len({tuple(color) for color in colors.tolist()}) > 450


@given(st.lists(st.integers(-1, 3000), max_size=30))
def test_a_region_has_the_same_color_whatever_others_there_are(indices):
    together = region_colors(indices)
    for index, color in zip(indices, together, strict=True):
        expected = UNKNOWN if index < 0 else tuple(region_colors([index])[0])
        assert tuple(color) == tuple(expected)
