"""Small scans for tests, made of numbers."""

import numpy as np

from reflcolor_addon.scan.scan import Scan


def scan_from_ranges(ranges, reflectance, valid=None, *, name="small", azimuth_deg=60.0, elevation_deg=40.0):
    """A scan on a regular grid of directions, columns from left to right, that covers these angles.

    With ``azimuth_deg=360`` its left and right edge are neighbors.
    """
    ranges = np.asarray(ranges, np.float64)
    height, width = ranges.shape
    azimuth = np.radians(azimuth_deg) * (0.5 - (np.arange(width) + 0.5) / width)
    elevation = np.radians(elevation_deg) * (0.5 - (np.arange(height)[:, None] + 0.5) / height)
    x, y = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    directions = np.stack([x, y, np.broadcast_to(np.sin(elevation), x.shape)], axis=-1)
    valid = np.ones(ranges.shape, bool) if valid is None else np.asarray(valid, bool)
    return Scan(name=name, points=directions * ranges[..., None], reflectance=reflectance, valid=valid)


def random_scan(seed=0, shape=(6, 10), **options):
    """A scan of random ranges from 2 to 4 m and reflectances from 0 to 1, every pixel with a return."""
    rng = np.random.default_rng(seed)
    return scan_from_ranges(rng.uniform(2, 4, shape), rng.random(shape), **options)
