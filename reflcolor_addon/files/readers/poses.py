"""Whether a pose in a file is plausible, and what replaces it when it is not."""

import math

import numpy as np

from ...messages import Message, of_scan
from ...scan.limits import FARTHEST_M
from ...scan.scan import is_plausible
from ...scan.units import scale_of_pose

_TOLERANCE = 1e-3
"""How far from a rotation the digits that a file prints may be."""


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


def ptx_pose(position, axes, matrix, scan):
    """The pose of a PTX header, which states it twice.

    Parameters
    ----------
    position : (3,) float64
        The scanner in the world.
    axes : (3, 3) float64
        The scanner's axes in the world, one per row.
    matrix : (4, 4) float64
        Row-vector convention, the translation in the last row.
    scan : str
        Its name, for warnings.

    Returns
    -------
    pose : (4, 4) float64
        Column-vector convention.
    warnings : list of str
        One for a matrix that is no rigid motion, or disagrees with position and axes.
    """
    pose = matrix.T
    stated = rigid(axes.T, position) if is_rotation(axes) and (np.abs(position) < FARTHEST_M).all() else None
    if not (np.abs(pose) < FARTHEST_M).all() or np.abs(pose[3] - [0, 0, 0, 1]).max() > _TOLERANCE:
        fault = Message("its matrix is corrupt (expected finite numbers and 0 0 0 1 as its last column)")
    elif not is_plausible(pose):
        fault = Message("its matrix is singular, or its scale is not plausible")
    else:
        fault = None
    if fault:
        instead = (
            Message("the identity is used: place the scan by hand")
            if stated is None
            else Message("its position and axes are used")
        )
        warning = of_scan(scan, "{fault}; {instead}", fault=fault, instead=instead)
        return np.eye(4) if stated is None else stated, [warning]
    # The printed digits of 0 0 0 1 are not part of the motion.
    pose = np.vstack([pose[:3], [0.0, 0.0, 0.0, 1.0]])
    # One that scales evenly uses another unit, which `Settled` handles.
    if not is_rotation(pose[:3, :3] / scale_of_pose(pose)):
        return pose, [of_scan(scan, "its matrix scales, shears or mirrors; it is used as it is")]
    if stated is None:
        return pose, [of_scan(scan, "its scanner axes are not a rotation; the matrix is used")]
    size = max(1.0, np.abs(pose[:3, 3]).max())
    if np.abs(stated[:3, 3] - pose[:3, 3]).max() > _TOLERANCE * size:
        return pose, [
            of_scan(
                scan,
                "its scanner position {position} is not the matrix's {other}; the matrix is used",
                position=_numbers(position),
                other=_numbers(matrix[3, :3]),
            )
        ]
    if np.abs(stated[:3, :3] - pose[:3, :3] / scale_of_pose(pose)).max() > 10 * _TOLERANCE:
        return pose, [of_scan(scan, "its scanner axes are not those of the matrix; the matrix is used")]
    return pose, []


def quaternion_pose(quaternion, translation, scan):
    """The pose of an E57 scan.

    Parameters
    ----------
    quaternion : (4,) float64
        w, x, y, z; brought to unit length.
    translation : (3,) float64
    scan : str
        Its name, for warnings.

    Returns
    -------
    pose : (4, 4) float64
    warnings : list of str
    """
    warnings = []
    length = math.hypot(*quaternion)
    if not math.isfinite(length) or length < 1e-9:
        warnings.append(
            of_scan(
                scan,
                "its rotation {rotation} is corrupt; no rotation is used",
                rotation=_numbers(quaternion),
            )
        )
        quaternion, length = np.array([1.0, 0.0, 0.0, 0.0]), 1.0
    elif abs(length - 1) > _TOLERANCE:
        warnings.append(
            of_scan(scan, "its rotation is a quaternion of length {length:.6g}, brought to 1", length=length)
        )
    if not (np.abs(translation) < FARTHEST_M).all():
        warnings.append(
            of_scan(
                scan,
                "its translation {translation} is corrupt; no translation is used",
                translation=_numbers(translation),
            )
        )
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
