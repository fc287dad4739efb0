"""From the columns of an E57 scan to stored grids, whichever of its many fields the file has."""

from dataclasses import replace
from functools import partial

import numpy as np

from ...messages import of_scan
from .angle import gridded_by_angle
from .colors import scaled_colors
from .e57_grid import IndexGrid
from .e57_header import CARTESIAN, CARTESIAN_STATE, COLOR, INDEX, SPHERICAL, SPHERICAL_STATE, unstructured
from .e57_thinning import Thinning
from .growing import Growing
from .lines import indices_of_lines
from .options import ANGLE
from .poses import quaternion_pose


class E57Points:
    """The points of a scan, kept in as little memory as their values allow, piece by piece.

    Parameters
    ----------
    header : E57Header
    options : ReadOptions
    with_cells : bool
        Whether it is to be known where each point of the file went.
    """

    def __init__(self, header, options, with_cells):
        self._header, self._options, count = header, options, header.count
        self._points, self._valid = Growing((count, 3), np.float64), Growing((count,), bool)
        self._color = Growing((count, 3), np.uint8) if header.has(COLOR) else None
        names = (*INDEX, "returnIndex")
        self._whole = {name: Growing((count,), np.int32) for name in names if header.has([name])}
        self._strengths = {
            name: Growing((count,), np.float32)
            for name in dict.fromkeys((header.strength, *header.fields))
            if name in header.fields and (name == header.strength or ":" in name)
        }
        self._unknown = Growing((count,), bool) if header.has(["isIntensityInvalid"]) else None
        self._only_spherical = 0
        by_numbers = header.has(INDEX) and options.grid != ANGLE
        self._thinning = Thinning(options.step, count, with_cells) if by_numbers and options.step > 1 else None
        self._with_cells = with_cells

    def add(self, columns):
        """Take the next points.

        Parameters
        ----------
        columns : dict of (n,) float64
            By the field's name; not kept.
        """
        if self._thinning is not None:
            kept = self._thinning.kept(columns["rowIndex"], columns["columnIndex"])
            columns = {name: values[kept] for name, values in columns.items()}
        # Values are taken as stored, NaN included: `finish_grid` sorts them out.
        with np.errstate(all="ignore"):
            points, valid, spherical = _coordinates(columns)
            self._only_spherical += spherical
            self._points.add(points)
            self._valid.add(valid)
            if self._color is not None:
                color = np.stack([columns[channel] for channel in COLOR], axis=-1)
                if "isColorInvalid" in columns:
                    color[columns["isColorInvalid"] != 0] = 0
                self._color.add(color, exactly=True)
            if self._unknown is not None:
                self._unknown.add(valid & (columns["isIntensityInvalid"] != 0))
            for name, kept in self._strengths.items():
                kept.add(columns[name])
            for name, kept in self._whole.items():
                kept.add(columns[name], exactly=True)

    def grids(self):
        """Return the keyword arguments of `finish_grid`, and where each point went.

        Returns
        -------
        stored : dict
        cells : callable or None
            Returns (N,) int64: pixel of every point of the file in the stored grid, row by row; -1 where it has none.

        Raises
        ------
        UnusableScan
            If the points have neither rows and columns nor lines.
        """
        header, options = self._header, self._options
        pose, warnings = quaternion_pose(header.quaternion, header.translation, header.name)

        def warn(template, **values):
            warnings.append(of_scan(header.name, template, **values))

        if self._only_spherical:
            warn("{count:,} points have spherical coordinates only; these were taken", count=self._only_spherical)
        points, valid = self._points.whole(), self._valid.whole()
        with np.errstate(all="ignore"):
            reflectance, invalid = self._reflectance(valid, warn)
            color = self._scaled_color(warn)
        if invalid is not None:
            valid &= ~invalid
        stored = {"name": header.name, "pose": pose, "warnings": warnings, "options": options}
        stored["places"] = {"matrix": pose[:3, 3]} if pose[:3, 3].any() else {}
        if options.grid == ANGLE:
            arrays, cells = gridded_by_angle(
                header, points, valid, reflectance, color, [np.zeros(3), pose[:3, 3]], options, warn
            )
            return stored | arrays, partial(np.asarray, cells)
        limits, taken = header.limits, None
        rows, columns = self._indices(warn)
        if self._thinning is not None:
            rows, columns, taken, limits = self._thinning.numbered(rows, columns, limits)
            stored["options"] = replace(options, step=1)
        if taken is not None:
            points, valid = points[taken], valid[taken]
            reflectance, color = (None if values is None else values[taken] for values in (reflectance, color))
        returns = self._whole.pop("returnIndex", None)
        returns = None if returns is None else returns.whole() if taken is None else returns.whole()[taken]
        grid = IndexGrid(rows, columns, limits, header)
        grid.place(valid, returns, points, reflectance, options.returns, warn)
        cells = None
        if self._with_cells:
            cells = partial(np.asarray, grid.cells()) if self._thinning is None else self._thinning.cells(grid)
        # Each is let go as soon as it is laid.
        self._points = self._valid = self._color = self._strengths = None
        stored["points"] = grid.spread(points)
        del points
        stored["valid"] = grid.spread(valid)
        stored["reflectance"] = None if reflectance is None else grid.spread(reflectance)
        stored["color"] = None if color is None else grid.spread(color)
        return stored, cells

    def _reflectance(self, valid, warn):
        """(N,) float32 strength of each return or None, and (N,) bool or None: which have none among others that
        have."""
        unknown = None if self._unknown is None else self._unknown.whole()
        some_unknown = unknown is not None and unknown.any()
        found = None
        for name, kept in self._strengths.items():
            values, own = kept.whole(), name != "intensity"
            seen = values[valid & ~unknown] if some_unknown and not own else values[valid]
            if seen.size and seen.max() - seen.min() > 0:
                if own:
                    warn("its {field} is taken as the reflectance", field=name)
                    return values, None
                if some_unknown:
                    warn("{count:,} points without intensity were taken as no return", count=np.count_nonzero(unknown))
                return values, unknown
            found = values if found is None and seen.size else found
        if some_unknown:
            warn("the intensity of {count:,} of its points is marked as invalid", count=np.count_nonzero(unknown))
        return found, None

    def _scaled_color(self, warn):
        """(N, 3) uint8, or None."""
        if self._color is None:
            return None
        limits = [self._header.limits[channel] for channel in COLOR]
        scale = None if None in limits[0] or len(set(limits)) > 1 else limits[0]
        return scaled_colors(self._color.whole(), scale, warn)

    def _indices(self, warn):
        """(N,) row and (N,) column of each point: stored, or told by the order of the points in lines."""
        stored = {name: self._whole.pop(name).whole() for name in INDEX if name in self._whole}
        if len(stored) == 2:
            return stored["rowIndex"], stored["columnIndex"]
        found = indices_of_lines(stored, self._header)
        if found is None:
            raise unstructured(self._header)
        warn("its points have no rows and columns of their own, but follow each other in lines; these were taken")
        return found


