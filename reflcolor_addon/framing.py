"""Where to look at a scan from, so that a picture shows what the scanner saw."""

from dataclasses import dataclass

import numpy as np

# From this much of the horizon on, a scan is looked at from outside.
_WIDE_DEG = 200.0
_OUTSIDE_FOV_DEG = 45.0
_OUTSIDE_RISE_DEG = 40.0
# The widest view that does not look distorted.
_WIDEST_DEG = 70.0
# Back, right and up from the scanner, in near ranges: enough to see that the picture is no photo.
_ASIDE = np.array([0.8, 0.35, 0.35])
_BACKING_OFF = 1.5
_STEPS = 24
_CENTERINGS = 8
_MARGIN = 1.05
# Percent of the points on each side that may lie outside the picture: stray returns must not shrink all the others.
_STRAY = 0.05
# Metres; a scan of one point has no size to go by.
_CLOSEST = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class View:
    """A camera: ``position`` and ``target`` (3,), world metres; ``fov_deg``, the field of view of the wider side."""

    position: np.ndarray
    target: np.ndarray
    fov_deg: float

    def distance_through(self, fov_deg):
        """Return how far from the target, in metres, a lens of another field of view (degrees) shows as much of it."""
        wanted, given = (np.tan(np.radians(min(angle, 170.0)) / 2) for angle in (self.fov_deg, fov_deg))
        return float(np.linalg.norm(self.target - self.position) * wanted / given)

    def target_beside(self, distance, fov_deg, covered):
        """Return the (3,) place to look at so that the target is in the middle of what is not covered of a picture.

        ``covered`` is the share of its width that is hidden at its right; the picture has the field of view ``fov_deg``
        across and is taken from ``distance`` metres.
        """
        forward = self.target - self.position
        right = np.cross(forward, [0.0, 0.0, 1.0])
        length = np.linalg.norm(right)
        across = 2 * distance * np.tan(np.radians(fov_deg) / 2)
        return self.target + (right / length * across * covered / 2 if length > 1e-9 else 0.0)


def frame(points, scanner, *, aspect):
    """Return a view that shows all of a scan's surface from the side that was scanned.

    A scan of a window of directions is seen from a little behind, above and beside the scanner, so that near and far
    have the room that they have in the scan. A scan all around is seen obliquely from above, as one looks into a
    doll's house.

    Parameters
    ----------
    points : (N, 3) float64
        Points with a return, world metres, Z up.
    scanner : (3,) float64
        The scanner's place.
    aspect : float
        Width of the picture over its height.

    Returns
    -------
    View
    """
    rays = points - scanner
    distance = np.maximum(np.linalg.norm(rays, axis=1), 1e-9)
    mean = (rays / distance[:, None]).mean(axis=0)
    heading = np.array([mean[0], mean[1], 0.0]) / max(np.hypot(mean[0], mean[1]), 1e-9)
    if not heading.any():
        heading = np.array([0.0, 1.0, 0.0])
    right = np.array([heading[1], -heading[0], 0.0])
    if _covered_deg(rays) > _WIDE_DEG:
        return _from_outside(points, heading, right, aspect)
    away = (-heading * _ASIDE[0] + right * _ASIDE[1] + [0, 0, _ASIDE[2]]) * np.percentile(distance, 5)
    for step in range(_STEPS):
        view = _looking_from(scanner + away * _BACKING_OFF**step, points, aspect)
        if view.fov_deg <= _WIDEST_DEG:
            break
    return view


def _from_outside(points, heading, right, aspect):
    low, high = np.percentile(points, (_STRAY, 100 - _STRAY), axis=0)
    rise = np.radians(_OUTSIDE_RISE_DEG)
    back = (-heading + right / 2) / np.linalg.norm(-heading + right / 2) * np.cos(rise) + [0, 0, np.sin(rise)]
    reach = max(np.linalg.norm(high - low) / 2, _CLOSEST)
    for step in range(_STEPS):
        view = _looking_from((low + high) / 2 + back * reach * (1 + 0.15 * step), points, aspect)
        if view.fov_deg <= _OUTSIDE_FOV_DEG:
            break
    return view


def _looking_from(position, points, aspect):
    """The view from a place that holds the points; wider than any lens where some are behind it."""
    offsets = points - position
    forward = offsets.mean(axis=0)
    forward = forward / max(np.linalg.norm(forward), 1e-9)
    for _ in range(_CENTERINGS):
        right = np.cross(forward, [0.0, 0.0, 1.0])
        if np.linalg.norm(right) < 1e-6:
            right = np.array([1.0, 0.0, 0.0])
        right = right / np.linalg.norm(right)
        up = np.cross(right, forward)
        depth = offsets @ forward
        in_front = depth > 1e-3 * max(1e-9, depth.max())
        if in_front.mean() < 1 - _STRAY / 100:
            return View(position=position, target=position + forward, fov_deg=180.0)
        seen = np.stack([offsets[in_front] @ right, offsets[in_front] @ up], axis=1) / depth[in_front, None]
        low, high = np.percentile(seen, (_STRAY, 100 - _STRAY), axis=0)
        aim = forward + right * (low[0] + high[0]) / 2 + up * (low[1] + high[1]) / 2
        forward = aim / np.linalg.norm(aim)
    half_width, half_height = (high - low) / 2 * _MARGIN
    widest = max(half_width, half_height * aspect) if aspect >= 1 else max(half_width / aspect, half_height)
    distance = max(float(np.median(depth)), _CLOSEST)
    fov_deg = np.degrees(2 * np.arctan(max(widest, 0.01)))
    return View(position=position, target=position + forward * distance, fov_deg=float(fov_deg))


def _covered_deg(rays):
    """Degrees of the horizon in which there are points, in bins of five."""
    bins = np.unique(np.floor(np.degrees(np.arctan2(rays[:, 1], rays[:, 0])) / 5).astype(int))
    return 5.0 * bins.size
