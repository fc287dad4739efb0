"""Whether a pose that a file gives can be believed, and what to do when not."""

import math

import numpy as np

_TOLERANCE = 1e-3
"""How far from a rotation the digits that a file prints may be."""

_TOO_FAR_M = 1e12
"""No place on or near a planet."""


def is_rotation(matrix, tolerance=_TOLERANCE):
    """True where a (3, 3) matrix turns without scaling or mirroring."""
    return bool(
        (np.abs(matrix) < 2).all()
        and np.abs(matrix @ matrix.T - np.eye(3)).max() <= tolerance
        and np.linalg.det(matrix) > 0
    )


def rigid(rotation, translation):
    """The (4, 4) pose of a (3, 3) rotation and a (3,) translation, column-vector convention."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, translation
    return pose


def ptx_pose(position, axes, matrix, place):
    """The pose of a PTX header, which says it twice.

    Parameters
    ----------
    position : (3,) float64
        The scanner in the world.
    axes : (3, 3) float64
        The scanner's axes in the world, one per row.
    matrix : (4, 4) float64
        Row-vector convention, the translation in the last row.
    place : str
        Names the scan in warnings.

    Returns
    -------
    pose : (4, 4) float64
        Column-vector convention.
    warnings : list of str
        One for a matrix that is no rigid motion, or disagrees with position and axes.
    """
    pose = matrix.T
    stated = rigid(axes.T, position) if is_rotation(axes) and (np.abs(position) < _TOO_FAR_M).all() else None
    if not (np.abs(pose) < _TOO_FAR_M).all() or np.abs(pose[3] - [0, 0, 0, 1]).max() > _TOLERANCE:
        fault = "its matrix is corrupt (expected finite numbers and 0 0 0 1 as its last column)"
    elif abs(np.linalg.det(pose[:3, :3])) < 1e-9:
        fault = "its matrix is singular"
    else:
        fault = None
    if fault:
        instead = "the identity is used: place the scan by hand" if stated is None else "its position and axes are used"
        return np.eye(4) if stated is None else stated, [f"{place}: {fault}; {instead}"]
    # The digits that are printed for 0 0 0 1 are no part of the motion.
    pose = np.vstack([pose[:3], [0.0, 0.0, 0.0, 1.0]])
    if not is_rotation(pose[:3, :3]):
        return pose, [f"{place}: its matrix scales, shears or mirrors; it is used as it is"]
    if stated is None:
        return pose, [f"{place}: its scanner axes are no rotation; the matrix is used"]
    size = max(1.0, np.abs(pose[:3, 3]).max())
    if np.abs(stated[:3, 3] - pose[:3, 3]).max() > _TOLERANCE * size:
        return pose, [
            f"{place}: its scanner position {_numbers(position)} is not the matrix's {_numbers(matrix[3, :3])};"
            " the matrix is used"
        ]
    if np.abs(stated[:3, :3] - pose[:3, :3]).max() > 10 * _TOLERANCE:
        return pose, [f"{place}: its scanner axes are not those of the matrix; the matrix is used"]
    return pose, []


def quaternion_pose(quaternion, translation, place):
    """The pose of an E57 scan.

    Parameters
    ----------
    quaternion : (4,) float64
        w, x, y, z; brought to unit length.
    translation : (3,) float64
    place : str
        Names the scan in warnings.

    Returns
    -------
    pose : (4, 4) float64
    warnings : list of str
    """
    warnings = []
    length = math.hypot(*quaternion)
    if not math.isfinite(length) or length < 1e-9:
        warnings.append(f"{place}: its rotation {_numbers(quaternion)} is corrupt; no rotation is used")
        quaternion, length = np.array([1.0, 0.0, 0.0, 0.0]), 1.0
    elif abs(length - 1) > _TOLERANCE:
        warnings.append(f"{place}: its rotation is a quaternion of length {length:.6g}, brought to 1")
    if not (np.abs(translation) < _TOO_FAR_M).all():
        warnings.append(f"{place}: its translation {_numbers(translation)} is corrupt; no translation is used")
        translation = np.zeros(3)
    w, x, y, z = quaternion / length
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return rigid(np.array(rotation), translation), warnings


def _numbers(values):
    return "(" + " ".join(f"{value:.10g}" for value in values) + ")"