def _coordinates(columns):
    """(n, 3) points, (n,) which of them are returns, and how many are known by their spherical coordinates only."""
    # 1 is a direction without a distance, 2 nothing at all: neither is a return.
    states = {name: columns[name] == 0 for name in (CARTESIAN_STATE, SPHERICAL_STATE) if name in columns}
    spherical, cartesian = (
        np.stack([columns[axis] for axis in axes], axis=-1) if axes[0] in columns else None
        for axes in (SPHERICAL, CARTESIAN)
    )
    if spherical is not None:
        there = spherical[:, 0] > 0
        there &= states.get(SPHERICAL_STATE, states.get(CARTESIAN_STATE, True))
        spherical = _cartesian(spherical)
    if cartesian is None:
        return spherical, there, 0
    # No return has three zeros; what is not finite is sorted out later, so that it is counted.
    valid = (cartesian != 0).any(axis=-1) & states.get(CARTESIAN_STATE, states.get(SPHERICAL_STATE, True))
    if spherical is None:
        return cartesian, valid, 0
    missing = there & np.isfinite(spherical).all(axis=-1) & ~(valid & np.isfinite(cartesian).all(axis=-1))
    cartesian[missing] = spherical[missing]
    return cartesian, valid | missing, np.count_nonzero(missing)


def _cartesian(spherical):
    """(N, 3) x y z of range, azimuth (counterclockwise from +X) and elevation, meters and radians."""
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
