"""Whether something that the scanner never saw may stand between a surface and a camera.

Space in front of what the scanner saw is empty, space behind it is unknown: a photo from the other side of a thing sees
its unseen back, which hides what lies beyond though the scan has no point there.
"""

import numpy as np

_STEPS = 32
# Seen at less than this angle apart from the scanner's own view, little unknown can be in the way, and a thin thing's
# long shadow would take away much that is seen well.
_APART_COSINE = np.cos(np.radians(75))
_BEHIND_SHARE = 0.04


def hidden_by_unknown(image, center, chosen, behind):
    """Return (h, w) bool: which of the chosen pixels a camera may well not see.

    The way from a surface's back begins in unknown space and is let pass while it stays there: that is the inside of
    the surface's own thing.

    Parameters
    ----------
    image : ScanImage
    center : (3,) float64
        Of the camera, metres, scanner frame.
    chosen : (h, w) bool
    behind : (h, w) bool
        Which of them turn their backs to the camera.
    """
    points = image.points[chosen]
    way = center - points
    distance = np.linalg.norm(way, axis=1)
    cosine = -(way * points).sum(axis=1) / np.maximum(distance * image.range[chosen], 1e-12)
    asked = cosine < _APART_COSINE
    points, way = points[asked], way[asked]
    ranges = _range_map(image)
    left_own = ~behind[chosen][asked]
    hidden = np.zeros(len(points), bool)
    # Not up to the camera: it may stand in a place that the scanner did not see into.
    for share in np.linspace(0.02, 0.85, _STEPS):
        unknown = _unknown(points + share * way, ranges)
        hidden |= left_own & unknown
        left_own |= ~unknown
    result = np.zeros(image.shape, bool)
    place = np.argwhere(chosen)[asked][hidden]
    result[place[:, 0], place[:, 1]] = True
    return result


def _range_map(image):
    """The range over (elevation, azimuth) in half degrees; infinite where the scanner saw nothing."""
    points, distance = image.points[image.valid], image.range[image.valid]
    ranges = np.full((361, 720), np.inf)
    np.minimum.at(ranges, _cells(points), distance)
    return ranges


def _unknown(points, ranges):
    distance = np.linalg.norm(points, axis=1)
    return distance > ranges[_cells(points)] * (1 + _BEHIND_SHARE)


def _cells(points):
    azimuth = np.degrees(np.arctan2(points[:, 0], points[:, 1]))
    elevation = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
    return ((elevation + 90) * 2).astype(int), (azimuth * 2).astype(int) % 720
