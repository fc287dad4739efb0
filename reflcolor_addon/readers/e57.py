"""E57, structured: every point knows its row and column."""

import math

import numpy as np

from ..errors import Cancelled, ScanError
from ..memory import require_memory
from .e57_file import check_header, native_errors, value_at
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_scan, with_problems
from .poses import quaternion_pose

_CHUNK = 1 << 18
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_COLOR = ("colorRed", "colorGreen", "colorBlue")
_INDEX = ("rowIndex", "columnIndex")
_CELLS_PER_POINT = 1000
"""A grid emptier than this is no scan: its row or column numbers are wrong."""


def read_e57(path, *, progress=None, cancelled=None):
    """Read every structured scan of an E57 file.

    Coordinates may be Cartesian or spherical and stay in the scan's own frame, apart from its pose. Pose, intensity
    limits, color limits, index bounds and invalid states are all optional. Intensity is kept as it is; colors are
    brought to 8 bits by their limits. Rows and columns are counted from the least that occurs, and may have holes.

    Parameters and errors are those of `read_scans`; a file with none but unstructured scans is a ScanError.
    """
    check_header(path)
    from pye57 import libe57

    with native_errors(path):
        file = libe57.ImageFile(str(path), "r")
    try:
        with native_errors(path):
            root = file.root()
            data3d = root["data3D"] if root.isDefined("data3D") else ()
            nodes = [data3d[index] for index in range(len(data3d))]
        if not nodes:
            raise ScanError(f"{path.name}: holds no scan")
        finished, problems = [], []
        for index, node in enumerate(nodes):
            name = _name(path, node, index, len(nodes))

            def tell(fraction, index=index, name=name):
                if cancelled and cancelled():
                    raise Cancelled
                if progress:
                    progress((index + fraction) / len(nodes), f"Reading {path.name}: {name}")

            try:
                finished.append(finish_scan(source=path, **_stored(path, file, node, name, tell)))
            except UnusableScan as error:
                problems.append(error)
    finally:
        file.close()
    return with_problems(finished, problems, len(nodes), path)


def _name(path, node, index, count):
    with native_errors(path):
        stored = value_at(node, "name")
    stored = " ".join(stored.split()) if isinstance(stored, str) else ""
    return stored or (path.stem if count == 1 else f"{path.stem} {index + 1}")


def _stored(path, file, node, name, tell):
    """Keyword arguments of `finish_scan`."""
    from pye57 import libe57

    place = f"scan '{name}'"
    with native_errors(path):
        if not node.isDefined("points"):
            raise UnusableScan(f"{path.name}: {place} has no points")
        points = node["points"]
        count = points.childCount()
        prototype = libe57.StructureNode(points.prototype())
        limits = {field: _limits(node, prototype, field) for field in (*_COLOR, *_INDEX)}
        present = {prototype.get(index).elementName() for index in range(prototype.childCount())}
        quaternion = [value_at(node, "pose", "rotation", axis) for axis in "wxyz"]
        translation = [value_at(node, "pose", "translation", axis) for axis in "xyz"]
    if count <= 0:
        raise UnusableScan(f"{path.name}: {place} has no points")
    if not present.issuperset(_INDEX):
        raise UnusableScan(
            f"{path.name}: {place} is unstructured (its points have no rowIndex and columnIndex); "
            "export it as PTX or as a structured (gridded) E57"
        )
    xyz = next((system for system in (_CARTESIAN, _SPHERICAL) if present.issuperset(system)), None)
    if xyz is None:
        raise UnusableScan(
            f"{path.name}: {place} has no coordinates that are known, expected cartesianX, Y, Z or "
            "sphericalRange, Azimuth, Elevation"
        )
    spherical = xyz is _SPHERICAL
    state = "sphericalInvalidState" if spherical else "cartesianInvalidState"
    color = _COLOR if present.issuperset(_COLOR) else ()
    optional = {"intensity", "isIntensityInvalid", "isColorInvalid", state} & present
    fields = (*_INDEX, *xyz, *color, *sorted(optional))
    require_memory(
        count * (8 * len(fields) + BYTES_PER_PIXEL), f"{path.name}: {place}: {count:,} points", error=ScanError
    )
    columns = _read_columns(path, file, points, fields, count, tell)
    placed, warnings = quaternion_pose(
        np.array(
            [default if value is None else value for value, default in zip(quaternion, (1, 0, 0, 0), strict=True)],
            np.float64,
        ),
        np.array([value or 0.0 for value in translation], np.float64),
        place,
    )
    xyz = np.stack([columns.pop(axis) for axis in xyz], axis=-1)
    valid = xyz.any(axis=-1)
    if state in columns:
        # 1 is a direction without a distance, 2 nothing at all: neither is a return.
        valid &= columns.pop(state) == 0
    if spherical:
        valid &= xyz[:, 0] > 0
        xyz = _cartesian(xyz)
    if "isIntensityInvalid" in columns:
        faulty = valid & (columns.pop("isIntensityInvalid") != 0)
        if faulty.any():
            warnings.append(f"{place}: {np.count_nonzero(faulty)} points without intensity were taken as no return")
        valid &= ~faulty
    rgb = None
    if color:
        rgb = np.stack([_in_8_bits(columns.pop(channel), *limits[channel]) for channel in color], axis=-1)
        if "isColorInvalid" in columns:
            rgb[columns.pop("isColorInvalid") != 0] = 0
    grid = _Grid(path, place, columns.pop("rowIndex"), columns.pop("columnIndex"), limits)
    cells = grid.cells(valid, warnings)
    return {
        "name": name,
        "points": grid.spread(xyz, cells),
        "reflectance": grid.spread(columns["intensity"], cells, np.float32) if "intensity" in columns else None,
        "valid": grid.spread(valid, cells),
        "color": None if rgb is None else grid.spread(rgb, cells),
        "pose": placed,
        "warnings": warnings,
    }


