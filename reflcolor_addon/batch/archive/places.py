"""Whether two scans that one photo seems to show are of the same place: they see the same shape there, or their poses
put the photo's camera in one place."""

import numpy as np

# Cells along the longer side of a photo; and how many must be seen on both scans before they are compared.
_CELLS, _LEAST_CELLS = 24, 40
# Distances are the same if they differ by no more than this factor; and in so many of the cells they must be.
_ALIKE, _LEAST_ALIKE = 1.1, 0.5
# How far apart the cameras of one photo may be found, in the distance of what it shows, and how far turned.
_BESIDE, _TURNED_DEG = 0.15, 8.0


def depth_map(scan, model):
    """Return how far away what a photo shows is, as a scan and the photo's model on it have it.

    Parameters
    ----------
    scan : Scan
    model : Camera or GridHomography
        A homography says nothing of the camera's place, but then that is about the scanner's.

    Returns
    -------
    list of list of float or None
        Meters, for cells of the photo; None where the scan has no return.
    """
    rows, cols = np.nonzero(scan.valid)
    points = scan.points[rows, cols]
    if model.kind == "pose":
        sites, distance = points, np.linalg.norm(points - model.center, axis=1)
    else:
        sites, distance = np.column_stack([cols, rows]) + 0.5, np.linalg.norm(points, axis=1)
    xy, depth = model.project(sites)
    size = max(model.width, model.height) / _CELLS
    shape = int(np.ceil(model.height / size)), int(np.ceil(model.width / size))
    with np.errstate(invalid="ignore"):
        col, row = np.floor(xy / size).T
        inside = (depth > 0) & (row >= 0) & (row < shape[0]) & (col >= 0) & (col < shape[1])
    place = (row[inside] * shape[1] + col[inside]).astype(int)
    distance = distance[inside]
    # The nearer half of a cell: what is behind it, the photo does not show.
    order = np.lexsort((distance, place))
    first = np.searchsorted(place[order], np.arange(shape[0] * shape[1] + 1))
    found = np.full(shape[0] * shape[1], np.nan)
    filled = np.flatnonzero(np.diff(first))
    found[filled] = distance[order][first[filled] + np.diff(first)[filled] // 4]
    return [[None if np.isnan(own) else round(float(own), 3) for own in line] for line in found.reshape(shape)]


def camera_place(scan, model):
    """Return where a photo's camera stands and where it looks, [x, y, z, x, y, z] in the world, meters; None where the
    scan has no pose, or the model no camera."""
    if model.kind != "pose" or np.allclose(scan.pose, np.eye(4)):
        return None
    turn, shift = scan.pose[:3, :3], scan.pose[:3, 3]
    return [float(value) for value in (*(turn @ model.center + shift), *(turn @ model.rotation[2]))]


def likeness(one, other):
    """Return in which share of the cells that two depth maps of a photo have in common they agree; None if too few."""
    one, other = (np.array(own, float) for own in (one, other))
    if one.shape != other.shape:
        return None
    both = np.isfinite(one) & np.isfinite(other) & (one > 0) & (other > 0)
    if both.sum() < _LEAST_CELLS:
        return None
    return float((np.abs(np.log(one[both] / other[both])) < np.log(_ALIKE)).mean())


def same_place(one, other):
    """Whether two scans, each with a photo's ``depths`` and ``camera``, agree about the photo.

    Parameters
    ----------
    one, other : Claim
    """
    if one.depths is None or other.depths is None:
        return False
    if one.camera is not None and other.camera is not None:
        # Where both scans have poses, these tell; those of scans that were never registered are all the same.
        return _is_beside(np.array(one.camera), np.array(other.camera), np.nanmedian(np.array(one.depths, float)))
    found = likeness(one.depths, other.depths)
    return found is not None and found >= _LEAST_ALIKE


def _is_beside(one, other, distance):
    near = np.linalg.norm(one[:3] - other[:3]) <= _BESIDE * distance
    return bool(near and np.dot(one[3:], other[3:]) >= np.cos(np.radians(_TURNED_DEG)))
