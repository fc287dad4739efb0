"""Where to look at a scan from, so that a picture shows what the scanner saw."""

from dataclasses import dataclass

import numpy as np

# A scan that covers at least this many degrees of the horizon is viewed from outside.
_WIDE_DEG = 200.0
_OUTSIDE_FOV_DEG = 45.0
_OUTSIDE_RISE_DEG = 40.0
# Largest field of view of a picture, in degrees, without visible distortion.
_WIDEST_DEG = 95.0
# Wider scans are viewed from behind the scanner, by at least this share of the near ranges.
_BACK, _BACKING_OFF = 0.1, 1.25
_STEPS = 40
_CENTERINGS = 8
_MARGIN = 1.05
# Percent of the points on each side that may lie outside the picture: stray returns must not shrink all the others.
_STRAY = 0.05
# Enough points for these estimates; a random sample of this size is taken of more.
_SAMPLE = 20_000
# Clipping distances, as multiples of the distance to the target.
_CLIP = (1e-3, 1e3)
# Meters; a scan of one point has no size to go by.
_CLOSEST = 0.1
# Width over height of a picture in the scan's own shape is no more extreme than this.
_SHAPES = 0.5, 2.4
# Pixels of a picture, about.
_PICTURE_PIXELS = 1_300_000
# Blender's 3D View has a sensor of twice the usual width.
_REGION_SENSOR_MM = 72.0
# Share of the free part of a 3D View that the camera's picture takes: headers cover its edges.
_CAMERA_SHARE = 0.88


@dataclass(frozen=True, eq=False, kw_only=True)
class View:
    """A camera.

    Parameters
    ----------
    position, target : (3,) float64
        World meters.
    fov_deg : float
        Field of view of the picture's wider side.
    aspect : float
        Width of the picture over its height.
    """

    position: np.ndarray
    target: np.ndarray
    fov_deg: float
    aspect: float

    @property
    def distance(self):
        """Meters from the position to the target."""
        return float(np.linalg.norm(self.target - self.position))

    @property
    def clip(self):
        """(start, end) of what is shown, meters from the position."""
        return self.distance * _CLIP[0], self.distance * _CLIP[1]


def in_world(coordinates, matrix):
    """Return (N, 3) float64, points of shape (N, 3) brought to the world by a (4, 4) matrix."""
    matrix = np.asarray(matrix, np.float64)
    return coordinates.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def picture_size(aspect):
    """Return (width, height) in pixels, even numbers, of a picture of this width over height."""
    height = np.sqrt(_PICTURE_PIXELS / aspect)
    return tuple(2 * round(side / 2) for side in (height * aspect, height))


def frame(points, scanners, *, aspect=None):
    """Return a view that shows all of a scan's surface from the side that was scanned.

    A scan of a window of directions is seen from the scanner's place, from where there are no gaps behind near things;
    from farther back where it is wider than a picture can be. A scan all around, or scans from
    several places, are seen obliquely from above, as one looks into a doll's house.

    Parameters
    ----------
    points : (N, 3) float64
        Points with a return, world meters, Z up.
    scanners : (3,) or (K, 3) float64
        Where the scanner stood: once, or for each of several scans.
    aspect : float, optional
        Width of the picture over its height; by default that of the scan as it is seen, from 0.5 to 2.4.

    Returns
    -------
    View
    """
    points, scanners = _sample(points), np.reshape(scanners, (-1, 3))
    scanner = scanners.mean(axis=0)
    rays = points - scanner
    distance = np.maximum(np.linalg.norm(rays, axis=1), 1e-9)
    mean = (rays / distance[:, None]).mean(axis=0)
    heading = np.array([mean[0], mean[1], 0.0]) / max(np.hypot(mean[0], mean[1]), 1e-9)
    if not heading.any():
        heading = np.array([0.0, 1.0, 0.0])
    right = np.array([heading[1], -heading[0], 0.0])
    if len(scanners) > 1 or _covered_deg(rays) > _WIDE_DEG:
        return _from_outside(points, heading, right, aspect)
    back = np.percentile(distance, 5) * _BACK * np.append(0.0, _BACKING_OFF ** np.arange(_STEPS))
    for length in back:
        view, taken_deg = _looking_from(scanner - length * heading, points, aspect)
        if taken_deg <= _WIDEST_DEG:
            break
    return view


def frame_in_region(points, scanners, *, size, covered, focal_mm):
    """Return a view that shows a scan as `frame` does, but through the lens of a region of Blender's 3D View.

    Parameters
    ----------
    points, scanners
        As in `frame`.
    size : (width, height) of int
        Pixels of the region.
    covered : (left, right) of int
        Pixels at its edges that a toolbar and a sidebar hide: the scan is shown in between.
    focal_mm : float
        The 3D View's focal length.

    Returns
    -------
    View
        Of the whole region, the target in its middle.
    """
    points = _sample(points)
    width, height = (max(1, length) for length in size)
    left, right = covered
    free = max(1, width - left - right)
    view = frame(points, scanners, aspect=free / height)
    # The focal length is that of the wider side.
    pixel = _REGION_SENSOR_MM / focal_mm / max(width, height)
    forward = (view.target - view.position) / view.distance
    forward = forward + _across(forward)[0] * (right - left) / 2 * pixel
    forward = forward / np.linalg.norm(forward)
    across, offsets = np.stack(_across(forward)), points - view.position
    depth, seen = offsets @ forward, offsets @ across.T
    middle, half = np.array([left - right, 0]) / 2 * pixel, np.array([free, height]) / 2 * pixel / _MARGIN
    before, after = half - middle, half + middle
    # Moved back by b and aside by s, a camera has in what is free of its picture what is at (x, depth), if
    # -before (depth + b) <= x - s <= after (depth + b). For all points together that is
    # highest - after b <= s <= lowest + before b, which leaves room for s from some b on.
    lowest = np.percentile(seen + before * depth[:, None], _STRAY, axis=0)
    highest = np.percentile(seen - after * depth[:, None], 100 - _STRAY, axis=0)
    back = np.max((highest - lowest) / (before + after))
    aside = (lowest + highest + (before - after) * back) / 2
    position = view.position - back * forward + aside @ across
    distance = max(float(np.median(depth) + back), _CLOSEST)
    fov_deg = np.degrees(2 * np.arctan(_REGION_SENSOR_MM / focal_mm / 2))
    return View(position=position, target=position + forward * distance, fov_deg=float(fov_deg), aspect=width / height)


