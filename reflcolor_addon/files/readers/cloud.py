"""From named columns of points, as many formats hold them, to a Scan."""

from dataclasses import dataclass

import numpy as np

from ...errors import ScanError
from ...messages import Message, of_scan
from ..memory import require_memory
from .angle import gridded_by_angle
from .colors import scaled_colors, stacked
from .e57_grid import IndexGrid
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_scan
from .options import ANGLE, LIGHTER
from .settle import NO_ROWS

_STRENGTHS = (
    "reflectance",
    "intensity",
    "reflectivity",
    "scalar_reflectance",
    "scalar_intensity",
    "remission",
    "amplitude",
    "signal",
    "i",
)
"""What files call the strength of a return, the best first."""

_BY_ANGLE = 64
"""What laying a grid by angle takes more, in bytes a point."""

_COLORS = (
    ("red", "green", "blue"),
    ("r", "g", "b"),
    ("diffuse_red", "diffuse_green", "diffuse_blue"),
    # CloudCompare's colors as numbers from 0 to 1.
    ("rf", "gf", "bf"),
)
_GRIDS = (("grid_row", "grid_col"), ("rowindex", "columnindex"), ("row", "col"), ("row", "column"))


@dataclass(frozen=True, kw_only=True)
class Place:
    """The file and the scan that messages are about."""

    file_name: str
    name: str

    @property
    def place(self):
        """Values of messages."""
        return {"file": self.file_name, "scan": self.name}


def check_size(path, count, columns=8, *, by_angle=False):
    """Raise ScanError if so many points do not fit into memory.

    ``python -m benchmarks.reading --memory`` prints what is asked for here, and what reading takes.
    """
    require_memory(
        count * (8 * columns + BYTES_PER_PIXEL + (_BY_ANGLE if by_angle else 0)),
        Message("{file}: {count:,} points", file=path.name, count=count),
        way=LIGHTER,
        error=ScanError,
    )


def require_grid(path, names, *, options, shape=None, name=None):
    """Raise UnusableScan where the names of a file's columns, and the size of its grid, show that they are no scan."""
    names = {name.lower() for name in names}
    place = Place(file_name=path.name, name=name or path.stem).place
    if not names & {"xyz"} and not names >= {"x", "y", "z"}:
        raise UnusableScan("{file}: scan '{scan}' has no coordinates x, y and z", **place)
    has_grid = (shape is not None and min(shape) > 1) or any(names >= set(pair) for pair in _GRIDS)
    if options.grid != ANGLE and not has_grid:
        raise UnusableScan("{file}: scan '{scan}' {problem}", problem=NO_ROWS, **place)


def scan_of_columns(path, columns, *, options, name=None, shape=None, pose=None, named=(), warnings=()):
    """Make a Scan of columns of points.

    Parameters
    ----------
    path : Path
    columns : dict of (N,) arrays
        By name, in lower case. ``x``, ``y`` and ``z``, or ``xyz`` (N, 3), which may be changed; a strength, colors,
        rows and columns where there are any. Is empty afterward, so that none of them takes memory longer than needed.
    options : ReadOptions
    name : str, optional
        Of the scan; the file's stem unless given.
    shape : (H, W), optional
        Of the grid that the points fill row by row.
    pose : (4, 4) float64, optional
        Points to world.
    named : sequence of (3,) float64
        Where the scanner may have stood, for points without a grid.
    warnings : sequence of str

    Raises
    ------
    UnusableScan
        If there are no coordinates, no return, or no grid.
    """
    header = Place(file_name=path.name, name=name or path.stem)
    warnings = list(warnings)

    def warn(template, **values):
        warnings.append(of_scan(header.name, template, **values))

    if "xyz" in columns:
        points = np.ascontiguousarray(columns["xyz"], np.float64)
    elif {"x", "y", "z"} <= columns.keys():
        points = np.stack([np.asarray(columns[axis], np.float64) for axis in "xyz"], axis=-1)
    else:
        raise UnusableScan("{file}: scan '{scan}' has no coordinates x, y and z", **header.place)
    with np.errstate(invalid="ignore"):
        valid = np.isfinite(points).all(axis=-1) & (points != 0).any(axis=-1)
    strength = next((columns[key] for key in _STRENGTHS if key in columns), None)
    names = next((names for names in _COLORS if columns.keys() >= set(names)), None)
    color = None if names is None else scaled_colors(stacked([columns[key] for key in names]), None, warn)
    grid_names = next((names for names in _GRIDS if columns.keys() >= set(names)), None)
    places = grid_names and [np.array(columns[key], np.float64) for key in grid_names]
    # A copy, because a part of a larger table would keep all of it.
    strength = None if strength is None else np.array(strength)
    columns.clear()
    pose = np.eye(4) if pose is None else pose
    common = {"pose": pose, "warnings": warnings, "options": options, "name": header.name, "source": path}
    common["places"] = {"matrix": pose[:3, 3]} if pose[:3, 3].any() else {}
    if options.grid == ANGLE:
        seen_from = [np.zeros(3), *named, *common["places"].values()]
        arrays, _ = gridded_by_angle(header, points, valid, strength, color, seen_from, options, warn)
        return finish_scan(**common, **arrays)
    if shape is not None and min(shape) > 1:

        def grid(values, dtype=None):
            return None if values is None else np.asarray(values, dtype).reshape(*shape, *values.shape[1:])

        arrays = {"points": grid(points), "valid": grid(valid), "color": grid(color)}
        return finish_scan(**common, **arrays, reflectance=grid(strength, np.float32))
    if places is not None:
        rows, cols = places
        limits = dict.fromkeys(("rowIndex", "columnIndex"), (None, None))
        laid = IndexGrid(rows, cols, limits, header)
        laid.place(valid, None, points, strength, options.returns, warn)
        arrays = {"points": laid.spread(points), "valid": laid.spread(valid)}
        arrays["color"] = None if color is None else laid.spread(color)
        arrays["reflectance"] = None if strength is None else laid.spread(np.asarray(strength), np.float32)
        return finish_scan(**common, **arrays)
    raise UnusableScan("{file}: scan '{scan}' {problem}", problem=NO_ROWS, **header.place)
