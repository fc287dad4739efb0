"""Whether a picture is whole."""

import struct
import zlib

from .fault import Fault, exactly, require_end

_PNG = b"\x89PNG\r\n\x1a\n"
_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
_CHUNK = 1 << 20


def check_png(file, size):
    """A PNG whose chunks have their checksums and end with the last one, and whose pixels unpack to all its rows."""
    if exactly(file, 8) != _PNG:
        raise Fault("it is not a PNG")
    pixels, unpacked, expected, at, kind = zlib.decompressobj(), 0, None, 8, None
    while kind != b"IEND":
        length, kind = struct.unpack(">I4s", exactly(file, 8))
        checksum, start, left = zlib.crc32(kind), b"", length
        while left:
            part = exactly(file, min(left, _CHUNK))
            left -= len(part)
            checksum = zlib.crc32(part, checksum)
            start = start or part
            if kind == b"IDAT":
                unpacked += len(pixels.decompress(part))
        if struct.unpack(">I", exactly(file, 4)) != (checksum,):
            raise Fault("a checksum in it is wrong")
        if kind == b"IHDR":
            expected = _unpacked_size(start)
        at += 12 + length
    require_end(at, size)
    if not pixels.eof or expected not in (None, unpacked):
        raise Fault("some of its pixels are missing")


def _unpacked_size(header):
    """Bytes of all rows, each with the number of its filter before it; None for an interlaced picture."""
    width, height, bits, color, _, _, interlaced = struct.unpack(">IIBBBBB", header)
    return None if interlaced else height * (1 + (width * bits * _CHANNELS[color] + 7) // 8)


def check_jpeg(file, size):
    """A JPEG from its first marker to its last."""
    start = file.read(2)
    file.seek(max(0, size - 2))
    if start != b"\xff\xd8" or file.read(2) != b"\xff\xd9":
        raise Fault("it is not a complete JPEG")
