"""Which way up a grid is, read from its points, and how a person overrules it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_scans import intensity_of, room_points

from reflcolor_addon.scan.orientation import Turn, flipped, frame_with_up, infer_turn, up_of_camera
from reflcolor_addon.scan.scan import Scan

TURNS = {(v, h): (slice(None, None, -1 if v else 1), slice(None, None, -1 if h else 1)) for v in (0, 1) for h in (0, 1)}


def needed(points, valid=None):
    return infer_turn(points, np.ones(points.shape[:2], bool) if valid is None else valid)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(
    "points",
    [
        room_points(),
        room_points(2, 2),
        room_points(90, 180, step_deg=(1.0, 2.0), top_deg=44.0, left_deg=170.0),
        room_points(700, 900, step_deg=(0.1, 0.4), top_deg=40.0),
        room_points(40, 30, step_deg=(1.0, 1.0), top_deg=89.0),
        room_points(12, 12, step_deg=(0.01, 0.01), top_deg=-20.0),
    ],
)
def test_the_flips_that_a_stored_order_needs_are_found(points, turn):
    assert needed(points[TURNS[turn]]) == Turn(False, bool(turn[0]), bool(turn[1]), True)


@given(seed=st.integers(0, 2**32), share=st.floats(0.3, 1), turn=st.sampled_from(sorted(TURNS)))
def test_holes_and_noise_do_not_mislead(seed, share, turn):
    rng = np.random.default_rng(seed)
    points = room_points(60, 80, step_deg=(0.5, 0.7)) * rng.uniform(0.5, 2, (60, 80, 1))
    points += rng.normal(0, 0.01, points.shape)
    valid = rng.random((60, 80)) < share
    points[~valid] = rng.normal(size=3)
    assert needed(points[TURNS[turn]], valid[TURNS[turn]]) == Turn(False, bool(turn[0]), bool(turn[1]), True)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_single_row_still_tells_left_from_right(mirrored):
    row = room_points(1, 30)
    assert needed(row[:, ::-1] if mirrored else row).horizontal == mirrored


@pytest.mark.parametrize("upside_down", [False, True])
def test_a_single_column_still_tells_up_from_down(upside_down):
    column = room_points(30, 1)
    assert needed(column[::-1] if upside_down else column) == Turn(False, upside_down, False, True)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(
    "points",
    [
        room_points(),
        room_points(90, 180, step_deg=(1.0, 2.0), top_deg=44.0, left_deg=170.0),
        room_points(60, 120, step_deg=(2.0, 3.0), top_deg=85.0, left_deg=170.0),
        room_points(12, 12, step_deg=(0.01, 0.01), top_deg=-20.0),
    ],
)
def test_rows_and_columns_that_are_swapped_are_found(points, turn):
    stored = points[TURNS[turn]].swapaxes(0, 1)
    found = needed(stored)
    assert found.transposed and found.certain
    np.testing.assert_array_equal(found.of(stored), points)


@given(seed=st.integers(0, 2**32), share=st.floats(0.4, 1))
def test_holes_and_noise_do_not_swap_rows_and_columns(seed, share):
    rng = np.random.default_rng(seed)
    points = room_points(60, 80, step_deg=(0.5, 0.7)) * rng.uniform(0.5, 2, (60, 80, 1))
    points += rng.normal(0, 0.01, points.shape)
    valid = rng.random((60, 80)) < share
    assert not needed(points, valid).transposed
    assert needed(points.swapaxes(0, 1), valid.T).transposed


def camera_points(forward=1.0, size=(20, 30), slope=0.3):
    """What a camera that looks along its Z axis measures on a slanted plane: rows from the top, in its own frame."""
    height, width = size
    right, down = np.meshgrid(np.linspace(-0.5, 0.5, width), np.linspace(-0.4, 0.4, height))
    depth = 2 / (1 - slope * right)
    return np.stack([right * depth, down * depth * np.sign(forward), depth * np.sign(forward)], axis=-1)


@pytest.mark.parametrize(("forward", "up"), [(1.0, (0, -1, 0)), (-1.0, (0, 1, 0))])
def test_a_camera_that_looks_along_its_z_axis_counts_y_like_an_image(forward, up):
    points = camera_points(forward)
    valid = np.random.default_rng(0).random(points.shape[:2]) < 0.8
    assert tuple(up_of_camera(points, valid)) == up
    upright = points @ frame_with_up(up).T
    assert needed(upright) == Turn(False, False, False, True)
    assert (upright[..., 1] > 0).all() and upright[0, 0, 2] > upright[-1, 0, 2] and upright[0, 0, 0] < upright[0, -1, 0]


def test_a_scanner_that_sees_the_zenith_is_no_camera():
    points = room_points(30, 60, step_deg=(2.0, 6.0), top_deg=89.0, left_deg=180.0)
    assert up_of_camera(points, np.ones((30, 60), bool)) is None
    assert up_of_camera(room_points(), np.ones((9, 14), bool)) is None


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_frame_is_turned_by_quarters_until_up_is_z(axis, sign):
    up = np.full(3, 0.3)
    up[axis] = sign
    frame = frame_with_up(up)
    assert np.argmax(frame @ up) == 2
    assert np.linalg.det(frame) == 1 and set(np.abs(frame).ravel()) == {0, 1}


def test_points_that_tell_nothing_stay_as_stored():
    assert needed(np.ones((5, 5, 3))) == Turn(False, False, False, False)
    assert needed(np.zeros((5, 5, 3)), np.zeros((5, 5), bool)) == Turn(False, False, False, False)


@pytest.mark.parametrize("turn", TURNS)
def test_a_person_may_flip_a_scan(turn):
    points = room_points()
    color = np.random.default_rng(0).integers(0, 256, points.shape, np.uint8)
    valid = intensity_of(points) > 0.1
    pose = np.diag([1.0, -1, -1, 1])
    scan = Scan(name="a", points=points, reflectance=intensity_of(points), valid=valid, color=color, pose=pose)
    other = flipped(scan, vertical=bool(turn[0]), horizontal=bool(turn[1]))
    for key in ("points", "reflectance", "valid", "color", "range"):
        assert np.array_equal(getattr(other, key), getattr(scan, key)[TURNS[turn]])
    assert np.array_equal(other.pose, pose)
    assert flipped(other, vertical=bool(turn[0]), horizontal=bool(turn[1])).points == pytest.approx(scan.points)


@pytest.mark.parametrize("turn_deg", [90, 180, 270])
def test_a_person_may_turn_a_scan_clockwise(turn_deg):
    points = room_points()
    scan = Scan(name="a", points=points, reflectance=intensity_of(points), valid=points[..., 0] > 0)
    other = flipped(scan, turn_deg=turn_deg)
    corner = {90: (0, -1), 180: (-1, -1), 270: (-1, 0)}[turn_deg]
    np.testing.assert_array_equal(other.points[corner], scan.points[0, 0])
    np.testing.assert_array_equal(flipped(other, turn_deg=360 - turn_deg).points, scan.points)


def test_a_scan_without_color_may_be_flipped():
    points = room_points()
    scan = Scan(name="a", points=points, reflectance=intensity_of(points), valid=points[..., 0] > 0)
    assert flipped(scan, vertical=True).color is None