def camera_in_region(size, covered, aspect):
    """Return how a 3D View that looks through a camera has the whole picture beside its toolbar and sidebar.

    Blender magnifies the view by z = (zoom / 50 + sqrt 2)^2 / 4: the longer side of the picture takes z of the longer
    side of the region. Moved by an offset, the picture's middle is 2 z offset of the region's width to the left.

    Parameters
    ----------
    size : (width, height) of int
        Pixels of the region.
    covered : (left, right) of int
        Pixels at its edges that a toolbar and a sidebar hide.
    aspect : float
        Width of the camera's picture over its height.

    Returns
    -------
    zoom : float
        For ``view_camera_zoom``.
    offset : (x, y) of float
        For ``view_camera_offset``.
    """
    width, height = (max(1, length) for length in size)
    across, down = (1.0, 1 / aspect) if aspect >= 1 else (aspect, 1.0)
    left, right = covered
    free = max(1, width - left - right)
    magnified = min(free / across, height / down) * _CAMERA_SHARE / max(width, height)
    zoom = 50 * (2 * np.sqrt(magnified) - np.sqrt(2))
    return float(zoom), ((right - left) / (4 * width * magnified), 0.0)


def _from_outside(points, heading, right, aspect):
    low, high = np.percentile(points, (_STRAY, 100 - _STRAY), axis=0)
    rise = np.radians(_OUTSIDE_RISE_DEG)
    back = (-heading + right / 2) / np.linalg.norm(-heading + right / 2) * np.cos(rise) + [0, 0, np.sin(rise)]
    reach = max(np.linalg.norm(high - low) / 2, _CLOSEST)
    for step in range(_STEPS):
        view, _ = _looking_from((low + high) / 2 + back * reach * (1 + 0.15 * step), points, aspect)
        if view.fov_deg <= _OUTSIDE_FOV_DEG:
            break
    return view


def _looking_from(position, points, aspect):
    """The view from a place that holds the points, and the degrees that they take across or down, whichever is more.

    Both are wider than any lens where some points are behind the place.
    """
    offsets = points - position
    forward = offsets.mean(axis=0)
    forward = forward / max(np.linalg.norm(forward), 1e-9)
    for _ in range(_CENTERINGS):
        right, up = _across(forward)
        depth = offsets @ forward
        in_front = depth > 1e-3 * max(1e-9, depth.max())
        if in_front.mean() < 1 - _STRAY / 100:
            return View(position=position, target=position + forward, fov_deg=180.0, aspect=aspect or 1.0), 180.0
        seen = np.stack([offsets[in_front] @ right, offsets[in_front] @ up], axis=1) / depth[in_front, None]
        low, high = np.percentile(seen, (_STRAY, 100 - _STRAY), axis=0)
        # The last direction is one that was looked at.
        half_width, half_height = np.maximum(np.maximum(-low, high) * _MARGIN, 1e-6)
        # Halfway between the edges as angles: turned there, they are about as far off at both sides.
        center = np.tan((np.arctan(low) + np.arctan(high)) / 2)
        if np.abs(center).max() < 0.002 * (high - low).max():
            break
        aim = forward + right * center[0] + up * center[1]
        looked, forward = forward, aim / np.linalg.norm(aim)
    else:
        forward = looked
    aspect = aspect or float(np.clip(half_width / half_height, *_SHAPES))
    widest = max(half_width, half_height * aspect) if aspect >= 1 else max(half_width / aspect, half_height)
    distance = max(float(np.median(depth)), _CLOSEST)
    fov_deg, taken_deg = (2 * np.degrees(np.arctan(max(half, 0.01))) for half in (widest, max(half_width, half_height)))
    target = position + forward * distance
    return View(position=position, target=target, fov_deg=float(fov_deg), aspect=aspect), taken_deg


def _across(forward):
    """Directions to the right and up, as seen by who looks forward."""
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right = right / np.linalg.norm(right) if np.linalg.norm(right) > 1e-6 else np.array([1.0, 0.0, 0.0])
    return right, np.cross(right, forward)


def _sample(points):
    """A sample of very many points."""
    if len(points) <= _SAMPLE:
        return points
    return points[np.random.default_rng(0).integers(0, len(points), _SAMPLE)]


def _covered_deg(rays):
    """Degrees of the horizon in which there are points, but for stray ones, in bins of five."""
    bins = np.floor(np.degrees(np.arctan2(rays[:, 1], rays[:, 0])) / 5).astype(int)
    return 5.0 * np.count_nonzero(np.bincount(bins - bins.min()) > len(rays) * _STRAY / 100)
