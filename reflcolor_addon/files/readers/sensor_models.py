"""From range images to points: what each pixel looks at, in the scanner's frame (Z up, looking along +Y, X right)."""

from dataclasses import dataclass

import numpy as np

DEPTH, RAY = "depth", "ray"

_ROUNDS = 50
_SOLVED = 1e-5
"""A hundredth of a pixel, in focal lengths."""


@dataclass(frozen=True, kw_only=True)
class Pinhole:
    """A camera: focal lengths and center in pixels, pixel centers at whole numbers, the first at 0, 0.

    X = (column - cx) / fx * d, Y = d, Z = -(row - cy) / fy * d, with d the depth along the viewing axis.

    Parameters
    ----------
    fx, fy, cx, cy : float
    distortion : tuple of float, optional
        Of the lens, as OpenCV calibrates it: k1, k2, p1, p2[, k3[, k4, k5, k6]].
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()

    default_range_type = DEPTH
    mirrored = (False, False)

    def points(self, distance, range_type):
        """(H, W, 3) float64 of (H, W) distances: depths along the axis, or lengths of the rays."""
        rows, columns = np.indices(distance.shape, sparse=True)
        right, down = (columns - self.cx) / self.fx, (rows - self.cy) / self.fy
        if any(self.distortion):
            right, down = _undistorted(right, down, self.distortion)
        depth = distance / np.sqrt(1 + right**2 + down**2) if range_type == RAY else distance
        return np.stack([right * depth, depth, -down * depth], axis=-1)


@dataclass(frozen=True, kw_only=True)
class Spherical:
    """A panorama: limits are the outer edges of the image, pixel centers lie half a step inside.

    Parameters
    ----------
    azimuth_deg : (left, right) of float
        From +Y to the right.
    elevation_deg : (bottom, top) of float
        Up.
    """

    azimuth_deg: tuple[float, float]
    elevation_deg: tuple[float, float]

    default_range_type = RAY

    @property
    def mirrored(self):
        """(vertical, horizontal): True where the limits say that the image is stored upside down, or mirrored."""
        return self.elevation_deg[1] < self.elevation_deg[0], self.azimuth_deg[1] < self.azimuth_deg[0]

    def points(self, distance, range_type):
        """(H, W, 3) float64 of (H, W) lengths of the rays."""
        height, width = distance.shape
        azimuth = _centers(*self.azimuth_deg, width)
        elevation = _centers(*self.elevation_deg[::-1], height)[:, None]
        level = distance * np.cos(elevation)
        return np.stack(
            [level * np.sin(azimuth), level * np.cos(azimuth), distance * np.sin(elevation)],
            axis=-1,
        )


@dataclass(frozen=True, kw_only=True)
class Beams:
    """A spinning lidar: every row is a beam with an elevation of its own, and an azimuth that it is set off by.

    Parameters
    ----------
    azimuth_deg : (left, right) of float
        Outer edges of the image, from +Y to the right, as `Spherical` has them.
    elevation_deg : tuple of float
        Up, one for each row.
    azimuth_offset_deg : tuple of float
        To the right, one for each row; none where empty.
    """

    azimuth_deg: tuple[float, float]
    elevation_deg: tuple[float, ...]
    azimuth_offset_deg: tuple[float, ...] = ()

    default_range_type = RAY

    @property
    def mirrored(self):
        """(vertical, horizontal): True where the angles say that the image is stored upside down, or mirrored."""
        return self.elevation_deg[-1] > self.elevation_deg[0], self.azimuth_deg[1] < self.azimuth_deg[0]

    def points(self, distance, range_type):
        """(H, W, 3) float64 of (H, W) lengths of the rays; ValueError where H is not the number of beams."""
        height, width = distance.shape
        if height != len(self.elevation_deg):
            raise ValueError(len(self.elevation_deg))
        offset = np.radians(self.azimuth_offset_deg or np.zeros(height))[:, None]
        azimuth = _centers(*self.azimuth_deg, width) + offset
        elevation = np.radians(self.elevation_deg)[:, None]
        level = distance * np.cos(elevation)
        height_above = np.broadcast_to(distance * np.sin(elevation), distance.shape)
        return np.stack([level * np.sin(azimuth), level * np.cos(azimuth), height_above], axis=-1)


def _undistorted(x_seen, y_seen, coefficients: tuple[float, ...]):
    """Solve the lens model for the ideal image coordinates; NaN where it has no solution, outside of its validity."""
    k1, k2, p1, p2, k3, k4, k5, k6 = (*coefficients, *[0.0] * (8 - len(coefficients)))
    x_seen, y_seen = np.broadcast_arrays(x_seen, y_seen)
    x, y = x_seen, y_seen
    with np.errstate(all="ignore"):
        for _ in range(_ROUNDS):
            square = x * x + y * y
            radial = (1 + square * (k1 + square * (k2 + square * k3))) / (
                1 + square * (k4 + square * (k5 + square * k6))
            )
            x_shift = 2 * p1 * x * y + p2 * (square + 2 * x * x)
            y_shift = p1 * (square + 2 * y * y) + 2 * p2 * x * y
            miss = np.hypot(x * radial + x_shift - x_seen, y * radial + y_shift - y_seen)
            x, y = (x_seen - x_shift) / radial, (y_seen - y_shift) / radial
        solved = miss < _SOLVED
    return np.where(solved, x, np.nan), np.where(solved, y, np.nan)


def _centers(first, last, count):
    """Radians at the middle of `count` equal steps from one edge to the other, given in degrees."""
    return np.radians(first + (last - first) * (np.arange(count) + 0.5) / count)
