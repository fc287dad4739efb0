"""Small colored scans for the tests of what is written."""

from dataclasses import replace

import numpy as np
from small_scans import random_scan

from reflcolor_addon.scan.scan import Scan
from reflcolor_addon.scan.surface import ScanSurface


def colored_wall(seed=5, shape=(8, 12), **changes):
    """A wall of random relief with a hole, a pixel that touches no face, and random colors: (scan, rgb, values)."""
    rng = np.random.default_rng(seed)
    scan = random_scan(seed, shape)
    valid = np.ones(shape, bool)
    valid[3, 4] = False
    # Alone in the corner: its neighbors have no return.
    valid[0, 1] = valid[1, 0] = valid[1, 1] = False
    scan = replace(scan, valid=valid, name="wall", **changes)
    values = {
        "confidence": rng.random(shape).astype(np.float32),
        "nearest_seed": rng.integers(-1, 7, shape).astype(np.int32),
    }
    return scan, rng.integers(0, 256, (*shape, 3), np.uint8), values


def colored_turn(shape=(6, 16)):
    """The inside of a cylinder all around the scanner: (scan, rgb)."""
    azimuth = np.pi / 2 - 2 * np.pi * (np.arange(shape[1]) + 0.5) / shape[1]
    height = np.linspace(1, -1, shape[0])
    points = np.empty((*shape, 3))
    points[..., 0], points[..., 1], points[..., 2] = 3 * np.cos(azimuth), 3 * np.sin(azimuth), height[:, None]
    rgb = np.random.default_rng(2).integers(0, 256, (*shape, 3), np.uint8)
    return Scan(name="drum", points=points, reflectance=np.ones(shape), valid=np.ones(shape, bool)), rgb


def surface_of(scan, rgb, values=None, **options):
    """The ScanSurface of a colored scan."""
    return ScanSurface(scan, rgb, values, **options)


def tilted_pose(translation=(12.5, -3.25, 1.75)):
    """A rigid pose, turned about no axis of the frame."""
    axis, angle = np.array([1.0, 2.0, 3.0]) / np.sqrt(14), 0.7
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    pose = np.eye(4)
    pose[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    pose[:3, 3] = translation
    return pose


def world_points(scan):
    """(N, 3) float64 world coordinates of the returns, in reading order."""
    return scan.points[scan.valid] @ scan.pose[:3, :3].T + scan.pose[:3, 3]
