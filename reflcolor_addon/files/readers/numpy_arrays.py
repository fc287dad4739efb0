"""NumPy arrays: .npy and .npz with x, y, z, or with range and angles."""

from dataclasses import replace

import numpy as np

from ...errors import ScanError
from ...messages import Message, of_scan
from ...scan.directions import directions
from ..gate import opened
from .cloud import require_grid, scan_of_columns
from .formats import Format
from .numpy_file import MAGIC, ZIP, NumpyFile
from .options import ANGLE, AS_IT_IS, pixels_kept

_POINTS = ("xyz", "points", "point_cloud", "cloud")
_RANGES = ("range", "ranges", "range_m", "distance", "depth_ray")
_AZIMUTHS, _ELEVATIONS = ("azimuth_deg", "azimuth"), ("elevation_deg", "elevation", "altitude")
_COLORS = ("color", "colors", "rgb")
_FEWEST_COLUMNS = 8
_UNEVEN = 0.2
"""How far, in steps, an azimuth may be from a whole number of them."""


def read_numpy(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read arrays of a grid: one value per pixel, row 0 on top.

    ``x``, ``y`` and ``z`` (H, W), or ``xyz`` (H, W, 3), in meters; or ``range`` (H, W) with ``azimuth`` (W,) or (H, W),
    to the right, and ``elevation`` (H,) or (H, W), up: in degrees under names that end in ``_deg``, else in radians.
    Whole numbers of a range are millimeters. ``reflectance``, ``intensity``, ``reflectivity`` or ``signal`` (H, W);
    ``color`` (H, W, 3). An (H, W, 4) array is x, y, z and reflectance. Parameters and errors are those of `read_scans`.
    """
    step = 1 if options.grid == ANGLE else options.step
    thinning = _thinning(step) if step > 1 else None
    arrays = NumpyFile(file, path, progress, cancelled).arrays(thinning)
    arrays, warnings = _with_missing_columns(arrays, path.stem)
    if thinning and _by_angles(shapes := {name: array.shape for name, array in arrays.items()}):
        arrays = {name: arrays[name][part].copy() for name, part in thinning(shapes, and_angles=True).items()}
    points = _points(arrays, path)
    shape = points.shape[:2] if points.ndim == 3 else None
    mask = arrays.get("valid")
    if mask is not None and mask.dtype == bool and mask.shape == points.shape[:-1]:
        points[~mask] = 0.0
    if shape is not None:
        options = replace(options, step=options.step // step)
    columns = {"xyz": points[..., :3].reshape(-1, 3)}
    if points.shape[-1] > 3:
        columns["reflectance"] = points.reshape(-1, points.shape[-1])[:, 3]
    size = points.shape[:-1]
    for name, array in arrays.items():
        if array.shape == size and array.dtype.kind in "fiu" and name not in columns:
            columns[name] = array.ravel()
        elif name in _COLORS and array.shape == (*size, 3):
            columns |= dict(zip(("red", "green", "blue"), array.reshape(-1, 3).T, strict=True))
    return [scan_of_columns(path, columns, options=options, shape=shape, warnings=warnings)]


def numpy_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the pixels of arrays of a grid, without the columns that their azimuths leave out; see `scan_pixels`."""
    shapes = NumpyFile(file, path).shapes()
    size, angles = _grid_size(shapes), [any(name in shapes for name in names) for names in (_AZIMUTHS, _ELEVATIONS)]
    if size is not None and (all(angles) or not _by_angles(shapes)):
        return pixels_kept([size[0] * size[1]], options)
    points = next((shapes[name] for name in (*_POINTS, "", "x") if name in shapes), None)
    if points is None:
        raise _unknown(shapes, path)
    names = [name for name, shape in shapes.items() if shape == points[:1]]
    require_grid(path, [*names, "xyz"], options=options)
    return pixels_kept([points[0]], options)


def array_shape(path, member):
    """Return the shape of what `array_of` returns, without reading it; raises as it does."""
    with opened(path, Message("NumPy arrays"), error=ScanError) as file:
        return _member(NumpyFile(file, path).shapes(), member, path)


def array_of(path, member):
    """Return one array of a .npy or .npz by its name; the only one where no name is given.

    Raises
    ------
    ScanError
        In one line.
    """
    with opened(path, Message("NumPy arrays"), error=ScanError) as file:
        arrays = NumpyFile(file, path).arrays()
    found = _member(arrays, member, path)
    if found.dtype.kind not in "fiu":
        raise _without_member(arrays, member, path)
    return found


def _member(arrays, member, path):
    """What there is of one array by its name; the only one where no name is given."""
    found = arrays.get(member.lower()) if member else next(iter(arrays.values()), None) if len(arrays) == 1 else None
    if found is None:
        raise _without_member(arrays, member, path)
    return found


def _without_member(arrays, member, path):
    return ScanError(
        "{file}: has no array {member} of numbers, it holds {found}",
        file=path.name,
        member=member or Message("of its own"),
        found=", ".join(sorted(arrays)) or Message("nothing"),
    )


def _points(arrays, path):
    """(H, W, 3 or 4) or (N, 3 or 4) float64."""
    found = next((arrays[name] for name in (*_POINTS, "") if name in arrays), None)
    if found is None and {"x", "y", "z"} <= arrays.keys():
        parts = [arrays[axis] for axis in "xyz"]
        if len({part.shape for part in parts}) != 1:
            raise ScanError("{file}: x, y and z differ in size", file=path.name)
        found = np.stack(parts, axis=-1)
    if found is None:
        found = _of_angles(arrays, path)
    if found.ndim not in (2, 3) or found.shape[-1] not in (3, 4) or found.dtype.kind not in "fiu":
        raise ScanError(
            "{file}: holds an array of {shape}, expected rows x columns x 3 (x, y, z) or 4 (and reflectance)",
            file=path.name,
            shape=" x ".join(map(str, found.shape)),
        )
    return found.astype(np.float64)


def _of_angles(arrays, path):
    distance = next((arrays[name] for name in _RANGES if name in arrays), None)
    azimuth, elevation = (_angles(arrays, names) for names in (_AZIMUTHS, _ELEVATIONS))
    if distance is None or azimuth is None or elevation is None or distance.ndim != 2:
        raise _unknown(arrays, path)
    height, width = distance.shape
    if azimuth.shape == (width,) and elevation.shape == (height,):
        rays = directions(azimuth, elevation)
    elif azimuth.size == 1 or elevation.size == 1 or azimuth.ndim > 2 or elevation.ndim > 2:
        raise ScanError("{file}: azimuth and elevation do not fit the range's size", file=path.name)
    else:
        elevation = elevation[:, None] if elevation.shape == (height,) else elevation
        try:
            up, right = np.broadcast_arrays(np.radians(elevation), np.radians(azimuth))
        except ValueError:
            right = np.empty(0)
        if right.shape != distance.shape:
            raise ScanError("{file}: azimuth and elevation do not fit the range's size", file=path.name)
        rays = np.stack([np.cos(up) * np.sin(right), np.cos(up) * np.cos(right), np.sin(up)], axis=-1)
    meters = distance.astype(np.float64) * (0.001 if distance.dtype.kind in "iu" else 1.0)
    with np.errstate(invalid="ignore"):
        return rays * np.where(np.isfinite(meters) & (meters > 0), meters, 0.0)[..., None]


def _unknown(arrays, path):
    return ScanError(
        "{file}: expected x, y and z, or range with azimuth and elevation; it holds {found}. Where there are no "
        "angles, a .scan.json beside it can give them (docs/formats.md)",
        file=path.name,
        found=", ".join(sorted(arrays)) or Message("nothing"),
    )


def _angles(arrays, names):
    """Degrees, under the first of the names that is there."""
    name = next((name for name in names if name in arrays), None)
    if name is None or arrays[name].dtype.kind not in "fiu":
        return None
    return arrays[name].astype(np.float64) if name.endswith("_deg") else np.degrees(arrays[name].astype(np.float64))


def _with_missing_columns(arrays, name):
    """Arrays with empty columns where the azimuths leave some out, so that what is far apart is not joined; what is to
    be said of it."""
    key = next((key for key in _AZIMUTHS if key in arrays), None)
    shape = next((arrays[key].shape for key in _RANGES if key in arrays), ())
    if key is None or len(shape) != 2 or arrays[key].shape != shape[1:] or shape[1] < _FEWEST_COLUMNS:
        return arrays, []
    turn = 360.0 if key.endswith("_deg") else 2 * np.pi
    azimuth = np.unwrap(arrays[key].astype(np.float64), period=turn)
    steps = np.diff(azimuth)
    usual = np.median(steps)
    if not (np.isfinite(steps).all() and usual):
        return arrays, []
    columns = np.rint(steps / usual)
    width = int(columns.sum()) + 1
    even = (np.abs(steps / usual - columns) < _UNEVEN).all() and columns.min() == 1
    if not even or not shape[1] < width <= abs(turn / usual) + 1:
        return arrays, []
    places = np.concatenate([[0], np.cumsum(columns)]).astype(np.int64)
    found = dict(arrays)
    for other, array in arrays.items():
        if array.shape[:2] == shape:
            found[other] = np.zeros((shape[0], width, *array.shape[2:]), array.dtype)
            found[other][:, places] = array
    found[key] = np.interp(np.arange(width), places, azimuth)
    missing = width - shape[1]
    return found, [
        of_scan(name, "{count:,} columns between its azimuths are missing; they were left empty", count=missing)
    ]


def _by_angles(shapes):
    """Whether points are given by ranges and angles."""
    return not any(name in shapes for name in (*_POINTS, "", "x")) and any(name in shapes for name in _RANGES)


def _grid_size(shapes):
    """Rows and columns of the grid that arrays of these shapes have; None where there is none."""
    names = [name for name in (*_POINTS, "") if len(shapes.get(name, ())) == 3]
    names += [name for name in ("x", *_RANGES) if len(shapes.get(name, ())) == 2]
    return shapes[names[0]][:2] if names else None


def _thinning(step):
    """Which part to read of arrays of a grid, and of the angles of its rows and columns; see `NumpyFile.arrays`."""

    def wanted(shapes, and_angles=False):
        if _by_angles(shapes) and not and_angles:
            # Columns may be missing, so they are counted when the azimuths are known; ranges take little memory.
            return {}
        size = _grid_size(shapes)
        if size is None:
            return {}
        height, width = size
        every = slice(None, None, step)
        parts = {name: (every, every) for name, shape in shapes.items() if shape[:2] == (height, width)}
        lines = ((_AZIMUTHS, width), (_ELEVATIONS, height))
        parts |= {name: (every,) for angles, size in lines for name in angles if shapes.get(name) == (size,)}
        return parts

    return wanted


FORMAT = Format(
    name="NumPy",
    suffixes=(".npz", ".npy"),
    read=read_numpy,
    pixels=numpy_pixels,
    sniff=lambda start: start.startswith((MAGIC, ZIP)),
    about="x, y, z, or range with azimuth and elevation, each of the grid's size; reflectance, color",
)
