"""What a photo is held against must not depend on where the scanner got no return."""

from dataclasses import replace

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon import Scan
from reflcolor_addon.matching.grid_angles import GridAngles, closed
from reflcolor_addon.matching.models import GridHomography
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.fitting import beside, finely
from reflcolor_addon.matching.registration.registration import ScanViews
from reflcolor_addon.matching.registration.tiles import Sighting, Tiles, surfaces
from reflcolor_addon.matching.registration.verification import by_chance, evidence
from reflcolor_addon.matching.scan_image import ScanImage, reflectance_image


@pytest.fixture(scope="module")
def room():
    return painted_room.scan(rows=100, columns=150, step_deg=0.4)


@pytest.fixture(scope="module")
def camera():
    return painted_room.camera(yaw_deg=5)


@pytest.fixture(scope="module")
def noise():
    grain = np.random.default_rng(1).standard_normal((360, 480, 3)).astype(np.float32)
    blurred = cv2.GaussianBlur(grain, (0, 0), 6)
    return PhotoImage("noise", np.clip(128 + 64 * blurred / blurred.std(), 0, 255).astype(np.uint8))


def with_holes(scan, share, seed=0):
    return replace(scan, valid=scan.valid & (np.random.default_rng(seed).random(scan.shape) >= share))


def image_of(scan):
    return ScanImage(scan, reflectance_image(scan, "ranks"), 0.4)


def test_the_edges_of_a_photo_are_the_same_with_holes_in_the_scan_and_without(room, camera, noise):
    whole = Sighting.of(image_of(room), noise, camera)
    holed = Sighting.of(image_of(with_holes(room, 0.15)), noise, camera)
    both = (whole.seen & holed.seen) | ~room.valid
    assert both.mean() > 0.3
    np.testing.assert_allclose(holed.features[both], whole.features[both], atol=1e-3)


def test_a_blurred_photo_makes_no_edges_where_the_range_jumps(room, noise):
    # From aside the front of the box and the wall beside it show parts of the photo that lie far apart.
    image = image_of(room)
    seen = Sighting.of(image, noise, painted_room.camera((0.8, 0.0, 0.0)))
    jump = np.abs(np.gradient(np.log(np.maximum(seen.range, 0.1)), axis=1)) > 0.1
    strength = seen.features[..., 0][seen.seen]
    at_jumps = seen.features[..., 0][seen.seen & jump]
    assert len(at_jumps) > 50
    assert at_jumps.mean() < strength.mean() + 0.3 * strength.std()


def test_holes_in_a_scan_are_no_evidence_for_noise(room, camera, noise):
    image = image_of(with_holes(room, 0.12))
    found = surfaces(image, Tiles.of(image, 40), noise, camera, 8)
    assert abs(found.scores[:, 8, 8].mean()) < 0.4
    assert not evidence(image, noise, camera).accepted


def test_a_tile_scores_highest_where_its_own_piece_was_moved_to(room, camera, noise):
    image = image_of(room)
    seen = Sighting.of(image, noise, camera)
    moved = replace(seen, features=np.roll(seen.own, (3, -2), (0, 1)))
    found = surfaces(image, Tiles.of(image, 40), None, camera, 8, moved)
    best = found.scores.reshape(len(found.scores), -1).argmax(axis=1)
    row, col = np.divmod(best, 17)
    inner = (found.middles > 24).all(axis=1) & (found.middles < np.array(image.shape) - 24).all(axis=1)
    assert inner.sum() >= 6
    np.testing.assert_array_equal(np.column_stack([row, col])[inner], np.broadcast_to([11, 6], (inner.sum(), 2)))


def test_an_isolated_hole_is_closed_by_its_neighbors(room):
    valid = room.valid.copy()
    valid[50, 60] = False
    valid[30, 20:60] = False
    valid[70:76, 100:106] = False
    mended = closed(replace(room, valid=valid))
    around = room.reflectance[49:52, 59:62]
    assert mended.reflectance[50, 60] == pytest.approx((around.sum() - around[1, 1]) / 8, rel=1e-5)
    np.testing.assert_allclose(mended.points[50, 60], room.points[50, 60], atol=0.03)
    assert mended.valid[30].all()
    assert not mended.valid[72:74, 102:104].any()


