"""NumPy arrays: .npy and .npz with x, y, z, or with range and angles."""

from dataclasses import replace

import numpy as np

from ...errors import ScanError
from ...messages import Message
from ...scan.directions import directions
from ..gate import opened
from .cloud import scan_of_columns
from .formats import Format
from .numpy_file import MAGIC, ZIP, NumpyFile
from .options import ANGLE, AS_IT_IS

_POINTS = ("xyz", "points", "point_cloud", "cloud")
_RANGES = ("range", "ranges", "range_m", "distance", "depth_ray")
_AZIMUTHS, _ELEVATIONS = ("azimuth_deg", "azimuth"), ("elevation_deg", "elevation", "altitude")
_COLORS = ("color", "colors", "rgb")


def read_numpy(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read arrays of a grid: one value per pixel, row 0 on top.

    ``x``, ``y`` and ``z`` (H, W), or ``xyz`` (H, W, 3), in meters; or ``range`` (H, W) with ``azimuth`` (W,) or (H, W),
    to the right, and ``elevation`` (H,) or (H, W), up: in degrees under names that end in ``_deg``, else in radians.
    Whole numbers of a range are millimeters. ``reflectance``, ``intensity``, ``reflectivity`` or ``signal`` (H, W);
    ``color`` (H, W, 3). An (H, W, 4) array is x, y, z and reflectance. Parameters and errors are those of `read_scans`.
    """
    step = 1 if options.grid == ANGLE else options.step
    arrays = NumpyFile(file, path, progress, cancelled).arrays(_thinning(step) if step > 1 else None)
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
    return [scan_of_columns(path, columns, options=options, shape=shape)]


def array_of(path, member):
    """Return one array of a .npy or .npz by its name; the only one where no name is given.

    Raises
    ------
    ScanError
        In one line.
    """
    with opened(path, Message("NumPy arrays"), error=ScanError) as file:
        arrays = NumpyFile(file, path).arrays()
    found = arrays.get(member.lower()) if member else next(iter(arrays.values()), None) if len(arrays) == 1 else None
    if found is None or found.dtype.kind not in "fiu":
        raise ScanError(
            "{file}: has no array {member} of numbers, it holds {found}",
            file=path.name,
            member=member or Message("of its own"),
            found=", ".join(sorted(arrays)) or Message("nothing"),
        )
    return found


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
        raise ScanError(
            "{file}: expected x, y and z, or range with azimuth and elevation; it holds {found}. Where there are no "
            "angles, a .scan.json beside it can give them (docs/formats.md)",
            file=path.name,
            found=", ".join(sorted(arrays)) or Message("nothing"),
        )
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


def _angles(arrays, names):
    """Degrees, under the first of the names that is there."""
    name = next((name for name in names if name in arrays), None)
    if name is None or arrays[name].dtype.kind not in "fiu":
        return None
    return arrays[name].astype(np.float64) if name.endswith("_deg") else np.degrees(arrays[name].astype(np.float64))


def _thinning(step):
    """Which part to read of arrays of a grid, and of the angles of its rows and columns; see `NumpyFile.arrays`."""

    def wanted(shapes):
        names = [name for name in (*_POINTS, "") if len(shapes.get(name, ())) == 3]
        names += [name for name in ("x", *_RANGES) if len(shapes.get(name, ())) == 2]
        if not names:
            return {}
        height, width = shapes[names[0]][:2]
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
    sniff=lambda start: start.startswith((MAGIC, ZIP)),
    about="x, y, z, or range with azimuth and elevation, each of the grid's size; reflectance, color",
)
