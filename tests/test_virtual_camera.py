"""The virtual camera against points whose pictures are known."""

import json

import numpy as np
import pytest

from reflcolor_addon.simulation.virtual_camera import VirtualCamera, look_at
from reflcolor_addon.srgb import linear_to_srgb8, srgb8_to_linear


def test_the_target_falls_into_the_middle_of_the_picture():
    camera = VirtualCamera(width=400, height=300, focal_px=350.0, pose=look_at((1, -2, 1.5), (0.3, 4, 0.2)))
    xy, depth = camera.project([0.3, 4, 0.2])
    assert xy == pytest.approx([200, 150])
    assert depth == pytest.approx(np.linalg.norm([0.7, 6, 1.3]))


def test_up_is_up_and_right_is_right():
    camera = VirtualCamera(width=400, height=300, focal_px=350.0, pose=look_at((0, 0, 0), (0, 1, 0)))
    xy, _ = camera.project([[0.1, 2, 0], [0, 2, 0.1]])
    assert xy == pytest.approx(np.array([[217.5, 150], [200, 132.5]]))


def test_a_point_behind_the_camera_has_no_place():
    camera = VirtualCamera(width=400, height=300, focal_px=350.0, pose=look_at((0, 0, 0), (0, 1, 0)))
    xy, depth = camera.project([0, -1, 0])
    assert np.isnan(xy).all()
    assert depth < 0


def test_undistorted_pixels_are_the_inverse_of_the_distortion():
    camera = VirtualCamera(width=40, height=30, focal_px=35.0, distortion=(-0.12, 0.03))
    rays = (camera.undistorted_pixels() - [20, 15]) / 35.0
    xy, _ = camera.project(np.dstack([rays, np.ones(rays.shape[:2])]))
    y, x = np.mgrid[:30, :40] + 0.5
    assert xy == pytest.approx(np.stack([x, y], axis=-1), abs=1e-6)


@pytest.mark.parametrize("distortion", [(0.0, 0.0), (-0.1, 0.02), (0.08, 0.0)])
def test_distorting_a_picture_moves_what_it_shows_to_where_points_project(distortion):
    camera = VirtualCamera(width=60, height=40, focal_px=50.0, distortion=distortion)
    margin = camera.margin_px()
    y, x = np.mgrid[-margin : 40 + margin, -margin : 60 + margin] + 0.5
    bent = camera.distort(np.dstack([x, y]), margin)
    rays = np.dstack([(bent - [30, 20]) / 50.0, np.ones((40, 60))])
    rows, columns = np.mgrid[:40, :60] + 0.5
    assert camera.project(rays)[0] == pytest.approx(np.stack([columns, rows], axis=-1), abs=1e-6)


def test_a_described_camera_projects_as_before():
    camera = VirtualCamera(
        width=40, height=30, focal_px=35.5, pose=look_at((1, 2, 3), (4, 8, 2)), distortion=(-0.1, 0.02)
    )
    again = VirtualCamera.from_dict(json.loads(json.dumps(camera.as_dict())))
    assert np.array_equal(again.project([[4, 7, 2], [5, 9, 1]])[0], camera.project([[4, 7, 2], [5, 9, 1]])[0])


def test_exposure_and_white_balance_multiply_light():
    light = np.full((2, 2, 3), 0.1)
    camera = VirtualCamera(width=2, height=2, focal_px=2.0, exposure_stops=1.0, white_balance=(1.0, 2.0, 0.5))
    assert np.array_equal(camera.develop(light)[0, 0], linear_to_srgb8([0.2, 0.4, 0.1]))


def test_noise_is_the_same_for_the_same_seed():
    light = np.full((8, 8, 3), 0.3)
    photos = [VirtualCamera(width=8, height=8, focal_px=8.0, noise=0.05, seed=s).develop(light) for s in (1, 1, 2)]
    assert np.array_equal(photos[0], photos[1])
    assert not np.array_equal(photos[0], photos[2])


def test_decoding_undoes_encoding():
    values = np.arange(256, dtype=np.uint8)
    assert np.array_equal(linear_to_srgb8(srgb8_to_linear(values)), values)


def test_srgb_encoding_has_its_known_values():
    assert linear_to_srgb8([[0, 1, 2], [0.0031308, 0.21404114, -1]]).tolist() == [[0, 255, 255], [10, 127, 0]]
