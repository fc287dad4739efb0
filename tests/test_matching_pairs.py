"""The camera from pairs picked by hand."""

import numpy as np
import painted_room
import pytest

from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.pairs import camera_from_pairs
from reflcolor_addon.matching.registration.refinement import HandPairs, fitted, tightened
from reflcolor_addon.matching.registration.tiles import Surfaces

PHOTO = PhotoImage("photo", np.zeros((360, 480, 3), np.uint8))
POINTS = np.array([
    [-2.0, 5.0, -1.0], [2.0, 5.0, 0.5], [0.6, 3.4, -0.2], [1.2, 3.4, -1.2], [-3.0, 4.0, 0.3], [-1.0, 3.0, -1.5],
    [0.5, 4.5, -1.5], [-0.5, 5.0, 1.0],
])  # fmt: skip


@pytest.fixture
def camera():
    return painted_room.camera((0.9, 0.3, 0.2), yaw_deg=-9, pitch_deg=-7, roll_deg=2, focal=1.1)


@pytest.mark.parametrize("count", [6, 7, 8])
def test_exact_pairs_give_back_where_the_photo_was_taken(camera, count):
    found, error, left_out = camera_from_pairs(POINTS[:count], camera.project(POINTS[:count])[0], PHOTO)
    assert error < 0.002
    assert len(left_out) == 0
    np.testing.assert_allclose(found.project(POINTS)[0], camera.project(POINTS)[0], atol=4)


def test_four_pairs_place_a_photo_of_usual_focal_length(camera):
    found, error, _ = camera_from_pairs(POINTS[:4], camera.project(POINTS[:4])[0], PHOTO)
    assert found is not None
    assert error < 0.02


def test_of_two_cameras_that_see_four_pairs_alike_the_one_on_the_scanners_side_is_taken():
    # Three points on a far wall and one near: seen from behind the wall they lie nearly the same.
    points = np.array([[0.26, 1.8, -0.06], [0.62, 1.78, -0.11], [-0.15, 1.75, 0.01], [-0.03, 0.29, -0.11]])
    photo = PhotoImage("photo", np.zeros((720, 1280, 3), np.uint8))
    xy = np.array([[703.0, 416], [833, 434], [504, 395], [472, 645]])
    found, _, _ = camera_from_pairs(points, xy, photo)
    assert found.center[1] < 0


def test_pairs_clicked_two_pixels_off_do_as_well(camera):
    xy = camera.project(POINTS)[0] + np.random.default_rng(3).normal(0, 2, (len(POINTS), 2))
    found, _, _ = camera_from_pairs(POINTS, xy, PHOTO)
    np.testing.assert_allclose(found.project(POINTS)[0], camera.project(POINTS)[0], atol=10)


def test_one_slip_among_eight_is_found_and_left_out(camera):
    xy = camera.project(POINTS)[0]
    xy[3] += [120, -90]
    found, _, left_out = camera_from_pairs(POINTS, xy, PHOTO)
    assert left_out.tolist() == [3]
    np.testing.assert_allclose(found.project(POINTS)[0][:3], xy[:3], atol=4)


def test_three_pairs_are_too_few(camera):
    assert camera_from_pairs(POINTS[:3], camera.project(POINTS[:3])[0], PHOTO)[0] is None


@pytest.mark.slow
def test_pairs_that_no_camera_sees_so_are_refused():
    xy = np.random.default_rng(0).uniform(0, 360, (len(POINTS), 2))
    assert camera_from_pairs(POINTS, xy, PHOTO)[0] is None


def test_pairs_hold_a_camera_that_the_tiles_lead_away(camera):
    # A hundred tiles that all would have the photo moved by five pixels to the right; the pairs are a pixel off.
    rng = np.random.default_rng(0)
    points = rng.uniform([-2, 4, -1], [2, 6, 1], (100, 3))
    shift = np.arange(17) - 8.0
    peak = np.exp(-((shift[:, None]) ** 2 + (shift[None] - 5) ** 2) / 8)
    scores = np.repeat(((peak - peak.mean()) / peak.std()).astype(np.float32)[None], 100, axis=0)
    places, inverse = camera.project(points)[0], np.array([np.eye(2)] * 100)
    found = Surfaces(scores, points, places, inverse, np.zeros((100, 2), int), 5.0)
    pairs = HandPairs(POINTS, camera.project(POINTS)[0] + rng.normal(0, 1, (len(POINTS), 2)), 0.3)
    moved = {}
    for name, held in (("free", None), ("held", pairs)):
        fit, _ = fitted(found, camera, camera.POSE, blur=1.0, spread=0.5, rng=np.random.default_rng(0), pairs=held)
        moved[name] = np.abs((tightened(found, fit, fit.POSE, held).project(points)[0] - places)[:, 0]).mean()
    assert moved["free"] > 4
    assert moved["held"] < 2
