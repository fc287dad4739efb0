"""The kernel's blending of equation 1 against the reference, and its independence of threads."""

import numpy as np
import pytest
from dijkstra_reference import reference_blend
from hypothesis import given, settings
from hypothesis import strategies as st
from small_graphs import small_graphs

from reflcolor_addon.errors import ReflcolorError
from reflcolor_addon.geodesic import kernel

ALPHAS = st.sampled_from([0.0, 0.5, 1.0, 2.5, 6.0, 20.0])
# Chrominance has two, a whole color three.
CHANNELS = st.integers(1, 4)
# A hundredth of an 8-bit level.
TOLERANCE = 0.01


def random_colors(count, channels=2):
    return np.random.default_rng(count).random((count, channels)) * 255


def blend_all(small, colors, alpha):
    """The mean over all seeds, one field after another."""
    blend = kernel.Blend(small.valid.shape, alpha, colors.shape[1])
    for field, color in zip(small.fields(), colors, strict=True):
        blend.add(field, color)
    return blend.mean()


@settings(max_examples=500)
@given(small_graphs(), ALPHAS, CHANNELS)
def test_blending_all_seeds_is_the_reference(small, alpha, channels):
    colors = random_colors(len(small.pixels), channels)
    mean = blend_all(small, colors, alpha)
    fields = small.fields().astype(np.float64)
    expected = reference_blend(fields, colors.astype(np.float32), alpha)
    reached = mean.weight > 0
    np.testing.assert_array_equal(reached, np.isfinite(expected[..., 0]))
    np.testing.assert_allclose(np.moveaxis(mean.values, 0, -1)[reached], expected[reached], atol=TOLERANCE)
    np.testing.assert_array_equal(mean.least, fields.min(axis=0))
    np.testing.assert_array_equal(mean.nearest_seed, np.where(reached, fields.argmin(axis=0), -1))


@settings(max_examples=300)
@given(small_graphs(), ALPHAS, CHANNELS)
def test_blending_as_many_nearest_as_there_are_seeds_is_blending_all(small, alpha, channels):
    colors, graph = random_colors(len(small.pixels), channels), small.kernel_graph()
    every = blend_all(small, colors, alpha)
    mean, bound = kernel.nearest(graph, small.pixels, len(colors)).blend(colors, alpha)
    np.testing.assert_allclose(mean.values, every.values, atol=TOLERANCE)
    np.testing.assert_array_equal(mean.least, every.least)
    assert (bound == 0).all()


@settings(max_examples=1000)
@given(small_graphs(seeds=12), st.integers(1, 6), ALPHAS, CHANNELS)
def test_the_bound_holds(small, k, alpha, channels):
    colors, graph = random_colors(len(small.pixels), channels), small.kernel_graph()
    every = blend_all(small, colors, alpha)
    mean, bound = kernel.nearest(graph, small.pixels, k).blend(colors, alpha)
    assert (np.abs(mean.values - every.values) <= bound + TOLERANCE).all()


def test_the_bound_is_what_the_worst_seeds_at_the_last_distance_do():
    """One row: seed 0 near, seed 1 kept, and seeds as far as that on its other side, left out."""
    luminance = np.array([[2, 0, 1]], np.float32)
    graph = kernel.Graph(luminance, luminance * 0, luminance >= 0)
    # From pixel 1, pixel 2 is 1 away and pixel 0 twice that; k = 2 keeps the seeds of color 0 and 8.
    colors = np.array([[0, 0], [8, 0], [8, 0], [16, 0]], np.float32)
    mean, bound = kernel.nearest(graph, [2, 0, 0, 0], 2).blend(colors, 1.0)
    every = kernel.Blend((1, 3), 1.0)
    for pixel, color in zip([2, 0, 0, 0], colors, strict=True):
        every.add(kernel.field(graph, pixel), color)
    # All left out have the weight of the last kept one, and lie to one side, as the bound assumes.
    off = every.mean().values[0, 0, 1] - mean.values[0, 0, 1]
    assert off == pytest.approx((0.5 * 8 * 2 + 0.5 * 16) / 2.5 - 0.5 * 8 / 1.5)
    assert off <= bound[0, 1] <= 1.1 * off


def test_seeds_at_distance_zero_share_a_pixel_equally():
    flat = np.zeros((2, 3), np.float32)
    field = kernel.field(kernel.Graph(flat, flat, flat == 0), 0)
    blend = kernel.Blend((2, 3), 6.0)
    for color in ([0, 30], [30, 0], [60, 60]):
        blend.add(field, color)
    mean = blend.mean()
    np.testing.assert_allclose(mean.values, np.full((2, 2, 3), 30.0))
    assert (mean.weight == 3).all()


def test_a_channel_more_changes_no_bit_of_the_others():
    luminance = np.random.default_rng(1).random((9, 11)).astype(np.float32) * 255
    graph, pixels, colors = kernel.Graph(luminance, luminance, luminance >= 0), [3, 40, 71, 90], random_colors(4, 3)
    found, fields = kernel.nearest(graph, pixels, 3), [kernel.field(graph, pixel) for pixel in pixels]
    for channels in (1, 2):
        part, whole = (found.blend(colors[:, :count], 3.0)[0] for count in (channels, 3))
        np.testing.assert_array_equal(part.values, whole.values[:channels])
        sums = [kernel.Blend(luminance.shape, 3.0, count) for count in (channels, 3)]
        for blend, count in zip(sums, (channels, 3), strict=True):
            blend.add_all(fields, colors[:, :count])
        np.testing.assert_array_equal(sums[0].mean().values, sums[1].mean().values[:channels])


@pytest.mark.parametrize("alpha", [-1, np.nan, np.inf])
def test_an_exponent_out_of_its_range_is_refused(alpha):
    with pytest.raises(ReflcolorError, match="alpha"):
        kernel.Blend((2, 2), alpha)


def test_colors_that_do_not_fit_the_seeds_are_refused():
    flat = np.zeros((2, 2), np.float32)
    found = kernel.nearest(kernel.Graph(flat, flat, flat == 0), [0, 1], 2)
    with pytest.raises(ReflcolorError, match="seeds, 1 to 4"):
        found.blend([1, 2], 6.0)
    with pytest.raises(ReflcolorError, match="finite"):
        found.blend([[np.nan, 2], [1, 1]], 6.0)
    with pytest.raises(ReflcolorError, match="seed"):
        found.blend([[1, 2]], 6.0)
