"""A small room painted in random patches, seen exactly: by a scanner, and by cameras anywhere."""

import numpy as np

from reflcolor_addon.matching.models import Camera, camera_axes
from reflcolor_addon.scan.scan import Scan

# Wall, left wall, floor, front and side of a box: a point on each, and two directions along it with their lengths.
_PANELS = (
    ((-3.0, 5.0, -1.5), (6.0, 0.0, 0.0), (0.0, 0.0, 4.0)),
    ((-3.0, 0.0, -1.5), (0.0, 5.0, 0.0), (0.0, 0.0, 4.0)),
    ((-3.0, 0.0, -1.5), (6.0, 0.0, 0.0), (0.0, 5.0, 0.0)),
    ((0.4, 3.4, -1.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.6)),
    ((0.4, 3.4, -1.5), (0.0, 1.0, 0.0), (0.0, 0.0, 1.6)),
)
PATCH_M = 0.3


def hits(origins, rays, seed=0):
    """Where rays (..., 3) hit the room: points (NaN where they miss), sRGB (..., 3) uint8, reflectance."""
    nearest = np.full(rays.shape[:-1], np.inf)
    rgb, reflectance = np.zeros((*rays.shape[:-1], 3), np.uint8), np.zeros(rays.shape[:-1])
    for panel, (corner, first, second) in enumerate(_PANELS):
        corner, first, second = (np.array(v) for v in (corner, first, second))
        normal = np.cross(first, second)
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = ((corner - origins) * normal).sum(-1) / (rays * normal).sum(-1)
            place = origins + distance[..., None] * rays - corner
            along = [(place * side).sum(-1) / np.linalg.norm(side) for side in (first, second)]
        inside = (distance > 1e-6) & (distance < nearest)
        for length, side in zip(along, (first, second), strict=True):
            inside &= (length >= 0) & (length <= np.linalg.norm(side))
        # Which patch, and its random paint: the infrared reflectance has nothing to do with the color.
        paint = np.random.default_rng((seed, panel)).random((32, 32, 4))
        cell = [np.clip(np.nan_to_num(length) / PATCH_M, 0, 31).astype(int) for length in along]
        rgb[inside] = (40 + 200 * paint[cell[0], cell[1], :3][inside]).astype(np.uint8)
        reflectance[inside] = paint[cell[0], cell[1], 3][inside]
        nearest = np.where(inside, distance, nearest)
    points = np.where(
        np.isfinite(nearest)[..., None], origins + np.where(np.isfinite(nearest), nearest, 0)[..., None] * rays, np.nan
    )
    return points, rgb, reflectance


def scan(rows=150, columns=220, step_deg=0.3, seed=0, name="room", center=(0.0, 0.0, 0.0), yaw_deg=0.0):
    """The room as a scanner measures it that stands at ``center``, turned to the left; ``color`` is the truth."""
    azimuth = np.radians((np.arange(columns) - (columns - 1) / 2) * step_deg)
    elevation = np.radians(((rows - 1) / 2 - np.arange(rows)) * step_deg - 4)
    azimuth, elevation = np.meshgrid(azimuth, elevation)
    rays = np.stack([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1)
    cosine, sine = np.cos(np.radians(yaw_deg)), np.sin(np.radians(yaw_deg))
    pose = np.eye(4)
    pose[:2, :2], pose[:3, 3] = [[cosine, -sine], [sine, cosine]], center
    points, rgb, reflectance = hits(pose[:3, 3], rays @ pose[:3, :3].T, seed)
    valid = np.isfinite(points).all(axis=-1)
    grain = np.random.default_rng(seed).normal(0, 0.02, valid.shape)
    return Scan(
        name=name,
        points=np.nan_to_num((points - pose[:3, 3]) @ pose[:3, :3]),
        reflectance=np.where(valid, reflectance + grain, 0),
        valid=valid,
        color=rgb,
        pose=pose,
    )


def camera(center=(0.0, 0.0, 0.0), yaw_deg=0.0, pitch_deg=-4.0, roll_deg=0.0, focal=0.9, width=480, height=360):
    """A camera in the room."""
    rotation = camera_axes(yaw_deg, pitch_deg, roll_deg)
    return Camera(rotation, np.array(center, float), focal * max(width, height), 0.0, width, height)


def photo(own, seed=0, gain=1.0):
    """What a camera sees of the room, (H, W, 3) uint8."""
    x, y = np.meshgrid(np.arange(own.width) + 0.5 - own.width / 2, np.arange(own.height) + 0.5 - own.height / 2)
    rays = np.stack([x, y, np.full(x.shape, own.focal_px)], axis=-1) @ own.rotation
    _, rgb, _ = hits(own.center, rays / np.linalg.norm(rays, axis=-1, keepdims=True), seed)
    return np.clip(rgb * gain, 0, 255).astype(np.uint8)
