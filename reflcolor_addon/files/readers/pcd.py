"""PCD of the Point Cloud Library: organized clouds as they are, others by angle."""

import struct
from dataclasses import replace

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ...scan.limits import MOST_PIXELS
from ..gate import size_of
from .cloud import check_size, require_grid, scan_of_columns
from .formats import Format
from .options import ANGLE, AS_IT_IS, pixels_kept
from .poses import quaternion_pose
from .text_lines import TextLines

_LONGEST_HEADER = 1 << 16
_KEYS = ("VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA")
_TYPES = {("F", 4): "<f4", ("F", 8): "<f8"} | {
    (kind, size): f"<{code}{size}" for kind, code in (("I", "i"), ("U", "u")) for size in (1, 2, 4, 8)
}
_ASKED_EVERY = 1 << 20


def read_pcd(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read a PCD: ascii, binary or compressed.

    A cloud of several rows is a grid, row by row; no return is where it holds NaN. Its viewpoint is the pose.
    Parameters and errors are those of `read_scans`.
    """
    header, names, types, counts = _header(file, path)
    width, height, count = _size(header, path)
    organized = height > 1 and options.grid != ANGLE
    step = options.step if organized else 1
    check_size(path, count // step**2, len(names), by_angle=options.grid == ANGLE)
    record = np.dtype([(name, kind, (number,)) for name, kind, number in zip(names, types, counts, strict=True)])
    kind = header["DATA"][0].lower()
    if kind == "ascii":
        columns = _ascii(file, path, names, counts, count, (width, step), progress, cancelled)
    elif kind == "binary":
        _require(size_of(file) - file.tell() >= count * record.itemsize, path)
        columns = _by_name(_rows(file, path, record, (height, width), step, progress, cancelled))
    elif kind == "binary_compressed":
        columns = _compressed(file, path, record, count, progress, cancelled)
        if step > 1:
            every = slice(None, None, step), slice(None, None, step)
            columns = {name: values.reshape(height, width)[every].flatten() for name, values in columns.items()}
    else:
        raise ScanError(
            "{file}: DATA is {found}, expected ascii, binary or binary_compressed", file=path.name, found=kind
        )
    viewpoint = [_number(word, path) for word in header.get("VIEWPOINT", ["0", "0", "0", "1", "0", "0", "0"])]
    _require(len(viewpoint) == 7, path)
    pose, warnings = quaternion_pose(np.array(viewpoint[3:]), np.array(viewpoint[:3]), path.stem)
    columns = {name.lower(): values for name, values in columns.items()}
    _unpack_colors(columns)
    shape = (-(-height // step), -(-width // step)) if height > 1 else None
    options = replace(options, step=options.step // step)
    scan = scan_of_columns(path, columns, options=options, shape=shape, pose=pose, warnings=warnings)
    return [scan]


def pcd_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the points of a PCD; see `scan_pixels`."""
    header, names, types, counts = _header(file, path)
    width, height, count = _size(header, path)
    require_grid(path, names, options=options, shape=(height, width) if height > 1 else None)
    if header["DATA"][0].lower() == "binary":
        size = sum(np.dtype(kind).itemsize * number for kind, number in zip(types, counts, strict=True))
        _require(size_of(file) - file.tell() >= count * size, path)
    return pixels_kept([count], options)


def _size(header, path):
    """Width, height and the number of points."""
    width, height = (_whole(header, key, path) for key in ("WIDTH", "HEIGHT"))
    if not 0 < width * height <= MOST_PIXELS:
        raise ScanError("{file}: claims {count:,} points", file=path.name, count=width * height)
    return width, height, width * height


def _header(file, path):
    """The words of every key, and name, type and count of every field."""
    header, read = {}, 0
    while "DATA" not in header:
        line = file.readline(_LONGEST_HEADER)
        read += len(line)
        if not line or read > _LONGEST_HEADER:
            raise ScanError("{file}: its header is cut short", file=path.name)
        words = line.decode("latin-1").split()
        if words and not words[0].startswith("#"):
            if words[0] not in _KEYS:
                raise ScanError("{file}: not a PCD: its header has a line {found}", file=path.name, found=words[0])
            header[words[0]] = words[1:]
    for key in ("FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT", "DATA"):
        if not header.get(key):
            raise ScanError("{file}: its header has no {key}", file=path.name, key=key)
    names = header["FIELDS"]
    sizes, kinds = header["SIZE"], header["TYPE"]
    counts = header.get("COUNT") or ["1"] * len(names)
    if not len(names) == len(sizes) == len(kinds) == len(counts) <= 256:
        raise ScanError("{file}: FIELDS, SIZE, TYPE and COUNT of its header differ in length", file=path.name)
    types, numbers = [], []
    for kind, size, number in zip(kinds, sizes, counts, strict=True):
        code = _TYPES.get((kind, int(size) if size.isdecimal() else 0))
        if code is None or not number.isdecimal() or not 0 < int(number) <= 4096:
            raise ScanError("{file}: its header has a field of an unknown type", file=path.name)
        types.append(code)
        numbers.append(int(number))
    # Padding has one and the same name.
    unique = [name if names.index(name) == place else f"{name}#{place}" for place, name in enumerate(names)]
    return header, unique, types, numbers


def _rows(file, path, record, shape, step, progress, cancelled):
    """The records of every ``step``-th row and column, one after the other."""
    height, width = shape
    kept = np.empty((-(-height // step), -(-width // step)), record)
    for row in range(height):
        line = file.read(width * record.itemsize)
        if row % step == 0:
            kept[row // step] = np.frombuffer(line, record, width)[::step]
        if cancelled and cancelled():
            raise Cancelled
        if progress:
            progress((row + 1) / height, Message("Reading {file}", file=path.name))
    return kept.ravel()


def _by_name(table):
    return {name: table[name][:, 0] for name in table.dtype.names}


def _ascii(file, path, names, counts, count, grid, progress, cancelled):
    """Columns of the points; of a grid of (width, step) only those of every ``step``-th row and column."""
    lines = TextLines(file, path, progress=progress, cancelled=cancelled)
    width, (columns, step) = sum(counts), grid
    values, at, kept = np.empty((-(-count // columns // step) * -(-columns // step), width)), 0, 0
    while at < count and (chunk := lines.take(count - at)):
        chunk = [line.replace(",", " ") for line in chunk if line and not line.isspace()]
        if not chunk:
            continue
        try:
            found = np.loadtxt(chunk, np.float64, comments=None, ndmin=2)
        except ValueError:
            found = np.empty((0, 0))
        if found.shape[1] != width:
            raise lines.error("expected lines of {count} numbers", count=width)
        row, column = np.divmod(np.arange(at, at + len(found)), columns)
        at += len(found)
        found = found[(row % step == 0) & (column % step == 0)] if step > 1 else found
        values[kept : kept + len(found)] = found
        kept += len(found)
    _require(at == count, path)
    starts = np.cumsum([0, *counts[:-1]])
    return {name: values[:, start] for name, start in zip(names, starts, strict=True)}


def _compressed(file, path, record, count, progress, cancelled):
    """Column by column, packed by LZF."""
    sizes = file.read(8)
    _require(len(sizes) == 8, path)
    packed, unpacked = struct.unpack("<II", sizes)
    _require(unpacked == count * record.itemsize and packed <= size_of(file) - file.tell(), path)
    data = _lzf(file.read(packed), unpacked, path, progress, cancelled)
    columns, at = {}, 0
    for name in record.names:
        kind, shape = record[name].base, record[name].shape
        columns[name] = np.frombuffer(data, kind, count * shape[0], at).reshape(count, *shape)[:, 0]
        at += kind.itemsize * shape[0] * count
    return columns


def _lzf(packed, size, path, progress, cancelled):
    """Undo LZF: runs of bytes as they are, and repetitions of what came before."""
    out, at, end, asked = bytearray(), 0, len(packed), 0
    try:
        while at < end:
            control = packed[at]
            at += 1
            if control < 32:
                out += packed[at : at + control + 1]
                at += control + 1
            else:
                length = control >> 5
                if length == 7:
                    length += packed[at]
                    at += 1
                back = len(out) - ((control & 31) << 8) - packed[at] - 1
                at += 1
                length += 2
                if back < 0 or len(out) + length > size:
                    raise IndexError
                piece = out[back : back + length]
                # A repetition may overlap itself.
                while len(piece) < length:
                    piece += piece[: length - len(piece)]
                out += piece
            if at - asked > _ASKED_EVERY:
                asked = at
                if cancelled and cancelled():
                    raise Cancelled
                if progress:
                    progress(at / end, Message("Reading {file}", file=path.name))
    except IndexError:
        raise ScanError("{file}: its compressed points are damaged", file=path.name) from None
    _require(len(out) == size, path)
    return out


def _unpack_colors(columns):
    """Three bytes in one number, which PCL often stores as a float."""
    packed = next((columns.pop(name) for name in ("rgb", "rgba") if name in columns), None)
    if packed is None or "red" in columns:
        return
    if packed.dtype.kind == "f":
        # Text holds the bits read as a float, or as a whole number.
        whole = np.nan_to_num(packed)
        bits = packed.astype("<f4").view("<u4") if (np.abs(whole) < 1).all() else whole.astype(np.int64)
    else:
        bits = packed
    for name, shift in (("red", 16), ("green", 8), ("blue", 0)):
        columns[name] = ((bits >> shift) & 255).astype(np.uint8)


def _whole(header, key, path):
    word = header[key][0]
    if not word.isdecimal() or len(word) > 12:
        raise ScanError("{file}: {key} is {found}, expected a whole number", file=path.name, key=key, found=word)
    return int(word)


def _number(word, path):
    try:
        return float(word)
    except ValueError:
        raise ScanError("{file}: expected a number, found '{found}'", file=path.name, found=word) from None


def _require(holds, path):
    if not holds:
        raise ScanError("{file}: holds less than its header says; it is cut short", file=path.name)


FORMAT = Format(
    name="PCD",
    suffixes=(".pcd",),
    read=read_pcd,
    pixels=pcd_pixels,
    sniff=lambda start: start.startswith((b"# .PCD", b"VERSION ", b"FIELDS ")),
    about="organized clouds (ascii, binary, compressed); others with --grid angle",
)
