"""NumPy arrays: .npy and .npz with x, y, z, or with range and angles."""

import struct
import tokenize
import zipfile
import zlib

import numpy as np

from ...errors import ScanError
from ...messages import Message
from ...scan.directions import directions
from ...scan.limits import MOST_PIXELS
from ..gate import opened, size_of
from .cloud import check_size, scan_of_columns
from .formats import Format
from .options import AS_IT_IS

_MAGIC, _ZIP = b"\x93NUMPY", b"PK\x03\x04"
_POINTS = ("xyz", "points", "point_cloud", "cloud")
_RANGES = ("range", "ranges", "range_m", "distance", "depth_ray")
_AZIMUTHS, _ELEVATIONS = ("azimuth_deg", "azimuth"), ("elevation_deg", "elevation", "altitude")
_COLORS = ("color", "colors", "rgb")
_MOST_MEMBERS = 256
_PACKED_AT_MOST = 1100
_PACKED_BY = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DAMAGED = (
    *(ValueError, KeyError, TypeError, EOFError, NotImplementedError),
    *(SyntaxError, tokenize.TokenError, struct.error, zlib.error, zipfile.BadZipFile),
)
"""Errors of NumPy and zipfile for incomplete files; a failing disk is an OSError, which the gate reports."""
_ENCRYPTED = 1


def read_numpy(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read arrays of a grid: one value per pixel, row 0 on top.

    ``x``, ``y`` and ``z`` (H, W), or ``xyz`` (H, W, 3), in meters; or ``range`` (H, W) with ``azimuth`` (W,) or (H, W),
    to the right, and ``elevation`` (H,) or (H, W), up: in degrees under names that end in ``_deg``, else in radians.
    Whole numbers of a range are millimeters. ``reflectance``, ``intensity``, ``reflectivity`` or ``signal`` (H, W);
    ``color`` (H, W, 3). An (H, W, 4) array is x, y, z and reflectance. Parameters and errors are those of `read_scans`.
    """
    arrays = _arrays(file, path)
    if progress:
        progress(0.6, Message("Reading {file}", file=path.name))
    points = _points(arrays, path)
    shape = points.shape[:2] if points.ndim == 3 else None
    mask = arrays.get("valid")
    if mask is not None and mask.dtype == bool and mask.shape == points.shape[:-1]:
        points[~mask] = 0.0
    columns = dict(zip("xyz", points.reshape(-1, points.shape[-1]).T[:3], strict=True))
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
        arrays = _arrays(file, path)
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


def _arrays(file, path):
    """Arrays by name, in lower case; a .npy's has none. Sizes are held against the file before anything is read."""
    start = file.read(len(_MAGIC))
    file.seek(0)
    try:
        if start == _MAGIC:
            _check(file, size_of(file), path)
            file.seek(0)
            return _named(np.lib.format.read_array(file, allow_pickle=False))
        with zipfile.ZipFile(file) as archive:
            members = [member for member in archive.infolist() if member.filename.endswith(".npy")]
            if len(members) > _MOST_MEMBERS:
                raise ScanError("{file}: holds {count:,} arrays", file=path.name, count=len(members))
            if sum(member.file_size for member in members) > _PACKED_AT_MOST * size_of(file):
                raise ScanError("{file}: claims to hold more than a file of its size can", file=path.name)
            if any(member.flag_bits & _ENCRYPTED for member in members):
                raise ScanError("{file}: is encrypted; save it without a password", file=path.name)
            if any(member.compress_type not in _PACKED_BY for member in members):
                raise ScanError("{file}: uses a compression that NumPy does not write", file=path.name)
            found = {}
            for member in members:
                with archive.open(member) as data:
                    shape = _check(data, member.file_size, path)
                if len(shape) in (1, 2, 3):
                    with archive.open(member) as data:
                        found[member.filename[:-4].lower()] = np.lib.format.read_array(data, allow_pickle=False)
            return found
    except ScanError:
        raise
    except _DAMAGED as error:
        # Their texts are about Python, and quote the file at length.
        raise ScanError(
            "{file}: it is damaged or cut short, or holds something other than arrays of numbers", file=path.name
        ) from error


def _named(array):
    """An array as a dictionary: the fields of a table under their names."""
    if array.dtype.names:
        return {name.lower(): array[name] for name in array.dtype.names}
    return {"": array}


def _check(data, size, path):
    """See that the header of an array claims what its file can hold; return its shape."""
    version = np.lib.format.read_magic(data)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(data)
    count = int(np.prod(shape, dtype=object))
    if dtype.hasobject or count * dtype.itemsize > size or count > 4 * MOST_PIXELS:
        raise ScanError("{file}: one of its arrays claims more data than the file can hold", file=path.name)
    check_size(path, count // 3, 3)
    return shape


FORMAT = Format(
    name="NumPy",
    suffixes=(".npz", ".npy"),
    read=read_numpy,
    sniff=lambda start: start.startswith((_MAGIC, _ZIP)),
    about="x, y, z, or range with azimuth and elevation, each of the grid's size; reflectance, color",
)
