"""OpenEXR pictures, read with numpy and zlib: renderers and depth tools write them, and OpenCV may come without."""

import struct
import zlib
from pathlib import Path

import numpy as np

from ..errors import ImageError
from ..messages import Message
from .gate import contents
from .image_size import require_size

_MAGIC = b"\x76\x2f\x31\x01"
_UNREAD = ((0x200, Message("tiled")), (0x800, Message("deep")), (0x1000, Message("in several parts")))
_TYPES = (np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4"))
_COMPRESSIONS = ("NONE", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB")
_ROWS_PER_CHUNK = {"NONE": 1, "RLE": 1, "ZIPS": 1, "ZIP": 16}
# Largest number of bytes that one byte of a compressed picture can unpack to.
_MOST_UNPACKED = 1100
_LARGEST_FILE = 1 << 36


def is_exr(start):
    """True where the first bytes of a file are those of an EXR."""
    return bytes(start[:4]) == _MAGIC


def read_exr_channels(path):
    """Read every channel of a single-part, scan-line EXR.

    Parameters
    ----------
    path : path-like
        Written without compression, or with RLE, ZIPS or ZIP.

    Returns
    -------
    dict of str to (H, W) float32
        By full name, for example ``"R"`` or ``"ViewLayer.Depth.Z"``, row 0 at the top. Half floats become float32.

    Raises
    ------
    ImageError
        If the file cannot be read, is no EXR, is of a kind that is not read, or is cut short.
    """
    return exr_channels(
        contents(path, Message("an EXR picture"), error=ImageError, most=_LARGEST_FILE), Path(path).name
    )


def exr_channels(data, name):
    """Return what `read_exr_channels` does, of the bytes of a file and its name for messages."""
    if not is_exr(data):
        raise ImageError("{file}: its first bytes are not those of an EXR image", file=name)
    try:
        return _channels(data, name)
    except (KeyError, IndexError, struct.error, zlib.error, ValueError, OverflowError) as error:
        if isinstance(error, ImageError):
            raise
        raise ImageError("{file}: not a complete EXR image: it is damaged or cut short", file=name) from None
    except MemoryError:
        raise ImageError("{file}: does not fit into memory", file=name) from None


def _channels(data, name):
    flags, attributes, at = _header(data)
    for flag, kind in _UNREAD:
        if flags & flag:
            raise ImageError("{file}: is {kind}, expected an EXR of one part in scan lines", file=name, kind=kind)
    number = attributes["compression"][0]
    compression = _COMPRESSIONS[number] if number < len(_COMPRESSIONS) else f"number {number}"
    if compression not in _ROWS_PER_CHUNK:
        raise ImageError(
            "{file}: compressed with {found}, expected ZIP or none: save it that way", file=name, found=compression
        )
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    listed = _channel_list(attributes["channels"])
    require_size(width, height, sum(dtype.itemsize for _, dtype in listed), name, most=_MOST_UNPACKED * len(data))
    per_chunk = _ROWS_PER_CHUNK[compression]
    offsets = np.frombuffer(data, "<u8", count=-(-height // per_chunk), offset=at)
    row_size = width * sum(dtype.itemsize for _, dtype in listed)

    channels = {channel: np.zeros((height, width), np.float32) for channel, _ in listed}
    for offset in offsets.tolist():
        y, size = struct.unpack_from("<ii", data, offset)
        first = y - top
        rows = min(per_chunk, height - first)
        packed = data[offset + 8 : offset + 8 + size]
        if first < 0 or rows < 1 or size < 0 or len(packed) != size:
            raise ValueError
        block = packed if size == rows * row_size else _unpacked(packed, compression, rows * row_size)
        block = np.frombuffer(block, np.uint8, count=rows * row_size).reshape(rows, row_size)
        start = 0
        for channel, dtype in listed:
            end = start + width * dtype.itemsize
            channels[channel][first : first + rows] = np.ascontiguousarray(block[:, start:end]).view(dtype)
            start = end
    return channels


def _header(data):
    """Flags of the version field, attributes by name, and the offset of the table after the header."""
    (version,) = struct.unpack_from("<I", data, 4)
    attributes, at = {}, 8
    while data[at] != 0:
        name, at = _text(data, at)
        _kind, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        if size < 0:
            raise ValueError
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return version, attributes, at + 1


def _channel_list(listing):
    channels, at = [], 0
    while listing[at] != 0:
        name, at = _text(listing, at)
        kind, _linear, x_sampling, y_sampling = struct.unpack_from("<4i", listing, at)
        if (x_sampling, y_sampling) != (1, 1):
            raise ImageError("channel {name} of an EXR is subsampled, expected a value for every pixel", name=name)
        channels.append((name, _TYPES[kind]))
        at += 16
    return channels


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def _unpacked(packed, compression, size):
    """Undo the packing, then EXR's two filters: a running difference, and bytes of even and odd place set apart."""
    flat = _run_lengths_undone(packed, size) if compression == "RLE" else zlib.decompressobj().decompress(packed, size)
    if len(flat) != size:
        raise ValueError
    differences = np.frombuffer(flat, np.uint8).copy()
    differences[1:] -= 128
    values = np.cumsum(differences, dtype=np.uint8)
    half = (size + 1) // 2
    joined = np.empty(size, np.uint8)
    joined[0::2], joined[1::2] = values[:half], values[half:]
    return joined.tobytes()


def _run_lengths_undone(packed, size):
    parts, at, done = [], 0, 0
    while at < len(packed) and done < size:
        count = struct.unpack_from("<b", packed, at)[0]
        if count < 0:
            part = packed[at + 1 : at + 1 - count]
            at += 1 - count
        else:
            part = packed[at + 1 : at + 2] * (count + 1)
            at += 2
        parts.append(part)
        done += len(part)
    return b"".join(parts)
