"""Grids that are none, that count by threes, or that were thinned out; and where their points were measured from."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_scans import room_points

from reflcolor_addon.scan.coherence import LineLength, is_unordered
from reflcolor_addon.scan.grid_health import coarser, compacted, nearest_to_center, neighbor_share
from reflcolor_addon.scan.origin import better_origin, fitted_origin, repeated_point

ROOM = room_points(40, 90, step_deg=(3.0, 4.0), top_deg=60.0, left_deg=178.0)
# A floor and a ceiling, so that a column does not lie on one upright line.
ROOM = ROOM * np.minimum(1, np.where(ROOM[..., 2] < 0, 1.2, 1.8) / np.maximum(np.abs(ROOM[..., 2]), 1e-9))[..., None]
THERE = np.ones(ROOM.shape[:2], bool)


@given(seed=st.integers(0, 2**32), share=st.floats(0.3, 1), noise=st.floats(0, 0.02))
def test_a_grid_with_holes_and_noise_is_in_order_and_its_points_in_any_order_are_not(seed, share, noise):
    rng = np.random.default_rng(seed)
    points, valid = ROOM + rng.normal(0, noise, ROOM.shape), rng.random(THERE.shape) < share
    assert not is_unordered(points, valid)
    mixed = rng.permutation(points.reshape(-1, 3)).reshape(points.shape)
    assert is_unordered(mixed, valid)


def test_a_grid_that_is_coherent_in_one_direction_only_is_in_order():
    rows = ROOM[np.random.default_rng(0).permutation(len(ROOM))]
    assert not is_unordered(rows, THERE)


@pytest.mark.parametrize("as_column", [False, True])
def test_one_row_is_a_profile_but_not_a_whole_scan_in_one_row(as_column):
    def stored(points):
        return points.reshape(-1, 1, 3) if as_column else points.reshape(1, -1, 3)

    profile, whole = stored(ROOM[20]), stored(ROOM)
    assert not is_unordered(profile, np.ones(profile.shape[:2], bool))
    assert is_unordered(whole, np.ones(whole.shape[:2], bool))


def test_too_few_points_are_taken_as_they_are():
    assert not is_unordered(np.random.default_rng(0).normal(size=(4, 5, 3)), np.ones((4, 5), bool))


def length_of(points, valid, candidates):
    length = LineLength(len(points), candidates)
    return length.of(points[length.places], valid[length.places])


@pytest.mark.parametrize("swapped", [False, True])
@given(seed=st.integers(0, 2**32), share=st.floats(0.3, 1))
def test_the_length_of_a_line_is_found_among_two(swapped, seed, share):
    rng = np.random.default_rng(seed)
    points = ROOM.reshape(-1, 3) if swapped else ROOM.swapaxes(0, 1).reshape(-1, 3)
    valid = rng.random(len(points)) < share
    assert length_of(points, valid, (40, 90)) == (90 if swapped else 40)
    assert length_of(points, valid, (90, 40)) == (90 if swapped else 40)


def test_the_stated_length_is_kept_where_the_points_do_not_tell():
    assert length_of(np.zeros((12, 3)), np.zeros(12, bool), (3, 4)) == 3
    assert length_of(np.zeros((3600, 3)), np.ones(3600, bool), (90, 40)) == 90


@pytest.mark.parametrize(("by_row", "by_col"), [(3, 3), (2, 1), (1, 5)])
@pytest.mark.parametrize(("first_row", "first_col"), [(0, 0), (1, 0)])
def test_numbers_that_skip_rows_or_columns_are_closed_up(by_row, by_col, first_row, first_col):
    rng = np.random.default_rng(1)
    whole = rng.random((20, 30)) < 0.8
    stored = np.zeros((20 * by_row + 3, 30 * by_col + 2), bool)
    first = first_row % by_row, first_col
    stored[first[0] : first[0] + 20 * by_row : by_row, first[1] : 30 * by_col : by_col] = whole
    cells = compacted(stored)
    assert cells.stride == (by_row, by_col)
    rows, cols = np.nonzero(stored)
    found = np.zeros(cells.shape, bool)
    found[cells.rows[rows], cells.cols[cols]] = True
    assert (cells.rows[rows] >= 0).all() and (cells.cols[cols] >= 0).all()
    np.testing.assert_array_equal(found[:20, :30], whole)
    assert not found[20:].any() and not found[:, 30:].any()


def test_a_grid_with_empty_rows_between_full_ones_is_whole():
    valid = np.ones((20, 30), bool)
    valid[4:9] = valid[:, 7] = False
    assert compacted(valid) is None
    assert coarser(valid) is None


@pytest.mark.parametrize("share", [0.5, 0.3, 0.15, 0.06])
def test_a_grid_thinned_at_random_becomes_the_finest_coarser_one_that_is_whole(share):
    valid = np.random.default_rng(2).random((160, 240)) < share
    cells = coarser(valid)
    rows, cols = np.nonzero(valid)
    found = np.zeros(cells.shape, bool)
    found[cells.rows[rows], cells.cols[cols]] = True
    assert neighbor_share(found) >= 0.75
    stride = cells.stride[0] - 1
    blocks = valid[: 160 // stride * stride, : 240 // stride * stride]
    blocks = blocks.reshape(160 // stride, stride, 240 // stride, stride).any(axis=(1, 3))
    assert neighbor_share(blocks) < 0.75


def test_a_grid_that_is_nearly_empty_has_no_coarser_one():
    with pytest.raises(ValueError):
        coarser(np.random.default_rng(3).random((200, 200)) < 0.002)


def test_the_pixel_in_the_middle_of_its_block_is_the_nearest_to_its_center():
    cells = coarser(np.random.default_rng(2).random((60, 60)) < 0.2)
    assert cells.stride == (3, 3)
    away = nearest_to_center(*np.indices((3, 3)).reshape(2, 9), cells)
    assert np.argmin(away) == 4 and away[4] == 0


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("place", [(35.0, 12.0, 2.0), (637012.25, 849028.5, 431.5)])
def test_the_place_of_the_scanner_is_found_from_the_grid_alone(swapped, place):
    points, valid = ROOM + place, np.random.default_rng(4).random(THERE.shape) < 0.9
    if swapped:
        points, valid = points.swapaxes(0, 1), valid.T
    kind, origin = better_origin(points, valid, {})
    assert kind == "fit" and origin.spread < 0.01
    np.testing.assert_allclose(origin.place, place, rtol=0, atol=1e-5)


def test_the_place_is_found_to_millimeters_with_noise_and_outliers():
    rng = np.random.default_rng(5)
    points = ROOM * (1 + rng.normal(0, 0.0005, (*THERE.shape, 1))) + (35.0, 12.0, 2.0)
    points[rng.random(THERE.shape) < 0.03] += 0.5
    np.testing.assert_allclose(fitted_origin(points, THERE), (35, 12, 2), atol=0.02)


def test_a_place_that_the_file_names_is_taken_before_a_fit():
    kind, origin = better_origin(ROOM + (35, 12, 2), THERE, {"position": (35, 12, 2), "matrix": (1, 2, 3)})
    assert kind == "position"
    np.testing.assert_array_equal(origin.place, (35, 12, 2))


def test_points_that_are_measured_from_the_scanner_stay():
    assert better_origin(ROOM, THERE, {"position": (35, 12, 2)}) is None
    noisy = ROOM + np.random.default_rng(6).normal(0, 0.01, ROOM.shape)
    assert better_origin(noisy, THERE, {"position": (35, 12, 2)}) is None


def test_points_from_which_no_place_makes_a_grid_stay():
    mixed = np.random.default_rng(7).permutation(ROOM.reshape(-1, 3)).reshape(ROOM.shape)
    assert better_origin(mixed, THERE, {"position": (1, 1, 1)}) is None


def test_a_point_that_many_pixels_repeat_is_found():
    points = ROOM.reshape(-1, 3).copy()
    assert repeated_point(points) is None
    points[5::40] = 10, 20, 3
    np.testing.assert_array_equal(repeated_point(points), (10, 20, 3))


def test_points_that_coincide_by_rounding_are_not_taken_for_it():
    points = np.round(ROOM.reshape(-1, 3), 1)
    assert repeated_point(points) is None


@pytest.mark.parametrize("slope", [0.0, 0.3, -0.6])
def test_a_camera_is_not_moved(slope):
    right, down = np.meshgrid((np.arange(120) - 60) / 100, (np.arange(90) - 45) / 100)
    depth = 2 / (1 - slope * right) + np.where(right > 0.2, 0.7, 0.0)
    points = np.stack([right * depth, depth, -down * depth], axis=-1)
    assert better_origin(points, np.ones((90, 120), bool), {}) is None
