"""Colored scans into one binary PLY: every return once, in the order of the scan's grid, and the faces between them."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from ...errors import Cancelled, OutputError
from ...messages import Message
from ...progress import IsCancelled, Progress
from ...scan.mesh_surface import MeshSurface
from ...scan.surface import ScanSurface
from ...version import __version__
from ..atomic import written_atomically

_TYPES = {np.dtype(np.float32): "float", np.dtype(np.int32): "int"}
_MOST_VERTICES = 2**31 - 1


def write_ply(
    surfaces: Sequence[ScanSurface | MeshSurface],
    path: PathLike | str,
    *,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> None:
    """Write colored scans into a PLY.

    Vertices are in world coordinates (meters, Z up, double precision), scan after scan, each row by row from the top,
    with ``red``, ``green``, ``blue``, and every value of the surface under its own name. Several scans are told apart
    by ``scan``, counted from 0. Comments name each scan, its grid and its pose.

    Parameters
    ----------
    surfaces : sequence of ScanSurface or MeshSurface
    path : path-like
    progress : callable, optional
        Called as ``progress(fraction, text)``.
    cancelled : callable, optional
        True stops the writing; nothing is left behind.

    Raises
    ------
    OutputError
        If the file cannot be written.
    Cancelled
        If ``cancelled()`` returned True.

    Examples
    --------
    >>> from reflcolor_addon import ScanSurface, Seeds, colorize, read_scans, write_ply
    >>> scan = read_scans("garage.ptx")[0]
    >>> result = colorize(scan, Seeds([1], [2], [[200, 80, 40]]))
    >>> write_ply([ScanSurface(scan, result.rgb, result.values)], "garage.ply")
    """
    path = Path(path)
    vertices = sum(surface.vertex_count for surface in surfaces)
    if vertices > _MOST_VERTICES:
        raise OutputError(
            "{path}: {count:,} returns are more than a PLY can number ({most:,}); write the scans one by one",
            path=path,
            count=vertices,
            most=_MOST_VERTICES,
        )
    types = {name: dtype for surface in surfaces for name, dtype in surface.value_types.items()}
    if len(surfaces) > 1:
        types["scan"] = np.dtype(np.int32)
    faces = sum(surface.face_count for surface in surfaces)
    done, whole = 0, vertices + faces

    def written(file, table):
        nonlocal done
        if cancelled and cancelled():
            raise Cancelled
        file.write(table)
        done += len(table)
        if progress:
            progress(done / whole, Message("Writing {name}", name=path.name))

    with written_atomically(path) as temporary, temporary.open("wb") as file:
        file.write(_header(surfaces, types, vertices, faces))
        for index, surface in enumerate(surfaces):
            for block in surface.vertex_blocks():
                written(file, _vertex_table(surface.pose, block, types, index))
        first = 0
        for surface in surfaces:
            for faces in surface.face_blocks():
                written(file, _face_table(faces, first))
            first += surface.vertex_count


def _header(surfaces, types, vertices, faces):
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        f"comment Reflectance Colorizer {__version__}",
        "comment World coordinates in meters, Z up; colors are sRGB; no vertex is there twice",
    ]
    for index, surface in enumerate(surfaces):
        rows, columns = surface.shape
        lines.append(f"comment scan {index}: {rows} rows x {columns} columns: {_ascii(surface.name)}")
        pose = " ".join(repr(float(number)) for number in surface.pose.ravel())
        lines.append(f"comment pose of scan {index}, scanner to world, row by row: {pose}")
    lines.append(f"element vertex {vertices}")
    lines += [f"property double {axis}" for axis in "xyz"]
    lines += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    lines += [f"property {_TYPES[dtype]} {name}" for name, dtype in types.items()]
    lines += [f"element face {faces}", "property list uchar int vertex_indices", "end_header"]
    return ("\n".join(lines) + "\n").encode("ascii")


def _ascii(name):
    """A name in one line of ASCII: readers refuse anything else in a comment."""
    return "".join(c if c.isprintable() else "?" for c in name).encode("ascii", "backslashreplace").decode("ascii")


def _vertex_table(pose, block, types, index):
    fields = [("xyz", "<f8", 3), ("rgb", "u1", 3), *((name, dtype.newbyteorder("<")) for name, dtype in types.items())]
    table = np.zeros(len(block.points), fields)
    # A fixed order of additions: a matrix product may differ in the last digit from processor to processor.
    for axis in range(3):
        x, y, z = block.points.T
        table["xyz"][:, axis] = pose[axis, 0] * x + pose[axis, 1] * y + pose[axis, 2] * z + pose[axis, 3]
    table["rgb"] = block.rgb
    for name in types:
        table[name] = index if name == "scan" else block.values.get(name, 0)
    return table


def _face_table(faces, first):
    corners = faces.shape[1]
    table = np.empty(len(faces), [("count", "u1"), ("vertices", "<i4", corners)])
    table["count"], table["vertices"] = corners, faces
    table["vertices"] += first
    return table
