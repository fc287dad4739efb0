"""A model that was accepted, fitted once more at the scan's own detail."""

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon.matching.models import GridHomography
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration import registration
from reflcolor_addon.matching.registration.alignment import Alignment
from reflcolor_addon.matching.registration.registration import Registration, ScanViews
from reflcolor_addon.matching.registration.verification import evidence


@pytest.fixture(scope="module")
def room():
    return painted_room.scan(rows=100, columns=150, step_deg=0.4)


def test_a_picture_of_the_scan_that_was_warped_is_placed_by_a_homography(room):
    height, width = room.shape
    corners = np.float32([[0, 0], [width, 0], [width, height], [0, height]])
    moved = np.float32([[0.06, 0.03], [0.97, 0.0], [1.0, 0.97], [0.0, 0.93]]) * np.float32([width, height]) * 2
    matrix = cv2.getPerspectiveTransform(corners, moved)
    picture = cv2.warpPerspective(room.color, matrix, (2 * width, 2 * height))
    camera = painted_room.camera(pitch_deg=-4, focal=0.86, width=2 * width, height=2 * height)
    found = Alignment(room).aligned(PhotoImage("picture", picture), camera)
    assert found.kind == "homography"
    rows, cols = np.nonzero(room.valid)
    expected = cv2.perspectiveTransform(np.float32(np.column_stack([cols + 0.5, rows + 0.5]))[None], matrix)[0]
    off = np.linalg.norm(found.project(found.sites_of(room, rows, cols))[0] - expected, axis=1)
    assert np.quantile(off, 0.9) < 2


def test_a_photo_from_aside_keeps_its_camera(room):
    camera = painted_room.camera((0.9, 0.3, 0.2), yaw_deg=-5)
    found = Alignment(room).aligned(PhotoImage("photo", painted_room.photo(camera)), camera)
    assert found.kind == "pose"
    points = room.points[room.valid]
    off = np.linalg.norm(found.project(points)[0] - camera.project(points)[0], axis=1)
    assert np.nanmedian(off) < 1


def test_a_homography_that_is_off_by_some_pixels_is_right_once_fitted_again(room):
    height, width = room.shape
    views, photo = ScanViews(room), PhotoImage("picture", cv2.resize(room.color, (2 * width, 2 * height)))
    off_by_some = GridHomography(
        np.array([[2.04, 0, 3], [0.02, 1.97, 4], [0, 0, 1]]), room.shape, photo.width, photo.height
    )
    rough = Registration(off_by_some, evidence(views.image(0.5), photo, off_by_some), "features")
    assert not rough.clear
    found = registration._again(views, photo, rough, np.random.default_rng(0))
    assert found.clear and found.better_than(rough)
    grid = np.array([[20.0, 20], [width - 20, 20], [width - 20, height - 20], [20, height - 20]])
    assert np.abs(found.model.project(grid)[0] - 2 * grid).max() < 2