class _Grid:
    """Where in a grid of rows and columns the points of a file belong."""

    def __init__(self, path, place, rows, columns, limits):
        self._where = f"{path.name}: {place}"
        first_row, height = self._extent(rows, "rowIndex", limits)
        first_column, width = self._extent(columns, "columnIndex", limits)
        if height * width > _CELLS_PER_POINT * (len(rows) + 1000):
            raise ScanError(
                f"{self._where}: its row and column numbers span {height:,} x {width:,} pixels for "
                f"{len(rows):,} points; export it again as a gridded E57 or as PTX"
            )
        require_memory(
            height * width * BYTES_PER_PIXEL, f"{self._where}: {height} rows x {width} columns", error=ScanError
        )
        self.shape = (height, width)
        self._flat = (rows - first_row).astype(np.int64) * width + (columns - first_column).astype(np.int64)

    def _extent(self, index, field, limits):
        """First number and count. The file's own bounds are believed where they hold all points and are not absurd."""
        if not np.isfinite(index).all() or (index != np.floor(index)).any() or np.abs(index).max() > 2**40:
            raise ScanError(f"{self._where}: {field} holds what is no whole number; export it as PTX")
        first, last = int(index.min()), int(index.max())
        low, high = limits[field]
        if (
            low is not None
            and high is not None
            and low <= first
            and last <= high
            and high - low < 2 * (last - first + 1)
        ):
            first, last = math.ceil(low), math.floor(high)
        return first, last - first + 1

    def cells(self, valid, warnings):
        """Point and pixel of every pixel's point: of several the first of the file that is a return."""
        points = np.flatnonzero(valid)
        pixels, first = np.unique(self._flat[points], return_index=True)
        if (doubled := points.size - pixels.size) > 0:
            if doubled > 0.5 * points.size:
                raise ScanError(
                    f"{self._where}: rowIndex and columnIndex do not tell its points apart ({points.size:,} points, "
                    f"{pixels.size:,} pixels); export it as PTX or as a structured (gridded) E57"
                )
            warnings.append(
                f"{self._where.partition(': ')[2]}: {doubled:,} points share a pixel with an earlier one "
                "and were left out"
            )
        return points[first], pixels

    def spread(self, values, cells, dtype=None):
        """(H, W, ...) grid of the values of the points; zeros elsewhere."""
        points, pixels = cells
        grid = np.zeros((self.shape[0] * self.shape[1], *values.shape[1:]), dtype or values.dtype)
        with np.errstate(over="ignore"):
            grid[pixels] = values[points]
        return grid.reshape(*self.shape, *values.shape[1:])


def _read_columns(path, file, points, fields, count, tell):
    """(N,) float64 for every field; float64 holds every integer that a file may have as row, column or color."""
    from pye57 import libe57

    tell(0.0)
    buffers = {field: np.empty(min(_CHUNK, count)) for field in fields}
    columns = {field: np.empty(count) for field in fields}
    with native_errors(path):
        native = libe57.VectorSourceDestBuffer()
        for field, buffer in buffers.items():
            native.append(libe57.SourceDestBuffer(file, field, buffer, buffer.size, True, True))
        reader = points.reader(native)
    try:
        at = 0
        while at < count:
            with native_errors(path):
                done = reader.read()
            if not 0 < done <= count - at:
                raise ScanError(f"{path.name}: holds {at:,} points where {count:,} were announced; it is damaged")
            for field, buffer in buffers.items():
                columns[field][at : at + done] = buffer[:done]
            at += done
            tell(at / count)
    finally:
        with native_errors(path):
            reader.close()
    return columns


def _limits(node, prototype, field):
    """(low, high) that a file states for a field, each None where it states none."""
    if field in _INDEX:
        kind = field.removesuffix("Index")
        return value_at(node, "indexBounds", f"{kind}Minimum"), value_at(node, "indexBounds", f"{kind}Maximum")
    stated = [value_at(node, "colorLimits", f"{field}{end}") for end in ("Minimum", "Maximum")]
    if None in stated and prototype.isDefined(field):
        element = prototype[field]
        for low, high in (("scaledMinimum", "scaledMaximum"), ("minimum", "maximum")):
            if hasattr(element, low):
                return getattr(element, low)(), getattr(element, high)()
    return tuple(stated)


def _in_8_bits(values, low, high):
    """Colors brought to 0..255 by the limits of their file.

    Limits that lie within 0..255 and go beyond its half say that the file counts in 8 bits, whether they are the
    ends of the scale or the least and greatest that occur.
    """
    usable = low is not None and high is not None and np.isfinite([low, high]).all() and 0 < high - low <= 2**32
    if not usable:
        low, high = 0, 255 if np.nanmax(values, initial=0) <= 255 else 65535
    elif low >= 0 and 128 <= high <= 255:
        low, high = 0, 255
    scaled = (np.nan_to_num(values, nan=low) - low) * (255 / (high - low))
    return np.round(np.clip(scaled, 0, 255)).astype(np.uint8)


def _cartesian(spherical):
    """(N, 3) x y z of range, azimuth (counterclockwise from +X) and elevation, metres and radians."""
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
