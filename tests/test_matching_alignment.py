"""A model that was accepted, fitted once more at the scan's own detail."""

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.alignment import Alignment


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
