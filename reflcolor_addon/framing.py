"""Where to look at a scan from, so that a picture shows what the scanner saw."""

from dataclasses import dataclass

import numpy as np

_WIDE_DEG = 200.0
_MARGIN = 1.05
# How far beyond the box of nearly all points a point still counts, in sizes of that box.
_STRAY = 0.5
_CENTERINGS = 8
# Metres; a scan of one point has no size to go by.
_CLOSEST = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class View:
    """A camera's place: ``position`` and ``target`` (3,), world metres; ``fov_deg``, the wider field of view."""

    position: np.ndarray
    target: np.ndarray
    fov_deg: float


def frame(points, scanner, *, aspect, fov_deg=45.0):
    """Return a view that shows all of a scan's surface from the side that was scanned.

    A scan of a window of directions is seen from behind the scanner, a little from above and from the side. A scan all
    around is seen obliquely from above, as one looks into a doll's house.

    Parameters
    ----------
    points : (N, 3) float64
        Points with a return, world metres, Z up.
    scanner : (3,) float64
        The scanner's place.
    aspect : float
        Width of the picture over its height.
    fov_deg : float
        Field of view across the picture's wider side.

    Returns
    -------
    View
    """
    rays = points - scanner
    azimuth = np.arctan2(rays[:, 1], rays[:, 0])
    # Stray returns far out must not shrink everything else.
    low, high = np.percentile(points, (1, 99), axis=0)
    room = _STRAY * (high - low)
    inside = points[np.all((points >= low - room) & (points <= high + room), axis=1)]
    center = (inside.min(axis=0) + inside.max(axis=0)) / 2
    mean = np.arctan2(np.sin(azimuth).mean(), np.cos(azimuth).mean())
    if _covered_deg(azimuth) > _WIDE_DEG:
        turn, rise = mean + np.pi * 1.15, np.radians(40)
    else:
        # Along the scan's own mean direction, level with it or a little above.
        slope = np.arctan2(center[2] - scanner[2], np.hypot(*(center - scanner)[:2]))
        turn, rise = mean + np.pi + np.radians(12), np.clip(np.radians(12) - slope, np.radians(-30), np.radians(75))
    back = np.array([np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)])
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(back, right), back])
    half = np.tan(np.radians(fov_deg) / 2)
    half_sizes = np.array([half, half / aspect] if aspect >= 1 else [half * aspect, half])
    for _ in range(_CENTERINGS):
        offsets = (inside - center) @ axes.T
        distance = max(_CLOSEST, np.max(offsets[:, 2:] + np.abs(offsets[:, :2]) / half_sizes))
        # Perspective moves the middle of the box out of the middle of the picture.
        seen = offsets[:, :2] / (distance - offsets[:, 2:])
        center = center + (seen.max(axis=0) + seen.min(axis=0)) / 2 * distance @ axes[:2]
    return View(position=center + back * distance * _MARGIN, target=center, fov_deg=fov_deg)


def _covered_deg(azimuth):
    """Degrees of the horizon in which there are points, in bins of five."""
    bins = np.unique(np.floor(np.degrees(azimuth) / 5).astype(int))
    return 5.0 * bins.size
