"""Scans into a PTX file."""

from collections.abc import Iterable
from os import PathLike

import numpy as np

from ...scan.scan import Scan
from ..atomic import written_atomically

_NO_RETURN = "0 0 0 0.500000"


def write_ptx(scans: Scan | Iterable[Scan], path: PathLike | str, *, decimals: int = 6) -> None:
    """Write scans one after the other into a PTX: columns left to right, each from the bottom to the top.

    Parameters
    ----------
    scans : Scan or sequence of Scan
        Reflectance keeps six decimals, as it is.
    path : path-like
    decimals : int
        Of the points: 6 for micrometers, 9 for nanometers.

    Raises
    ------
    OutputError
        If the file cannot be written; nothing is left behind then.

    Examples
    --------
    >>> from reflcolor_addon import read_scans, write_ptx
    >>> write_ptx(read_scans("garage.ptx"), "copy.ptx")
    """
    scans = [scans] if isinstance(scans, Scan) else list(scans)
    with written_atomically(path) as temporary, temporary.open("w", encoding="ascii", newline="\n") as file:
        for scan in scans:
            _write_header(file, scan)
            _write_points(file, scan, decimals)


def _write_header(file, scan):
    height, width = scan.shape
    rotation, position = scan.pose[:3, :3], scan.pose[:3, 3]
    file.write(f"{width}\n{height}\n")
    # Scanner's position and axes, then the same as a matrix for row vectors: translation in the last row.
    for vector in (position, *rotation.T):
        file.write(_numbers(vector) + "\n")
    for row in scan.pose.T:
        file.write(_numbers(row) + "\n")


def _numbers(vector):
    # Adding zero turns -0 into 0.
    return " ".join(f"{value + 0.0:.12g}" for value in vector)


def _write_points(file, scan, decimals):
    columns = [scan.points[..., axis] + 0.0 for axis in range(3)] + [scan.reflectance]
    line = " ".join([f"%.{decimals}f"] * 3) + " %.6f"
    blank = _NO_RETURN
    if scan.color is not None:
        columns += [scan.color[..., channel] for channel in range(3)]
        line, blank = line + " %d %d %d", blank + " 0 0 0"
    for column in range(scan.shape[1]):
        values = np.stack([grid[::-1, column] for grid in columns], axis=1).tolist()
        valid = scan.valid[::-1, column].tolist()
        lines = [line % tuple(row) if there else blank for row, there in zip(values, valid, strict=True)]
        file.write("\n".join(lines) + "\n")