def test_a_scan_without_isolated_holes_stays_the_same(room):
    assert closed(room) is room


def test_directions_without_a_return_are_those_of_their_row_and_column(room):
    holed = with_holes(room, 0.3)
    angles = GridAngles.of(replace(holed, points=np.where(holed.valid[..., None], room.points, 0)))
    directions = angles.at(np.arange(room.shape[0]), np.arange(room.shape[1]))
    true = room.points / room.range[..., None]
    assert np.abs(directions - true).max() < np.radians(0.02)


def test_rows_are_drawn_where_they_look():
    # 0.4 degrees apart in the middle, 1.6 at the ends.
    steps = np.concatenate([np.full(20, 1.6), np.full(60, 0.4), np.full(20, 1.6)])
    elevation = np.radians(40 - np.cumsum(steps))[:, None]
    azimuth = np.radians(np.linspace(-30, 30, 150))[None]
    rays = [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation) + 0 * azimuth]
    points = 5 * np.stack(rays, axis=-1)
    scan = Scan(name="uneven", points=points, reflectance=np.ones((100, 150)), valid=np.ones((100, 150), bool))
    assert GridAngles.of(scan).uneven
    image = image_of(scan)
    measured = np.degrees(np.arcsin(image.directions[..., 2]))
    np.testing.assert_allclose(np.diff(measured[:, 0]), -image.step_deg, atol=0.02)


def test_a_photo_gives_the_same_edges_at_any_size(room, camera):
    own = painted_room.photo(camera)
    features = []
    for factor in (1, 2.5, 5):
        rgb = cv2.resize(own, None, fx=factor, fy=factor, interpolation=cv2.INTER_CUBIC)
        height, width = rgb.shape[:2]
        model = replace(camera, width=width, height=height, focal_px=camera.focal_px * width / camera.width)
        features.append(Sighting.of(image_of(room), PhotoImage("photo", rgb), model).features)
    for other in features[1:]:
        assert np.corrcoef(features[0].ravel(), other.ravel())[0, 1] > 0.97


@pytest.mark.parametrize("kind", ["pose", "homography"])
def test_what_a_pixel_moves_a_place_is_the_derivative_of_the_projection(camera, kind):
    if kind == "pose":
        model, sites = replace(camera, distortion=0.1), np.array([[0.3, 4.0, 0.2], [-1.0, 3.0, -0.5]])
    else:
        model = GridHomography(np.array([[2.0, 0.1, 3], [0, 2, 5], [1e-4, 0, 1]]), (100, 200), 400, 300)
        sites = np.array([[20.0, 30], [150, 60]])
    turns = 1e-6 * np.random.default_rng(0).standard_normal((2, *sites.shape))
    moved = np.stack([model.project(sites + turn)[0] - model.project(sites)[0] for turn in turns], axis=-1)
    np.testing.assert_allclose(model.seen(sites, turns)[2], moved, rtol=1e-3, atol=1e-9)


def test_a_right_camera_stands_out_from_the_photos_parts_exchanged(room, camera):
    image, photo = image_of(room), PhotoImage("photo", painted_room.photo(camera))
    chance = by_chance(image, Sighting.of(image, photo, camera), camera)
    assert len(chance) == 8
    assert evidence(image, photo, camera).strength > 3 * chance.max()


@pytest.mark.slow
def test_a_camera_off_by_one_patch_of_a_pattern_moves_to_where_more_agrees(room, camera):
    views, photo = ScanViews(room), PhotoImage("photo", painted_room.photo(camera))
    rng = np.random.default_rng(0)
    off_by_one = replace(camera, center=camera.center - [painted_room.PATCH_M, 0, 0])
    wrong, proof = finely(views, photo, off_by_one, rng)
    assert proof.accepted and abs(wrong.center[0] - camera.center[0]) > 0.2
    found, _ = beside(views, photo, wrong, proof)
    np.testing.assert_allclose(found.center, camera.center, atol=0.1)
