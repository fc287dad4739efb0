"""E57, structured: every point knows its row and column."""

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ..gate import size_of
from ..memory import require_memory
from .e57_columns import E57Columns
from .e57_file import COLOR, SPHERICAL, read_structure, scan_header, scan_name, scan_nodes
from .e57_grid import IndexGrid, in_8_bits
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_scan, with_problems
from .poses import quaternion_pose


def read_e57(file, path, *, outside=False, progress=None, cancelled=None):
    """Read every structured scan of an E57 file.

    Coordinates may be Cartesian or spherical and stay in the scan's own frame, apart from its pose. Pose, intensity
    limits, color limits, index bounds and invalid states are all optional. Intensity is kept as it is; colors are
    brought to 8 bits by their limits. Rows and columns are counted from the least that occurs, and may have holes.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    progress, cancelled : callable, optional

    Errors are those of `read_scans`; a file with none but unstructured scans is a ScanError.
    """
    root, xml_size = read_structure(file, path, cancelled)
    nodes = scan_nodes(root, path)
    headers, problems = {}, []
    for index, node in enumerate(nodes):
        name = scan_name(node, path, index, len(nodes))
        try:
            header = scan_header(node, path.name, size_of(file), name)
        except UnusableScan as error:
            problems.append(error)
            continue
        require_memory(
            header.count * (8 * len(header.fields) + BYTES_PER_PIXEL),
            f"{path.name}: scan '{name}': {header.count:,} points",
            error=ScanError,
        )
        headers[index] = name, header
    if not headers:
        return with_problems([], problems, len(nodes), path)
    words = max(header.count * len(header.fields) for _, header in headers.values())
    finished = []
    with E57Columns(file, path, words=words, xml_size=xml_size, cancelled=cancelled) as columns:
        for done, (index, (name, header)) in enumerate(headers.items()):

            def tell(fraction, done=done, name=name):
                if cancelled and cancelled():
                    raise Cancelled
                if progress:
                    progress((done + fraction) / len(headers), f"Reading {path.name}: {name}")

            read = columns.read(index, header.count, header.fields, tell)
            try:
                finished.append(finish_scan(source=path, **_stored(path, header, read, name)))
            except UnusableScan as error:
                problems.append(error)
    return with_problems(finished, problems, len(nodes), path)


def _stored(path, header, columns, name):
    """Keyword arguments of `finish_scan`."""
    placed, warnings = quaternion_pose(header.quaternion, header.translation, name)
    # Whatever is stored, also what is no number: finish_scan sorts it out.
    with np.errstate(all="ignore"):
        xyz = np.stack([columns.pop(axis) for axis in header.axes], axis=-1)
        if header.axes is SPHERICAL:
            valid = xyz[:, 0] > 0
            xyz = _cartesian(xyz)
        else:
            valid = (xyz != 0).any(axis=-1)
        # 1 is a direction without a distance, 2 nothing at all: neither is a return.
        valid &= columns.pop(header.state, 0) == 0
        faulty = valid & (columns.pop("isIntensityInvalid", 0) != 0)
        valid &= ~faulty
        color = None
        if header.color:
            color = np.stack([in_8_bits(columns.pop(channel), *header.limits[channel]) for channel in COLOR], axis=-1)
            color[columns.pop("isColorInvalid", np.zeros(header.count)) != 0] = 0
    if faulty.any():
        warnings.append(
            Message(
                "scan '{scan}': {count:,} points without intensity were taken as no return",
                scan=name,
                count=np.count_nonzero(faulty),
            )
        )
    grid = IndexGrid(columns.pop("rowIndex"), columns.pop("columnIndex"), header.limits, path.name, name)
    doubled = grid.place(valid)
    if doubled:
        warnings.append(
            Message(
                "scan '{scan}': {count:,} points share a pixel with an earlier one and were left out",
                scan=name,
                count=doubled,
            )
        )
    return {
        "name": name,
        "points": grid.spread(xyz),
        "reflectance": grid.spread(columns["intensity"], np.float32) if "intensity" in columns else None,
        "valid": grid.spread(valid),
        "color": None if color is None else grid.spread(color),
        "pose": placed,
        "warnings": warnings,
    }


def _cartesian(spherical):
    """(N, 3) x y z of range, azimuth (counterclockwise from +X) and elevation, metres and radians."""
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
