"""PLY with a grid: Stanford's range grids, vertices with rows and columns (as are written here), or a stated size."""

import re
from dataclasses import replace

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ...scan.limits import MOST_PIXELS
from ...scan.scan import is_plausible
from ..gate import size_of
from .cloud import check_size, require_grid, scan_of_columns
from .formats import Format
from .options import ANGLE, AS_IT_IS, pixels_kept
from .text_lines import TextLines

_LONGEST_HEADER = 1 << 16
_RECORDS = 1 << 18
_NUMBERS = ("grid_row", "grid_col")
_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}
_SIZES = (("num_rows", "num_cols"), ("height", "width"), ("rows", "cols"), ("rows", "columns"))
_OWN_SCAN = re.compile(r"scan (\d+): \d+ rows x \d+ columns: (.*)")
_OWN_POSE = re.compile(r"pose of scan (\d+), scanner to world, row by row: (.*)")


def read_ply(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read a PLY whose vertices form a grid; others by angle when that is asked for.

    Parameters and errors are those of `read_scans`.
    """
    header = _Header(file, path)
    vertices = header.vertices
    step = 1 if options.grid == ANGLE else options.step
    numbered = {name for name, *_ in vertices.properties}.issuperset(_NUMBERS)
    count, by_angle = vertices.count // (step**2 if numbered else 1), options.grid == ANGLE
    check_size(path, count, len(vertices.properties), by_angle=by_angle)
    columns, order = {}, header.order
    thinning = _Thinned(step) if numbered and step > 1 else None
    reader = (
        _Text(file, path, progress, cancelled) if order is None else _Binary(file, path, order, progress, cancelled)
    )
    grid = None
    for name, element in header.elements.items():
        if name == "vertex":
            columns = {key.lower(): values for key, values in reader.table(element, thinning).items()}
        elif name == "range_grid" and element.is_list_only:
            grid = reader.first_of_lists(element)
        elif columns and not ("range_grid" in header.elements and grid is None):
            break
        else:
            reader.skip(element)
    shape = header.stated_size()
    if grid is not None and shape is not None and shape[0] * shape[1] == len(grid):
        grid = grid.reshape(shape)[::step, ::step]
        columns, shape = _on_range_grid(columns, grid.ravel(), vertices.count, path), grid.shape
        options = replace(options, step=options.step // step)
    elif shape is not None and shape[0] * shape[1] != vertices.count:
        shape = None
    elif shape is not None and step > 1:
        every = slice(None, None, step), slice(None, None, step)
        columns = {name: values.reshape(shape)[every].flatten() for name, values in columns.items()}
        shape = tuple(-(-size // step) for size in shape)
        options = replace(options, step=options.step // step)
    if thinning is not None:
        options = replace(options, step=1)
    return _scans(path, columns, shape, header, options)


def ply_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the pixels of a PLY, those of several scans together; see `scan_pixels`."""
    header = _Header(file, path)
    vertices, shape = header.vertices, header.stated_size()
    ranged = "range_grid" in header.elements
    if shape is not None and not ranged and shape[0] * shape[1] != vertices.count:
        shape = None
    names = [name for name, *_ in vertices.properties]
    require_grid(path, names, options=options, shape=shape)
    if header.order is not None and not vertices.has_lists and next(iter(header.elements.values())) is vertices:
        size = vertices.count * sum(np.dtype(kind).itemsize for _, kind, _ in vertices.properties)
        if size > size_of(file) - file.tell():
            raise ScanError("{file}: holds less than its header says; it is cut short", file=path.name)
    return pixels_kept([shape[0] * shape[1] if ranged and shape is not None else vertices.count], options)


def _scans(path, columns, shape, header, options):
    poses, names = header.own_poses()
    if "scan" not in columns:
        pose = poses.get(0)
        return [scan_of_columns(path, _taken_back(columns, pose), options=options, shape=shape, pose=pose)]
    scans, number = [], columns.pop("scan")
    for index in np.unique(number).astype(int).tolist():
        part = {name: values[number == index] for name, values in columns.items()}
        pose = poses.get(index)
        name = names.get(index) or f"{path.stem} {index + 1}"
        scans.append(scan_of_columns(path, _taken_back(part, pose), options=options, name=name, pose=pose))
    return scans


def _taken_back(columns, pose):
    """Columns with the points in the scanner's frame, for a file that says where in the world that is."""
    if pose is None or not {"x", "y", "z"} <= columns.keys():
        return columns
    points = np.stack([np.asarray(columns[axis], np.float64) for axis in "xyz"], axis=-1)
    points = (points - pose[:3, 3]) @ np.linalg.inv(pose[:3, :3]).T
    return columns | dict(zip("xyz", points.T, strict=True))


def _on_range_grid(columns, grid, count, path):
    """Columns of every pixel of a range grid; zeros where it has no vertex."""
    there = grid >= 0
    if (grid >= count).any():
        raise ScanError("{file}: its range grid names vertices that it does not have", file=path.name)
    laid = {}
    for name, values in columns.items():
        laid[name] = np.zeros(len(grid), values.dtype)
        laid[name][there] = values[grid[there]]
    return laid


class _Thinned:
    """Keeps every ``step``-th row and column of vertices with numbers, counted from those of the first one."""

    def __init__(self, step):
        self._step, self._first = step, None

    def of(self, table):
        """A table, or columns by their names, of those that are kept; their numbers are divided by the step."""
        numbers = [table[name].astype(np.int64) for name in _NUMBERS]
        if self._first is None:
            self._first = [values[0] % self._step if len(values) else 0 for values in numbers]
        numbers = [values - first for values, first in zip(numbers, self._first, strict=True)]
        kept = (numbers[0] % self._step == 0) & (numbers[1] % self._step == 0)
        table = table[kept] if isinstance(table, np.ndarray) else {name: each[kept] for name, each in table.items()}
        for name, values in zip(_NUMBERS, numbers, strict=True):
            table[name] = values[kept] // self._step
        return table


class _Element:
    def __init__(self, count):
        self.count, self.properties = count, []

    @property
    def is_list_only(self):
        return len(self.properties) == 1 and self.properties[0][2] is not None

    @property
    def has_lists(self):
        return any(item is not None for *_, item in self.properties)


class _Header:
    """Elements with (name, type, type of the items or None) of their properties; what comments say."""

    def __init__(self, file, path):
        self.elements, self._notes, self.order, self._path = {}, [], "unknown", path
        lines, read = 0, 0
        while True:
            line = file.readline(_LONGEST_HEADER)
            read, lines = read + len(line), lines + 1
            if not line or read > _LONGEST_HEADER:
                raise ScanError("{file}: its header is cut short", file=path.name)
            words = line.decode("latin-1").split()
            try:
                if not words or words[0] == "ply":
                    continue
                if words[0] == "end_header":
                    break
                if words[0] in ("comment", "obj_info"):
                    self._notes.append(" ".join(words[1:]))
                elif words[0] == "format":
                    self.order = _ORDERS[words[1]]
                elif words[0] == "element":
                    self._element = self.elements[words[1]] = _Element(int(words[2]))
                elif words[0] == "property" and words[1] == "list":
                    self._element.properties.append((words[4], _TYPES[words[2]], _TYPES[words[3]]))
                elif words[0] == "property":
                    self._element.properties.append((words[2], _TYPES[words[1]], None))
                else:
                    raise ValueError
            except (KeyError, IndexError, ValueError, AttributeError):
                raise ScanError(
                    "{file}: line {line}: not a line of a PLY's header", file=path.name, line=lines
                ) from None
        elements = self.elements.values()
        names = [[name for name, *_ in element.properties] for element in elements]
        twice = any(len(set(given)) < len(given) for given in names)
        if self.order == "unknown" or twice or any(not 0 <= element.count < 2**40 for element in elements):
            raise ScanError("{file}: its header is damaged", file=path.name)

    @property
    def vertices(self):
        """The element of the vertices; raises ScanError where there is none that can be read."""
        vertices = self.elements.get("vertex")
        if vertices is None or not 0 < vertices.count <= MOST_PIXELS:
            raise ScanError("{file}: holds no vertices", file=self._path.name)
        return vertices

    def stated_size(self):
        """(rows, columns) that comments state, or None."""
        stated = {}
        for note in self._notes:
            key, _, value = note.replace("=", " ").partition(" ")
            if value.strip().isdecimal() and len(value) < 8:
                stated[key.lower()] = int(value)
        found = next((names for names in _SIZES if stated.keys() >= set(names)), None)
        return None if found is None else tuple(stated[name] for name in found)

    def own_poses(self):
        """Poses and names of the scans of a file that was written here, by their number."""
        poses, names = {}, {}
        for note in self._notes:
            if match := _OWN_SCAN.fullmatch(note):
                names[int(match[1])] = match[2]
            elif match := _OWN_POSE.fullmatch(note):
                poses[int(match[1])] = self._pose(match[2].split())
        return poses, names

    def _pose(self, words):
        try:
            pose = np.array(words, np.float64).reshape(4, 4)
        except ValueError:
            pose = np.zeros((4, 4))
        if not is_plausible(pose):
            raise ScanError("{file}: a pose in its header is damaged", file=self._path.name)
        return pose


class _Binary:
    def __init__(self, file, path, order, progress, cancelled):
        self._file, self._path, self._order, self._progress, self._cancelled = file, path, order, progress, cancelled

    def table(self, element, thinning):
        if element.has_lists:
            raise ScanError("{file}: its vertices hold lists", file=self._path.name)
        record = np.dtype([(name, self._order + kind) for name, kind, _ in element.properties])
        self._require(element.count * record.itemsize)
        # Memory is taken as it is filled.
        table, kept = np.empty(element.count, record), 0
        for first in range(0, element.count, _RECORDS):
            count = min(_RECORDS, element.count - first)
            part = np.frombuffer(self._file.read(count * record.itemsize), record, count)
            part = part if thinning is None else thinning.of(part)
            table[kept : kept + len(part)] = part
            kept += len(part)
            if self._cancelled and self._cancelled():
                raise Cancelled
            if self._progress:
                self._progress((first + count) / element.count, Message("Reading {file}", file=self._path.name))
        return {name: table[name][:kept] for name in record.names}

    def first_of_lists(self, element):
        """(N,) int64, the first item of each list; -1 for an empty one."""
        (_, count_type, item_type) = element.properties[0]
        count_type, item_type = np.dtype(self._order + count_type), np.dtype(self._order + item_type)
        found = np.full(element.count, -1, np.int64)
        for index in range(element.count):
            (count,) = np.frombuffer(self._exactly(count_type.itemsize), count_type)
            if count:
                found[index] = np.frombuffer(self._exactly(int(count) * item_type.itemsize), item_type)[0]
        return found

    def skip(self, element):
        if not element.has_lists:
            size = sum(np.dtype(kind).itemsize for _, kind, _ in element.properties)
            self._exactly(element.count * size)
        else:
            raise ScanError("{file}: lists stand before its vertices", file=self._path.name)

    def _exactly(self, size):
        self._require(size)
        return self._file.read(size)

    def _require(self, size):
        if size > size_of(self._file) - self._file.tell():
            raise ScanError("{file}: holds less than its header says; it is cut short", file=self._path.name)


class _Text:
    def __init__(self, file, path, progress, cancelled):
        self._lines, self._path = TextLines(file, path, progress=progress, cancelled=cancelled), path

    def table(self, element, thinning):
        if element.has_lists:
            raise ScanError("{file}: its vertices hold lists", file=self._path.name)
        width = len(element.properties)
        values, at = np.empty((element.count, width)), 0
        for chunk in self._chunks(element.count):
            try:
                found = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
            except ValueError:
                found = np.empty((0, 0))
            if found.shape[1] != width:
                raise self._lines.error("expected lines of {count} numbers", count=width)
            values[at : at + len(found)] = found
            at += len(found)
        columns = {name: values[:, place] for place, (name, *_) in enumerate(element.properties)}
        return columns if thinning is None else thinning.of(columns)

    def first_of_lists(self, element):
        found, at = np.full(element.count, -1, np.int64), 0
        for chunk in self._chunks(element.count):
            for line in chunk:
                words = line.split(None, 2)
                try:
                    if int(words[0]):
                        found[at] = int(words[1])
                except (ValueError, IndexError, OverflowError):
                    raise self._lines.error("expected a list of whole numbers") from None
                at += 1
        return found

    def skip(self, element):
        for _ in self._chunks(element.count):
            pass

    def _chunks(self, count):
        while count > 0:
            chunk = [line for line in self._lines.take(count) if line and not line.isspace()]
            if not chunk and self._lines.at_end():
                raise ScanError("{file}: holds less than its header says; it is cut short", file=self._path.name)
            count -= len(chunk)
            if chunk:
                yield chunk


FORMAT = Format(
    name="PLY",
    suffixes=(".ply",),
    read=read_ply,
    pixels=ply_pixels,
    sniff=lambda start: start.startswith((b"ply\n", b"ply\r")),
    about="vertices with rows and columns (as are written here), range grids; others with --grid angle",
)
