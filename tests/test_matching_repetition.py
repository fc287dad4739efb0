"""A photo that would fit elsewhere as well, since what it shows repeats itself, proves nothing."""

import numpy as np
import pytest

from reflcolor_addon import Scan
from reflcolor_addon.matching.models import Camera, camera_axes
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.repetition import alone
from reflcolor_addon.matching.registration.verification import evidence
from reflcolor_addon.matching.scan_image import ScanImage, reflectance_image

WIDTH_M, HEIGHT_M, DISTANCE_M = 6.0, 4.0, 4.0
SQUARES = (np.arange(0.3, WIDTH_M, 0.3), np.arange(0.3, HEIGHT_M, 0.3))
CAMERA = Camera(camera_axes(3, 1, 0), np.zeros(3), 400.0, 0.0, 480, 360)


def patches(seed):
    """Where the patches of a wall end that are of many sizes."""
    sizes = [np.random.default_rng((seed, axis)).uniform(0.1, 0.6, 16) for axis in (0, 1)]
    ends = zip(sizes, (WIDTH_M, HEIGHT_M), strict=True)
    return tuple(np.cumsum(own)[:-1] * length / own.sum() for own, length in ends)


def wall(rays, cuts, seed):
    """Points, and paint of four tones at random, of a wall before the scanner that rays (..., 3) hit."""
    points = rays * (DISTANCE_M / rays[..., 1])[..., None]
    column = np.searchsorted(cuts[0], points[..., 0] + WIDTH_M / 2)
    row = np.searchsorted(cuts[1], points[..., 2] + HEIGHT_M / 2)
    return points, np.random.default_rng(seed).random((64, 64, 4))[row, column]


def scanned(cuts):
    azimuth, elevation = np.radians(np.meshgrid(np.linspace(-30, 30, 150), np.linspace(22, -22, 110)))
    level = np.cos(elevation)
    rays = np.stack([np.sin(azimuth) * level, np.cos(azimuth) * level, np.sin(elevation)], axis=-1)
    points, paint = wall(rays, cuts, 0)
    return Scan(name="wall", points=points, reflectance=paint[..., 3], valid=np.ones(points.shape[:2], bool))


def photographed(cuts, seed):
    x, y = np.meshgrid(np.arange(CAMERA.width) - CAMERA.width / 2, np.arange(CAMERA.height) - CAMERA.height / 2)
    rays = np.stack([x + 0.5, y + 0.5, np.full(x.shape, CAMERA.focal_px)], axis=-1) @ CAMERA.rotation
    return PhotoImage("photo", np.uint8(40 + 200 * wall(rays, cuts, seed)[1][..., :3]))


def proof_of(cuts, seed):
    """The evidence before and after it is asked what else would fit."""
    scan, photo = scanned(cuts), photographed(cuts, seed)
    image = ScanImage(scan, reflectance_image(scan, "ranks"), 0.25)
    proof = evidence(image, photo, CAMERA)
    return proof, alone(proof, image, photo, CAMERA)


@pytest.mark.parametrize("seed", [0, 1])
def test_squares_that_lie_on_squares_prove_nothing(seed):
    before, after = proof_of(SQUARES, seed)
    assert before.accepted and before.in_place > 0.8 * before.tiles
    assert after.held < 0.5 and after.elsewhere > 0.7
    assert not after.accepted
    assert "elsewhere" in str(after.said)


def test_patches_of_many_sizes_that_lie_on_their_own_prove_the_camera():
    before, after = proof_of(patches(1), 1)
    assert before.accepted and after.accepted
    assert after.held > 0.6 and after.elsewhere == 0
