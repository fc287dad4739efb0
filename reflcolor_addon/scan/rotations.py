"""Rotations as quaternions."""

import numpy as np


def quaternion(rotation):
    """Return the unit quaternion (w, x, y, z), w not negative, of a (3, 3) rotation matrix."""
    # The quaternion is the eigenvector to the greatest eigenvalue of this symmetric matrix (Bar-Itzhack 2000).
    m = np.asarray(rotation, np.float64)
    matrix = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], 0],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
        ]
    )
    _, vectors = np.linalg.eigh(matrix, UPLO="L")
    x, y, z, w = vectors[:, -1]
    return np.array([w, x, y, z]) * (1.0 if w >= 0 else -1.0)
