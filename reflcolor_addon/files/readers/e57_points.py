"""From the columns of an E57 scan to stored grids, whichever of its many fields the file has."""

from functools import reduce

import numpy as np

from ...messages import of_scan
from .angle import gridded_by_angle
from .colors import scaled_colors, stacked
from .e57_grid import IndexGrid
from .e57_header import CARTESIAN, CARTESIAN_STATE, COLOR, INDEX, SPHERICAL, SPHERICAL_STATE
from .grid import UnusableScan
from .lines import indices_of_lines
from .options import ANGLE
from .poses import quaternion_pose


def stored_grids(columns, header, options):
    """Return the keyword arguments of `finish_grid`, and where each point went.

    Parameters
    ----------
    columns : dict of (N,) float64
        By the field's name; emptied.
    header : E57Header
    options : ReadOptions

    Returns
    -------
    stored : dict
    cells : (N,) int64
        Pixel of every point in the stored grid, row by row; -1 where it has none.

    Raises
    ------
    UnusableScan
        If the points have neither rows and columns nor lines.
    """
    pose, warnings = quaternion_pose(header.quaternion, header.translation, header.name)

    def warn(template, **values):
        warnings.append(of_scan(header.name, template, **values))

    # Values are taken as stored, NaN included: `finish_grid` sorts them out.
    with np.errstate(all="ignore"):
        xyz, valid = _coordinates(columns, warn)
        reflectance, invalid = _reflectance(columns, header, valid, warn)
        color = _color(columns, header, warn)
    valid &= ~invalid
    stored = {"name": header.name, "pose": pose, "warnings": warnings, "options": options}
    stored["places"] = {"matrix": pose[:3, 3]} if pose[:3, 3].any() else {}
    returns = columns.pop("returnIndex", None)
    if options.grid == ANGLE:
        arrays, cells = gridded_by_angle(
            header, xyz, valid, reflectance, color, [np.zeros(3), pose[:3, 3]], options, warn
        )
        return stored | arrays, cells
    grid = IndexGrid(*_indices(columns, header, warn), header.limits, header)
    grid.place(valid, returns, xyz, reflectance, options.returns, warn)
    return stored | {
        "points": grid.spread(xyz),
        "reflectance": None if reflectance is None else grid.spread(reflectance, np.float32),
        "valid": grid.spread(valid),
        "color": None if color is None else grid.spread(color),
    }, grid.cells


def _coordinates(columns, warn):
    """(N, 3) points and (N,) which of them are returns; spherical ones where the Cartesian say nothing."""
    # No return has three zeros; what is not finite is sorted out later, so that it is counted.
    nonzero = _largest([columns[axis] for axis in CARTESIAN]) != 0 if CARTESIAN[0] in columns else None
    spherical, cartesian = (
        np.stack([columns.pop(axis) for axis in axes], axis=-1) if axes[0] in columns else None
        for axes in (SPHERICAL, CARTESIAN)
    )
    # 1 is a direction without a distance, 2 nothing at all: neither is a return.
    states = {name: columns.pop(name) == 0 for name in (CARTESIAN_STATE, SPHERICAL_STATE) if name in columns}
    if spherical is not None:
        there = spherical[:, 0] > 0
        there &= states.get(SPHERICAL_STATE, states.get(CARTESIAN_STATE, True))
        spherical = _cartesian(spherical)
    if cartesian is None:
        return spherical, there
    valid = nonzero & states.get(CARTESIAN_STATE, states.get(SPHERICAL_STATE, True))
    if spherical is not None:
        missing = there & ~valid
        if missing.any():
            cartesian[missing] = spherical[missing]
            valid |= missing
            warn("{count:,} points have spherical coordinates only; these were taken", count=np.count_nonzero(missing))
    return cartesian, valid


def _largest(columns):
    """(N,) greatest of the absolute values; NaN where one is."""
    return reduce(np.maximum, map(np.abs, columns))


def _reflectance(columns, header, valid, warn):
    """(N,) strength of each return or None, and (N,) bool, which of them have none among others that have."""
    unknown = columns.pop("isIntensityInvalid", None)
    unknown = np.zeros(len(valid), bool) if unknown is None else valid & (unknown != 0)
    strengths = [
        name for name in (header.strength, *columns) if name in columns and (name == header.strength or ":" in name)
    ]
    found = None
    for name in dict.fromkeys(strengths):
        values, own = columns.pop(name), name != "intensity"
        seen = values[valid] if own else values[valid & ~unknown]
        if seen.size and np.ptp(seen) > 0:
            if own:
                warn("its {field} is taken as the reflectance", field=name)
                return values, np.zeros(len(valid), bool)
            if unknown.any():
                warn("{count:,} points without intensity were taken as no return", count=np.count_nonzero(unknown))
            return values, unknown
        found = values if found is None and seen.size else found
    if unknown.any():
        warn("the intensity of {count:,} of its points is marked as invalid", count=np.count_nonzero(unknown))
    return found, np.zeros(len(valid), bool)


def _color(columns, header, warn):
    """(N, 3) uint8, or None."""
    invalid = columns.pop("isColorInvalid", None)
    if not header.has(COLOR):
        return None
    color = stacked([columns.pop(channel) for channel in COLOR])
    limits = [header.limits[channel] for channel in COLOR]
    scale = None if None in limits[0] or len(set(limits)) > 1 else limits[0]
    if invalid is not None:
        color[invalid != 0] = 0
    return scaled_colors(color, scale, warn)


def _indices(columns, header, warn):
    """(N,) row and (N,) column of each point: stored, or told by the order of the points in lines."""
    stored = {name: columns.pop(name) for name in INDEX if name in columns}
    if len(stored) == 2:
        return stored["rowIndex"], stored["columnIndex"]
    found = indices_of_lines(stored, header)
    if found is None:
        raise UnusableScan(
            "{file}: scan '{scan}' is unstructured (its points have no rowIndex and columnIndex); export it as PTX or "
            "as a structured (gridded) E57, or have a grid laid over its points: --grid angle, or Grid by Angle in "
            "the import dialog",
            **header.place,
        )
    warn("its points have no rows and columns of their own, but follow each other in lines; these were taken")
    return found


def _cartesian(spherical):
    """(N, 3) x y z of range, azimuth (counterclockwise from +X) and elevation, meters and radians."""
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
