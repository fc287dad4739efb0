"""The kernel's geodesic fields against the reference and against closed forms."""

import numpy as np
import pytest
from dijkstra_reference import reference_distances
from hypothesis import given, settings
from small_graphs import small_graphs

from reflcolor_addon.errors import ReflcolorError
from reflcolor_addon.geodesic import kernel


@pytest.mark.slow
@settings(max_examples=1000)
@given(small_graphs())
def test_a_field_is_the_reference_within_the_stated_error(small):
    pixel = int(small.pixels[0])
    distances = kernel.field(small.kernel_graph(), pixel)
    source = divmod(pixel, small.valid.shape[1])
    expected = reference_distances(small.luminance, small.range_image, small.valid, source, **small.settings)
    steps = small.valid.size
    np.testing.assert_allclose(distances, expected, rtol=(steps + 7) * 2**-24)


@settings(max_examples=300)
@given(small_graphs())
def test_a_field_of_several_pixels_is_the_least_of_their_fields(small):
    together = kernel.field(small.kernel_graph(), small.pixels)
    np.testing.assert_array_equal(together, small.fields().min(axis=0))


@settings(max_examples=300)
@given(small_graphs())
def test_distances_are_a_fixed_point(small):
    """No neighbor offers a shorter path: starting every pixel at its distance changes nothing."""
    graph = small.kernel_graph()
    distances = kernel.field(graph, small.pixels)
    reached = np.flatnonzero(np.isfinite(distances))
    again = kernel.field(graph, reached, start=distances[np.unravel_index(reached, distances.shape)])
    np.testing.assert_array_equal(again, distances)


def test_on_one_row_the_distance_is_the_sum_of_the_differences():
    luminance = np.array([[0, 10, 5, 5, 200, 100]], np.float32)
    graph = kernel.Graph(luminance, np.zeros_like(luminance), np.ones(luminance.shape, bool))
    np.testing.assert_array_equal(kernel.field(graph, 2), [[15, 5, 0, 0, 195, 295]])


def test_a_range_step_multiplies_the_luminance_step():
    luminance, range_image = np.array([[0, 2]], np.float32), np.array([[0, 3]], np.float32)
    graph = kernel.Graph(luminance, range_image, np.ones((1, 2), bool), beta=5)
    np.testing.assert_array_equal(kernel.field(graph, 0), [[0, (5 * 9 + 1) * 2]])


def test_a_constant_step_cost_counts_diagonal_steps_longer():
    flat = np.zeros((2, 2), np.float32)
    graph = kernel.Graph(flat, flat, np.ones((2, 2), bool), step_cost=1)
    np.testing.assert_allclose(kernel.field(graph, 0), [[0, 1], [1, np.sqrt(2)]], rtol=1e-7)


def test_a_wall_without_returns_stops_a_path_and_wrapping_leads_around_it():
    luminance = np.tile(np.arange(7, dtype=np.float32), (3, 1))
    valid = np.ones((3, 7), bool)
    valid[:, 3] = False
    alone = kernel.field(kernel.Graph(luminance, luminance * 0, valid), 0)
    around = kernel.field(kernel.Graph(luminance, luminance * 0, valid, wrap=True), 0)
    assert np.isinf(alone[:, 3:]).all()
    np.testing.assert_array_equal(around[0, [6, 5, 4]], [6, 7, 8])
    assert np.isinf(around[:, 3]).all()


@pytest.mark.parametrize("view", [np.s_[::2, :], np.s_[:, ::3], np.s_[::-1, ::-1], np.s_[1:-1, 2:-3]])
def test_views_of_any_stride_are_read_right(view):
    random = np.random.default_rng(0)
    luminance, range_image = (random.random((2, 20, 30)) * 255).astype(np.float32)
    valid = random.random((20, 30)) < 0.9
    seen = [array[view] for array in (luminance, range_image, valid)]
    pixel = np.flatnonzero(seen[2])[0]
    strided = kernel.field(kernel.Graph(*seen), pixel)
    np.testing.assert_array_equal(strided, kernel.field(kernel.Graph(*map(np.copy, seen)), pixel))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("which", [0, 1])
def test_a_value_that_is_no_number_is_refused_at_a_valid_pixel_only(which, value):
    images = [np.zeros((3, 3), np.float32), np.zeros((3, 3), np.float32)]
    images[which][1, 1] = value
    valid = np.ones((3, 3), bool)
    with pytest.raises(ReflcolorError, match="finite at every valid pixel"):
        kernel.Graph(*images, valid)
    valid[1, 1] = False
    assert np.isinf(kernel.field(kernel.Graph(*images, valid), 0)[1, 1])


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"beta": -1}, "beta"),
        ({"beta": np.nan}, "beta"),
        ({"beta": np.inf}, "beta"),
        ({"step_cost": -1}, "step_cost"),
        ({"neighbors": 6}, "neighbors"),
    ],
)
def test_a_setting_out_of_its_range_is_refused(settings, message):
    flat = np.zeros((2, 2), np.float32)
    with pytest.raises(ReflcolorError, match=message):
        kernel.Graph(flat, flat, np.ones((2, 2), bool), **settings)


def test_images_of_different_size_or_none_are_refused():
    flat = np.zeros((2, 2), np.float32)
    with pytest.raises(ReflcolorError, match="one size"):
        kernel.Graph(flat, flat, np.ones((2, 3), bool))
    with pytest.raises(ReflcolorError, match="needs 1 to"):
        kernel.Graph(flat[:0], flat[:0], np.ones((0, 2), bool))


@pytest.mark.parametrize("pixel", [-1, 4, 2**40])
def test_a_seed_outside_is_refused(pixel):
    flat = np.zeros((2, 2), np.float32)
    with pytest.raises(ReflcolorError, match="outside the image"):
        kernel.field(kernel.Graph(flat, flat, np.ones((2, 2), bool)), pixel)


def test_a_seed_without_a_return_is_refused():
    flat = np.zeros((2, 2), np.float32)
    with pytest.raises(ReflcolorError, match="without a return"):
        kernel.field(kernel.Graph(flat, flat, np.array([[True, True], [True, False]])), 3)
