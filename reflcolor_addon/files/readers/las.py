"""LAS and LAZ: points without a grid, as aerial and mobile programs and many converters write them."""

import importlib
import struct
import sys
from pathlib import Path

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message, one_line
from ...scan.limits import MOST_PIXELS
from ..confined.reading import ConfinedReading, native_library
from ..gate import size_of
from .cloud import check_size, require_grid, scan_of_columns
from .formats import Format
from .options import ANGLE, AS_IT_IS, pixels_kept

SCRIPT = Path(__file__).resolve().parent.parent / "confined" / "laz_points.py"
_MAGIC = b"LASF"
# Offset to the points, number of records before them, point format, size of a record, number of points.
_HEAD = struct.Struct("<96xIIBHI")
_SHORTEST_RECORD_BEFORE, _COMPRESSED = 54, 0x80
_LASZIP = ("laszip encoded", 22204)
_RECORDS = 1 << 20
# What the child may take: the library and its buffers. Seconds of the processor: far more than the slowest needs.
_BASE_BYTES, _BASE_SECONDS, _POINTS_PER_SECOND = 1 << 28, 15, 100_000
_NEVER_COLUMNS = ("x", "y", "z", "red", "green", "blue", "intensity")


def read_las(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read the points of a LAS or LAZ; what makes a scan of them is a grid by angle, or rows and columns among them.

    Coordinates are in meters, as the file's scale and offset say; colors of 16 bits come down to 8. Fields beyond the
    standard's own are known by their names, such as ``grid_row`` and ``grid_col``. Parameters and errors are those of
    `read_scans`.
    """

    def report(fraction):
        if cancelled and cancelled():
            raise Cancelled
        if progress:
            progress(fraction, Message("Reading {file}", file=path.name))

    report(0.0)
    header = _header(file, path)
    count, record = header.point_count, header.point_format.size
    # The records, and of these in columns: coordinates, intensity, colors, and fields beyond the standard's.
    columns = record // 8 + 7 + len(list(header.point_format.extra_dimensions))
    check_size(path, count, columns, by_angle=options.grid == ANGLE)
    if header.are_points_compressed:
        data = _decompressed(file, path, header, report, cancelled)
    else:
        data = _stored(file, path, header, report)
    return [scan_of_columns(path, _columns(data, header), options=options)]


def las_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the points of a LAS or LAZ; see `scan_pixels`."""
    header = _header(file, path)
    names = [name.replace(" ", "_") for name in header.point_format.dimension_names]
    require_grid(path, names, options=options)
    return pixels_kept([header.point_count], options)


def imported_laspy():
    """Import laspy without requests, which only files on servers need, and which opens a socket when imported.

    Raises
    ------
    ImportError
        If laspy is missing.
    """
    if "laspy" in sys.modules or "requests" in sys.modules:
        return importlib.import_module("laspy")
    sys.modules["requests"] = None  # This makes the import fail.
    try:
        return importlib.import_module("laspy")
    finally:
        del sys.modules["requests"]


def _header(file, path):
    """The laspy.LasHeader of a file, which fits the file."""
    try:
        laspy = imported_laspy()
    except ImportError:
        raise ScanError("{file}: LAS needs laspy, which is missing; export its points as E57", file=path.name) from None
    start = file.read(_HEAD.size)
    if not start.startswith(_MAGIC):
        raise ScanError("{file}: not a LAS file (it does not begin with LASF)", file=path.name)
    damaged = ScanError("{file}: its header does not fit the file; it is damaged or cut short", file=path.name)
    if len(start) < _HEAD.size:
        raise damaged
    points_at, before, *_ = _HEAD.unpack(start)
    # Every record before the points has a header of its own: a count that they have no room for is never read.
    if points_at > size_of(file) or before * _SHORTEST_RECORD_BEFORE > points_at:
        raise damaged
    file.seek(0)
    try:
        header = laspy.LasHeader.read_from(file, read_evlrs=False)
        fits = header.point_format.dtype().itemsize == header.point_format.size
    except (laspy.errors.LaspyException, ValueError, LookupError, TypeError, ArithmeticError, struct.error) as e:
        raise ScanError("{file}: its header is damaged ({reason})", file=path.name, reason=one_line(str(e), 200)) from e
    if not 0 < header.point_count <= MOST_PIXELS:
        raise ScanError(
            "{file}: its header says {count:,} points, expected 1 to {most:,}; export it again",
            file=path.name,
            count=header.point_count,
            most=MOST_PIXELS,
        )
    if not fits:
        raise damaged
    return header


def _stored(file, path, header, report):
    """The records of a LAS, as bytes."""
    size = header.point_count * header.point_format.size
    if size_of(file) - header.offset_to_point_data < size:
        raise ScanError("{file}: holds less than its header says; it is cut short", file=path.name)
    data, step = np.empty(size, np.uint8), _RECORDS * header.point_format.size
    file.seek(header.offset_to_point_data)
    for first in range(0, size, step):
        part = memoryview(data)[first : first + step]
        if file.readinto(part) != len(part):
            raise ScanError("{file}: holds less than its header says; it is cut short", file=path.name)
        report((first + len(part)) / size)
    return data


def _decompressed(file, path, header, report, cancelled):
    """The records of a LAZ, as bytes, decompressed in a child process."""
    library = native_library("lazrs", "lazrs.*")
    if library is None:
        raise ScanError("{file}: LAZ needs lazrs, which is missing; export its points as LAS", file=path.name)
    laszip = [record for record in header.vlrs if (record.user_id, record.record_id) == _LASZIP]
    if not laszip:
        raise ScanError("{file}: does not say how its points are compressed; it is damaged", file=path.name)
    count, size = header.point_count, header.point_count * header.point_format.size
    with ConfinedReading(
        SCRIPT,
        "LAZ",
        file,
        path,
        size=size,
        limits={"memory": _BASE_BYTES + 2 * size, "seconds": _BASE_SECONDS + count // _POINTS_PER_SECOND},
        request={
            "library": str(library),
            "at": header.offset_to_point_data,
            "laszip": list(laszip[0].record_data_bytes()),
            "count": count,
            "record": header.point_format.size,
        },
        reason_of=_reason_of,
        cancelled=cancelled,
    ) as reading:
        while (found := reading.answer(at=count, done=count))[0] == "at":
            report(found[1] / count)
        if found[1] != count:
            raise ScanError("{file}: holds less than its header says; it is cut short", file=path.name)
        return np.frombuffer(reading.memory, np.uint8)


def _reason_of(text):
    """The end of a message about what the library says."""
    if text == "memory":
        return Message("does not fit into memory")
    return Message(
        "its points cannot be decompressed ({reason}); it is damaged or cut short: copy it again",
        reason=one_line(text, 200),
    )


def _columns(data, header):
    """Columns as `scan_of_columns` takes them."""
    laspy = imported_laspy()
    form = header.point_format
    points = laspy.ScaleAwarePointRecord(
        np.frombuffer(data, form.dtype(), header.point_count), form, header.scales, header.offsets
    )
    columns = {axis: np.asarray(points[axis], np.float64) for axis in "xyz"}
    names = set(form.dimension_names)
    if np.ptp(points["intensity"]):
        columns["intensity"] = np.asarray(points["intensity"])
    if {"red", "green", "blue"} <= names:
        colors = {name: np.asarray(points[name]) for name in ("red", "green", "blue")}
        if any(values.any() for values in colors.values()):
            columns |= colors
    for dimension in form.extra_dimensions:
        name = dimension.name.lower().replace(" ", "_")
        if dimension.num_elements == 1 and name not in _NEVER_COLUMNS:
            columns[name] = np.asarray(points[dimension.name])
    return columns


FORMAT = Format(
    name="LAS and LAZ",
    suffixes=(".las", ".laz"),
    read=read_las,
    pixels=las_pixels,
    sniff=lambda start: start.startswith(_MAGIC),
    about="points without a grid, with --grid angle; or with rows and columns as fields of their own",
)
