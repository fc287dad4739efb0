"""Transfer of colors, and several photos of one site."""

from dataclasses import replace

import numpy as np
import painted_room
import pytest

from reflcolor_addon.matching.photo_image import PhotoImage, visible
from reflcolor_addon.matching.published.hog_matching import square_image
from reflcolor_addon.matching.scan_image import toned
from reflcolor_addon.matching.transfer.several_photos import blended, gains
from reflcolor_addon.matching.transfer.views import seen_by


@pytest.fixture(scope="module")
def room():
    return painted_room.scan()


@pytest.fixture(scope="module")
def image(room):
    return square_image(room, toned(room, "percentiles"))


def view(image, camera, gain=1.0):
    return seen_by(PhotoImage("photo", painted_room.photo(camera, gain=gain)), camera, image)


def true_colors(room, image):
    return room.color[np.ix_(image.rows, image.cols)].astype(float)


def test_what_a_camera_beside_the_scanner_saw_has_its_true_color(room, image):
    seen = view(image, painted_room.camera((1.2, 0.4, 0.3), yaw_deg=-10))
    assert seen.usable.mean() > 0.3
    error = np.abs(seen.rgb - true_colors(room, image)).max(axis=-1)[seen.usable]
    # Off by much only at the borders between patches.
    assert np.median(error) <= 2
    assert (error < 40).mean() > 0.85


def test_what_the_box_hides_from_the_camera_gets_no_color(room, image):
    camera = painted_room.camera((-1.8, 1.0, 0.0), yaw_deg=35)
    seen = view(image, camera)
    # Points behind the box, seen from the camera: the way to them passes its front.
    behind = image.valid & (image.points[..., 1] > 4.99)
    share = (3.4 - camera.center[1]) / (image.points[..., 1] - camera.center[1] + 1e-9)
    x = camera.center[0] + share * (image.points[..., 0] - camera.center[0])
    z = camera.center[2] + share * (image.points[..., 2] - camera.center[2])
    hidden = behind & (x > 0.5) & (x < 1.3) & (z < 0.0)
    assert hidden.sum() > 50
    assert seen.usable[hidden].mean() < 0.05


def test_what_lies_behind_a_pane_of_glass_is_not_seen(room):
    # A window in the back wall, without a return, and beside it pixels of what a camera would see through it.
    camera = painted_room.camera((-1.0, 1.0, 0.0), yaw_deg=0)
    wall = room.valid & (room.points[..., 1] > 4.99)
    rows, cols = (np.arange(length) for length in room.shape)
    window = wall & (np.abs(rows - 50) < 8)[:, None] & (np.abs(cols - 80) < 10)
    beyond = wall & (np.abs(rows - 50) < 4)[:, None] & (np.abs(cols - 120) < 6)
    assert window.sum() > 200 and beyond.sum() > 50
    points = room.points.copy()
    pane = room.points[window].mean(axis=0)
    points[beyond] = camera.center + 1.4 * (pane - camera.center) + 0.1 * (points[beyond] - points[beyond].mean(axis=0))
    scan = replace(room, points=points, valid=room.valid & ~window)
    image = square_image(scan, toned(scan, "percentiles"))
    np.testing.assert_allclose(image.panes.mean(axis=0), pane, atol=0.05)
    np.testing.assert_allclose(image.panes[:, 1], 5.0, atol=0.05)
    xy, depth = camera.project(image.points)
    seen, through = (visible(camera, image.valid, xy, depth, panes=panes) for panes in (image.panes, None))
    chosen = beyond[np.ix_(image.rows, image.cols)]
    assert through[chosen].mean() > 0.9
    assert seen[chosen].mean() < 0.05
    assert seen[wall[np.ix_(image.rows, image.cols)] & image.valid & ~chosen].mean() > 0.6


def test_seeds_keep_a_margin_to_jump_edges(image):
    seen = view(image, painted_room.camera())
    jump = np.abs(np.diff(image.range, axis=1)) > 0.5
    jump &= image.valid[:, 1:] & image.valid[:, :-1]
    assert jump.any()
    assert not seen.usable[:, 1:][jump].any()


def test_a_darker_photo_is_brought_to_the_brightness_of_the_other(image):
    views = [view(image, painted_room.camera()), view(image, painted_room.camera((0.6, 0, 0)), gain=0.7)]
    factors = gains([views])
    assert (factors[1] / factors[0] > 1.5).all()
    np.testing.assert_allclose(np.log(factors).sum(axis=0), 0, atol=1e-6)
    first, second = (
        blended([one if k == index else None for k, one in enumerate(views)], factors)[0] for index in (0, 1)
    )
    both = views[0].usable & views[1].usable
    assert np.median(np.abs(first[both].astype(int) - second[both])) <= 4


def test_photos_that_do_not_overlap_keep_their_exposure(image):
    seen = view(image, painted_room.camera())
    assert (gains([[seen, None]]) == 1).all()


def test_photos_that_do_not_show_the_same_where_they_overlap_keep_their_exposure(image):
    camera = painted_room.camera()
    other = seen_by(PhotoImage("other", painted_room.photo(camera, seed=1, gain=0.6)), camera, image)
    assert (gains([[view(image, camera), other]]) == 1).all()
