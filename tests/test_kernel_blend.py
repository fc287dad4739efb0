"""The kernel's blending of equation 1 against the reference, and its independence of threads."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_graphs import small_graphs

from reflcolor_addon import kernel
from reflcolor_addon.errors import Cancelled, ReflcolorError
from reflcolor_addon.reference import reference_blend

ALPHAS = st.sampled_from([0.0, 0.5, 1.0, 2.5, 6.0, 20.0])
# A hundredth of an 8-bit level.
TOLERANCE = 0.01


def random_colors(count):
    return np.random.default_rng(count).random((count, 2)) * 255


@settings(max_examples=500)
@given(small_graphs(), ALPHAS)
def test_blending_all_seeds_is_the_reference(small, alpha):
    colors = random_colors(len(small.pixels))
    mean = kernel.blend_all(small.kernel_graph(), small.pixels, colors, alpha)
    fields = small.fields().astype(np.float64)
    expected = reference_blend(fields, colors.astype(np.float32), alpha)
    reached = mean.weight > 0
    np.testing.assert_array_equal(reached, np.isfinite(expected[..., 0]))
    np.testing.assert_allclose(np.moveaxis(mean.chroma, 0, -1)[reached], expected[reached], atol=TOLERANCE)
    np.testing.assert_array_equal(mean.least, fields.min(axis=0))
    np.testing.assert_array_equal(mean.nearest_seed, np.where(reached, fields.argmin(axis=0), -1))


@settings(max_examples=300)
@given(small_graphs(), ALPHAS)
def test_blending_as_many_nearest_as_there_are_seeds_is_blending_all(small, alpha):
    colors, graph = random_colors(len(small.pixels)), small.kernel_graph()
    every = kernel.blend_all(graph, small.pixels, colors, alpha)
    mean, bound = kernel.blend_nearest(*kernel.nearest(graph, small.pixels, len(colors)), colors, alpha)
    np.testing.assert_allclose(mean.chroma, every.chroma, atol=TOLERANCE)
    np.testing.assert_array_equal(mean.least, every.least)
    assert (bound == 0).all()


@settings(max_examples=300)
@given(small_graphs(seeds=12), st.integers(1, 6), ALPHAS)
def test_the_bound_holds(small, k, alpha):
    colors, graph = random_colors(len(small.pixels)), small.kernel_graph()
    every = kernel.blend_all(graph, small.pixels, colors, alpha)
    mean, bound = kernel.blend_nearest(*kernel.nearest(graph, small.pixels, k), colors, alpha)
    assert (np.abs(mean.chroma - every.chroma) <= bound + TOLERANCE).all()


def test_seeds_at_distance_zero_share_a_pixel_equally():
    flat = np.zeros((2, 3), np.float32)
    mean = kernel.blend_all(kernel.Graph(flat, flat, flat == 0), [0, 3, 5], [[0, 30], [30, 0], [60, 60]], 6.0)
    np.testing.assert_allclose(mean.chroma, np.full((2, 2, 3), 30.0))
    assert (mean.weight == 3).all()


@pytest.mark.parametrize("alpha", [6.0, 2.5])
def test_the_number_of_threads_changes_no_bit(alpha):
    random = np.random.default_rng(1)
    luminance, range_image = (random.random((2, 60, 80)) * 255).astype(np.float32)
    valid = random.random((60, 80)) < 0.9
    graph = kernel.Graph(luminance, range_image, valid)
    pixels = random.choice(np.flatnonzero(valid), 40)
    runs = [kernel.blend_all(graph, pixels, random_colors(40), alpha, threads=threads) for threads in (1, 2, 3, 50)]
    for run in runs[1:]:
        for one, other in zip(runs[0], run, strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("threads", [1, 3])
def test_an_error_while_blending_reaches_the_caller_and_ends_every_thread(threads):
    flat = np.zeros((5, 5), np.float32)

    def stop(blended):
        raise Cancelled

    graph = kernel.Graph(flat, flat, flat == 0)
    with pytest.raises(Cancelled):
        kernel.blend_all(graph, np.arange(20), np.zeros((20, 2)), 6.0, threads=threads, finished=stop)


@pytest.mark.parametrize("alpha", [-1, np.nan, np.inf])
def test_an_exponent_out_of_its_range_is_refused(alpha):
    with pytest.raises(ReflcolorError, match="alpha"):
        kernel.Blend((2, 2), alpha)


def test_colors_that_do_not_fit_the_seeds_are_refused():
    flat = np.zeros((2, 2), np.float32)
    graph = kernel.Graph(flat, flat, flat == 0)
    with pytest.raises(ReflcolorError, match=r"\(2, 2\)"):
        kernel.blend_all(graph, [0, 1], [[1, 2]], 6.0)
    with pytest.raises(ReflcolorError, match="finite"):
        kernel.blend_all(graph, [0], [[np.nan, 2]], 6.0)


def test_arrays_that_did_not_come_from_the_kernel_are_refused():
    flat = np.zeros((2, 2), np.float32)
    distances, seeds = kernel.nearest(kernel.Graph(flat, flat, flat == 0), [0], 2)
    with pytest.raises(ReflcolorError, match="returned"):
        kernel.blend_nearest(distances.copy(), seeds, [[1, 2]], 6.0)
    with pytest.raises(ReflcolorError, match="seed"):
        kernel.blend_nearest(*kernel.nearest(kernel.Graph(flat, flat, flat == 0), [0, 1], 2), [[1, 2]], 6.0)
