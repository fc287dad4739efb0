"""What a pointer means: views of an image, hits, outlines, strokes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.view.picking import (
    ImageView,
    beads,
    box_outline,
    centers,
    clamped_pixel,
    clamped_point,
    corner_nearest,
    inside_outline,
    nearest_within,
)

# 450 x 300 pixels, shown at 2.5 times their size with the bottom left corner at (100, 50).
VIEW = ImageView((450, 300), (100.0, 50.0), (2.5, 2.5))
places = st.tuples(st.floats(-500, 1500), st.floats(-500, 1500))


def test_the_images_corners_are_where_the_editor_shows_them():
    np.testing.assert_allclose(VIEW.to_region([(0, 300), (450, 0)]), [(100, 50), (1225, 800)])


@given(places)
def test_a_place_of_the_region_comes_back_from_the_image(place):
    np.testing.assert_allclose(VIEW.to_region(VIEW.to_image(place)), place, atol=1e-9)


@given(
    size=st.tuples(st.integers(1, 5000), st.integers(1, 5000)),
    corner=st.tuples(st.floats(-2000, 2000), st.floats(-2000, 2000)),
    zoom=st.floats(0.05, 40),
)
def test_a_view_measured_in_whole_pixels_is_off_by_less_than_one(size, corner, zoom):
    shown = np.array(size) * zoom
    first = np.floor(corner - 10 * shown)
    second = np.floor(corner + 11 * shown)
    view = ImageView.through(size, first, second, 10)
    exact = ImageView(size, corner, (zoom, zoom))
    image_corners = [(0, 0), size, (size[0] / 3, size[1] / 7)]
    assert np.abs(view.to_region(image_corners) - exact.to_region(image_corners)).max() < 1


@pytest.mark.parametrize(
    ("xy", "pixel"),
    [((0, 0), (0, 0)), ((4.9, 2.1), (2, 4)), ((-3, 99), (5, 0)), ((10, 6), (5, 9)), ((10.5, -1), (0, 9))],
)
def test_a_point_beside_the_image_means_its_nearest_pixel(xy, pixel):
    assert clamped_pixel(xy, (6, 10)) == pixel


def test_a_point_beside_the_image_is_brought_to_its_edge():
    assert clamped_point((-4.0, 700.0), (450, 300)) == (0.0, 300.0)
    assert clamped_point((12.5, 3.0), (450, 300)) == (12.5, 3.0)


def test_a_pixels_center_is_inside_it():
    np.testing.assert_array_equal(centers([0, 5], [3, 9]), [(3.5, 0.5), (9.5, 5.5)])


def test_the_nearest_point_is_hit_and_of_equals_the_last_which_is_drawn_on_top():
    points = [(0, 0), (10, 0), (10, 0), (40, 0)]
    assert nearest_within(points, (12, 1), 5) == 2
    assert nearest_within(points, (20, 0), 5) is None
    assert nearest_within(np.zeros((0, 2)), (0, 0), 5) is None


@given(corner=places, opposite=places, points=st.lists(places, min_size=1, max_size=20))
def test_a_box_holds_what_lies_between_its_corners(corner, opposite, points):
    points = np.array(points)
    low, high = np.minimum(corner, opposite), np.maximum(corner, opposite)
    inside = ((points > low) & (points < high)).all(axis=1)
    on_edge = ((points >= low) & (points <= high)).all(axis=1) & ~inside
    found = inside_outline(points, box_outline(corner, opposite))
    near_edge = on_edge | (np.abs(points - low) < 1e-6).any(axis=1) | (np.abs(points - high) < 1e-6).any(axis=1)
    assert (found == inside)[~near_edge].all()


def test_an_outline_of_two_points_holds_nothing():
    assert not inside_outline([(1, 1)], [(0, 0), (5, 5)]).any()


@given(start=places, end=places, spacing=st.floats(0.5, 300))
def test_beads_lie_on_the_way_one_spacing_apart(start, end, spacing):
    found = beads(start, end, spacing)
    length = np.hypot(*np.subtract(end, start))
    assert len(found) in {int(length / spacing), int(length / spacing + 1e-9)}
    if len(found):
        steps = np.linalg.norm(np.diff(np.vstack([start, found]), axis=0), axis=1)
        np.testing.assert_allclose(steps, spacing, rtol=1e-6)
        assert np.linalg.norm(found[-1] - end) < spacing * (1 + 1e-6)


def test_the_corner_nearest_to_a_spot_is_chosen():
    assert corner_nearest([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], (0.9, 0.6, 0.2)) == 2
