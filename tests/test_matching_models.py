"""The models that put a scan's pixels into a photo."""

import numpy as np
import painted_room
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.matching.models import Camera, GridHomography, camera_axes

angles = st.floats(-80, 80)


@given(angles, angles, angles)
def test_camera_axes_are_a_rotation_that_looks_where_yaw_and_pitch_say(yaw, pitch, roll):
    axes = camera_axes(yaw, pitch, roll)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    forward = axes[2]
    assert np.degrees(np.arctan2(forward[0], forward[1])) == pytest.approx(yaw, abs=1e-6)
    assert np.degrees(np.arcsin(forward[2])) == pytest.approx(pitch, abs=1e-6)


def test_a_point_straight_ahead_falls_into_the_middle_at_its_distance():
    xy, depth = painted_room.camera(pitch_deg=0).project(np.array([0.0, 7.0, 0.0]))
    np.testing.assert_allclose(xy, [240, 180])
    assert depth == pytest.approx(7)


def test_right_and_up_are_right_and_up_in_the_photo():
    xy, _ = painted_room.camera(pitch_deg=0).project(np.array([1.0, 7.0, 1.0]))
    assert xy[0] > 240
    assert xy[1] < 180


def test_a_point_behind_the_camera_is_nowhere():
    xy, _ = painted_room.camera().project(np.array([0.0, -3.0, 0.0]))
    assert np.isnan(xy).all()


def test_candidates_seen_all_at_once_are_seen_as_one_by_one():
    camera = Camera(camera_axes(10, -5, 3), np.array([0.2, -0.1, 0.3]), 400.0, 0.05, 480, 360)
    points = np.random.default_rng(0).uniform([-1, 3, -1], [1, 6, 1], (20, 3))
    candidates = np.random.default_rng(1).normal(0, 1, (6, 8))
    together = camera.projections(candidates, points, 4.0)
    for row, candidate in zip(together, candidates, strict=True):
        np.testing.assert_allclose(row, camera.moved(candidate, 4.0).project(points)[0], atol=1e-9)


def test_the_candidate_of_zeros_changes_nothing():
    homography = GridHomography(np.array([[2.0, 0.1, 3], [0, 2, 5], [1e-4, 0, 1]]), (100, 200), 400, 300)
    places = np.random.default_rng(0).uniform(0, 100, (10, 2))
    np.testing.assert_allclose(
        homography.moved(np.zeros(8), 1.0).project(places)[0], homography.project(places)[0], rtol=1e-5
    )


def test_a_candidate_shifts_the_corners_of_the_grid_by_hundredths_of_its_longer_side():
    homography = GridHomography(np.eye(3), (100, 200), 400, 300)
    corners = np.array([[0.0, 0], [200, 0], [200, 100], [0, 100]])
    shifts = np.array([[1.0, -2], [3, 0.5], [-1, 4], [2, 2]])
    (together,) = homography.projections(shifts.reshape(1, 8), corners, 1.0)
    np.testing.assert_allclose(together, corners + 2 * shifts, atol=1e-9)
    np.testing.assert_array_equal(homography.moved(shifts.ravel(), 1.0).project(corners)[0], together)
