"""Large coordinates brought near the origin, where float32 still resolves a millimeter."""

import numpy as np

# Meters; beyond this a float32 is coarser than about a millimeter.
FAR = 10_000.0
_ROUND_TO = 1000.0


def origin_shift(position, known=None):
    """Return what to subtract from world coordinates so that they fit into float32.

    Parameters
    ----------
    position : (3,) float64
        A scan's place in the world, meters.
    known : (3,) float64, optional
        The shift of scans that came before; kept where it serves this one too, so that they stay together.

    Returns
    -------
    (3,) float64
        Whole kilometers on each axis where the position is far out; 0 elsewhere.
    """
    position = np.asarray(position, np.float64)
    if known is not None and np.all(np.abs(position - known) < FAR):
        return np.asarray(known, np.float64)
    return np.where(np.abs(position) > FAR, np.round(position / _ROUND_TO) * _ROUND_TO, 0.0)


def shifted(pose, shift):
    """Return a (4, 4) pose with a (3,) shift, see `origin_shift`, added to its place."""
    pose = pose.copy()
    pose[:3, 3] += shift
    return pose


def local_center(scan):
    """Return the (3,) float64 point, in the scanner's frame, that its vertices should be measured from.

    It is the scanner itself but for files whose points are stored in world coordinates.
    """
    # Without a return points are zeros.
    if not scan.valid.any() or max(scan.points.max(), -scan.points.min()) <= FAR:
        return np.zeros(3)
    return np.round(np.median(scan.points[scan.valid], axis=0) / _ROUND_TO) * _ROUND_TO


def pose_at(scan, center):
    """Return the (4, 4) float64 pose for vertices that are measured from a center, (3,) in the scanner's frame."""
    pose = scan.pose.copy()
    pose[:3, 3] = scan.pose[:3, :3] @ center + scan.pose[:3, 3]
    return pose


def rigid_pose(matrix, meters, center):
    """Return the pose of a scan whose vertices are measured from a center and brought into the world by a matrix.

    Scale is taken off, from the place as well: scans that were scaled alike keep their places to each other.

    Parameters
    ----------
    matrix : (4, 4) float
        Vertices to world, both in the same unit; column-vector convention.
    meters : float
        Of a unit.
    center : (3,) float64
        From `local_center`: meters, in the scanner's frame.

    Returns
    -------
    (4, 4) float64
        Scanner's frame to world, meters: a rotation and a translation.
    """
    matrix = np.asarray(matrix, np.float64)
    scale = np.cbrt(abs(np.linalg.det(matrix[:3, :3]))) or 1.0
    left, _, right = np.linalg.svd(matrix[:3, :3])
    # A mirrored scan has the nearest pose of one that is not.
    left[:, 2] *= np.sign(np.linalg.det(left @ right))
    pose = np.eye(4)
    pose[:3, :3] = left @ right
    pose[:3, 3] = matrix[:3, 3] * meters / scale - pose[:3, :3] @ np.asarray(center, np.float64)
    return pose
