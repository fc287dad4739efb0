"""Finds the unit of a file's numbers from the numbers themselves."""

import numpy as np

MILLIMETRE = 0.001
_CAMERA_REACH = 60.0
"""Meters beyond which no depth camera sees; its measurements in millimeters are always larger numbers."""

_STEEP = -0.64
"""Sine of an angle below which a standing scanner sees the floor that it stands on."""

_HIGHEST = 150.0
"""Greatest height of a scanner above what is straight below it, in meters."""

_FEWEST = 50


def scale_of_pose(pose):
    """Return the factor by which a pose scales evenly, as of files whose points count another unit; 1 for none.

    Parameters
    ----------
    pose : (4, 4) float64
    """
    matrix = pose[:3, :3]
    determinant = np.linalg.det(matrix)
    if not determinant > 0:
        return 1.0
    # Further digits are rounding errors.
    scale = float(f"{np.cbrt(determinant):.9g}")
    turn = matrix / scale
    return scale if np.abs(turn @ turn.T - np.eye(3)).max() <= 1e-3 and abs(scale - 1) > 1e-3 else 1.0


def counts_millimeters(points, *, camera):
    """Return whether points count millimeters: a camera sees farther than any can, or the floor is far below a scanner.

    Parameters
    ----------
    points : (N, 3) float64
        Of the returns, from the scanner, Z up.
    camera : bool
        Whether it is a depth camera.
    """
    distance = np.sqrt(np.einsum("ij,ij->i", points, points))
    if camera:
        return bool(np.percentile(distance, 5) > _CAMERA_REACH)
    steep = distance[points[:, 2] < _STEEP * distance]
    return steep.size >= _FEWEST and bool(np.percentile(steep, 10) > _HIGHEST)
