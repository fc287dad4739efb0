"""E57, structured: every point knows its row and column."""

import numpy as np

from ...errors import Cancelled, ScanError
from ..memory import require_memory
from .e57_file import check_header, native_errors, number_at, text_at
from .e57_grid import IndexGrid, in_8_bits
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_scan, with_problems
from .poses import quaternion_pose

_CHUNK = 1 << 18
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_COLOR = ("colorRed", "colorGreen", "colorBlue")
_INDEX = ("rowIndex", "columnIndex")


def read_e57(path, *, progress=None, cancelled=None):
    """Read every structured scan of an E57 file.

    Coordinates may be Cartesian or spherical and stay in the scan's own frame, apart from its pose. Pose, intensity
    limits, color limits, index bounds and invalid states are all optional. Intensity is kept as it is; colors are
    brought to 8 bits by their limits. Rows and columns are counted from the least that occurs, and may have holes.

    Parameters and errors are those of `read_scans`; a file with none but unstructured scans is a ScanError.
    """
    check_header(path)
    try:
        from pye57 import libe57
    except ImportError:
        raise ScanError(f"{path.name}: E57 needs pye57, which this platform has not; export the scan as PTX") from None

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
        stored = text_at(node, "name")
    stored = "".join(letter for letter in " ".join(stored.split()) if letter.isprintable())
    return stored or (path.stem if count == 1 else f"{path.stem} {index + 1}")


def _stored(path, file, node, name, tell):
    """Keyword arguments of `finish_scan`."""
    place = f"scan '{name}'"
    with native_errors(path):
        header = _Header(node, f"{path.name}: {place}")
    require_memory(
        header.count * (8 * len(header.fields) + BYTES_PER_PIXEL),
        f"{path.name}: {place}: {header.count:,} points",
        error=ScanError,
    )
    columns = _read_columns(path, file, header, tell)
    placed, warnings = quaternion_pose(header.quaternion, header.translation, place)
    # Whatever is stored, also what is no number: finish_scan sorts it out.
    with np.errstate(all="ignore"):
        xyz = np.stack([columns.pop(axis) for axis in header.axes], axis=-1)
        if header.axes is _SPHERICAL:
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
            color = np.stack([in_8_bits(columns.pop(channel), *header.limits[channel]) for channel in _COLOR], axis=-1)
            color[columns.pop("isColorInvalid", np.zeros(header.count)) != 0] = 0
    if faulty.any():
        warnings.append(f"{place}: {np.count_nonzero(faulty):,} points without intensity were taken as no return")
    grid = IndexGrid(columns.pop("rowIndex"), columns.pop("columnIndex"), header.limits, header.where)
    doubled = grid.place(valid)
    if doubled:
        warnings.append(f"{place}: {doubled:,} points share a pixel with an earlier one and were left out")
    return {
        "name": name,
        "points": grid.spread(xyz),
        "reflectance": grid.spread(columns["intensity"], np.float32) if "intensity" in columns else None,
        "valid": grid.spread(valid),
        "color": None if color is None else grid.spread(color),
        "pose": placed,
        "warnings": warnings,
    }


class _Header:
    """What a scan says about itself; all but the points and their rows and columns is optional.

    Raises UnusableScan if it has no points, no grid or no coordinates.
    """

    def __init__(self, node, where):
        from pye57 import libe57

        self.where = where
        self.points = node["points"] if node.isDefined("points") else None
        self.count = 0 if self.points is None else self.points.childCount()
        if self.count <= 0:
            raise UnusableScan(f"{where} has no points")
        prototype = libe57.StructureNode(self.points.prototype())
        present = {prototype.get(index).elementName() for index in range(prototype.childCount())}
        if not present.issuperset(_INDEX):
            raise UnusableScan(
                f"{where} is unstructured (its points have no rowIndex and columnIndex); "
                "export it as PTX or as a structured (gridded) E57"
            )
        self.axes = next((axes for axes in (_CARTESIAN, _SPHERICAL) if present.issuperset(axes)), None)
        if self.axes is None:
            raise UnusableScan(
                f"{where} has no coordinates that are known, expected cartesianX, Y, Z or sphericalRange, Azimuth, "
                "Elevation"
            )
        self.state = "sphericalInvalidState" if self.axes is _SPHERICAL else "cartesianInvalidState"
        self.color = present.issuperset(_COLOR)
        optional = present & {"intensity", "isIntensityInvalid", "isColorInvalid", self.state}
        self.fields = (*_INDEX, *self.axes, *(_COLOR if self.color else ()), *sorted(optional))
        self.limits = {field: _limits(node, prototype, field) for field in (*_COLOR, *_INDEX)}
        self.quaternion = _numbers_at(node, "rotation", {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0})
        self.translation = _numbers_at(node, "translation", {"x": 0.0, "y": 0.0, "z": 0.0})


def _numbers_at(node, part, defaults):
    """float64 array of a part of the pose, with the default for every number that it does not state."""
    stated = [number_at(node, "pose", part, axis) for axis in defaults]
    return np.array(
        [default if value is None else value for value, default in zip(stated, defaults.values(), strict=True)]
    )


def _read_columns(path, file, header, tell):
    """(N,) float64 for every field; float64 holds every integer that a file may have as row, column or color."""
    from pye57 import libe57

    count, fields = header.count, header.fields
    tell(0.0)
    buffers = {field: np.empty(min(_CHUNK, count)) for field in fields}
    columns = {field: np.empty(count) for field in fields}
    with native_errors(path):
        native = libe57.VectorSourceDestBuffer()
        for field, buffer in buffers.items():
            native.append(libe57.SourceDestBuffer(file, field, buffer, buffer.size, True, True))
        reader = header.points.reader(native)
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
        return number_at(node, "indexBounds", f"{kind}Minimum"), number_at(node, "indexBounds", f"{kind}Maximum")
    stated = [number_at(node, "colorLimits", f"{field}{end}") for end in ("Minimum", "Maximum")]
    if None in stated and prototype.isDefined(field):
        element = prototype[field]
        for low, high in (("scaledMinimum", "scaledMaximum"), ("minimum", "maximum")):
            if hasattr(element, low):
                return getattr(element, low)(), getattr(element, high)()
    return tuple(stated)


def _cartesian(spherical):
    """(N, 3) x y z of range, azimuth (counterclockwise from +X) and elevation, metres and radians."""
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
