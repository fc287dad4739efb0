"""Whether a scene's file is whole: glTF's and USD's binary forms, and Blender's own."""

import json
import struct

from .fault import Fault, exactly, require_end

_ZSTD_FRAME = b"\x28\xb5\x2f\xfd"
# The end of a seekable zstd file: a table of its frames, in a frame that readers skip.
_TABLE_HEAD, _TABLE_END = struct.Struct("<II"), struct.Struct("<IBI")
_SKIPPED, _SEEKABLE = 0x184D2A5E, 0x8F92EAB1
_CHECKSUMS = 0x80


def check_glb(file, size):
    """A GLB as long as its header says, with chunks that fill it and a description whose data is there."""
    magic, version, length = struct.unpack("<4sII", exactly(file, 12))
    if magic != b"glTF" or version != 2:
        raise Fault("it is not binary glTF")
    require_end(length, size)
    at, chunks = 12, {}
    while at < length:
        count, kind = struct.unpack("<I4s", exactly(file, 8))
        chunks.setdefault(kind, (at + 8, count))
        at += 8 + count
        file.seek(at)
    require_end(at, size)
    start, count = chunks[b"JSON"]
    file.seek(start)
    description = json.loads(exactly(file, count))
    held = chunks.get(b"BIN\0", (0, 0))[1]
    for buffer in description.get("buffers", ()):
        if "uri" not in buffer and buffer["byteLength"] > held:
            raise Fault("{count:,} bytes of its data are missing", count=buffer["byteLength"] - held)


def check_usd(file, size):
    """A binary USD whose table of contents, its last part, and all sections are there."""
    magic, _version, table = struct.unpack("<8s8sQ", exactly(file, 24))
    if magic != b"PXR-USDC":
        raise Fault("it is not binary USD")
    file.seek(table)
    (count,) = struct.unpack("<Q", exactly(file, 8))
    for _name, start, length in struct.iter_unpack("<16sQQ", exactly(file, count * 32)):
        if start + length > table:
            raise Fault("its table of contents is damaged")
    require_end(table + 8 + count * 32, size)


def check_blend(file, size):
    """A .blend, packed or not, to its last block."""
    start = exactly(file, 12)
    if start.startswith(_ZSTD_FRAME):
        _check_frames(file, size)
    elif start.startswith(b"BLENDER"):
        _check_blocks(file, size, start)
    else:
        raise Fault("it is not a .blend file")


def _check_frames(file, size):
    """A seekable zstd file: the table at its end tells the length of every frame, and they fill the file."""
    file.seek(max(0, size - _TABLE_END.size))
    count, flags, magic = _TABLE_END.unpack(exactly(file, _TABLE_END.size))
    if magic != _SEEKABLE:
        raise Fault("it is cut short")
    entry = 12 if flags & _CHECKSUMS else 8
    table = count * entry + _TABLE_END.size
    file.seek(max(0, size - table - _TABLE_HEAD.size))
    if _TABLE_HEAD.unpack(exactly(file, _TABLE_HEAD.size)) != (_SKIPPED, table):
        raise Fault("its table of contents is damaged")
    at = 0
    for length, *_ in struct.iter_unpack("<3I" if entry == 12 else "<2I", exactly(file, count * entry)):
        file.seek(at)
        if file.read(4) != _ZSTD_FRAME:
            raise Fault("a part of it is missing")
        at += length
    require_end(at + _TABLE_HEAD.size + table, size)


def _check_blocks(file, size, start):
    """Blocks that follow each other up to the one that is called ENDB."""
    # Before Blender 5 the header ends with the size of a pointer, the byte order and the version; since then it begins
    # with its own length.
    if start[7:8] in (b"-", b"_"):
        order, at = ("<" if start[8:9] == b"v" else ">"), 12
        head = struct.Struct(f"{order}4si{'QII' if start[7:8] == b'-' else 'III'}")
        place_of_length = 1
    else:
        order, at = "<", int(start[7:9])
        head = struct.Struct("<4siQqq")
        place_of_length = 3
    code = b""
    while code != b"ENDB":
        file.seek(at)
        fields = head.unpack(exactly(file, head.size))
        code, length = fields[0], fields[place_of_length]
        if length < 0:
            raise Fault("it is damaged")
        at += head.size + length
    require_end(at, size)
