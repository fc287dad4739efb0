"""The kind and size of an image file, found from its first bytes before anything decodes it."""

import struct
from dataclasses import dataclass

from ..errors import ImageError
from ..messages import Message
from .exr import is_exr
from .image_size import require_size
from .tiff import TiffLayout, is_tiff, tiff_layout

EXPECTED = Message("an image (PNG, JPEG, TIFF, WebP, BMP or EXR)")
PNG, JPEG, TIFF, WEBP, BMP, EXR = "PNG", "JPEG", "TIFF", "WebP", "BMP", "EXR"
_PNG_CHANNELS = {0: 1, 2: 3, 3: 3, 4: 4, 6: 4}
_PNG_WITH_ALPHA = (4, 6)
# Largest number of bytes that one byte of the file can unpack to, by kind; a file that claims more is damaged.
_MOST_UNPACKED = {PNG: 1100, JPEG: 4096, TIFF: 1600, WEBP: 1 << 20, BMP: 256}
_HEIC = (b"ftypheic", b"ftypheix", b"ftypmif1")
# Markers of JPEG that begin a frame, and so tell its size.
_FRAMES = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}


@dataclass(frozen=True)
class ImageHeader:
    """What an image claims to be.

    Parameters
    ----------
    kind : str
    width, height : int
    pixel_bytes : int
        Of a decoded pixel.
    has_alpha : bool
        Of a PNG.
    layout : TiffLayout or None
        Of a TIFF that is taken apart here; None for one that OpenCV decodes.
    pictures : int
        As in `TiffLayout`.
    """

    kind: str
    width: int
    height: int
    pixel_bytes: int
    has_alpha: bool = False
    layout: TiffLayout | None = None
    pictures: int = 1


def image_header(data, name):
    """Return the ImageHeader of the bytes of a file, whose size is plausible and fits into memory; None for an EXR.

    Raises
    ------
    ImageError
        In one line, also if the file is no image of the kinds that are read.
    """
    kind = _kind(data)
    if kind == EXR:
        # Its own reader checks its size against the file.
        return None
    if kind is None:
        if data[4:12] in _HEIC:
            raise ImageError(
                "{file}: is a HEIC photo, which is not supported; save it as JPEG or PNG (expected {expected})",
                file=name,
                expected=EXPECTED,
            )
        raise ImageError("{file}: is not an image that can be read; expected {expected}", file=name, expected=EXPECTED)
    try:
        header = _HEADERS[kind](data, name)
        require_size(header.width, header.height, header.pixel_bytes, name, most=_MOST_UNPACKED[kind] * len(data))
        if kind == PNG:
            _require_chunks(data)
    except ImageError:
        raise
    except (struct.error, LookupError, ValueError):
        raise ImageError("{file}: is not a whole {kind}: it is damaged or cut short", file=name, kind=kind) from None
    return header


def _kind(data):
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return PNG
    if data.startswith(b"\xff\xd8\xff"):
        return JPEG
    if is_tiff(data):
        return TIFF
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return WEBP
    if data.startswith(b"BM"):
        return BMP
    return EXR if is_exr(data) else None


def _png(data, _name):
    length, kind, width, height, bits, color = struct.unpack_from(">I4sIIBB", data, 8)
    if (length, kind) != (13, b"IHDR"):
        raise ValueError
    pixel = _PNG_CHANNELS[color] * (2 if bits == 16 else 1)
    return ImageHeader(PNG, width, height, pixel, has_alpha=color in _PNG_WITH_ALPHA)


def _require_chunks(data):
    """Raise ValueError where a PNG does not hold all that its chunks claim: OpenCV makes room for it, up to 4 GB."""
    at, kind = 8, b""
    while kind != b"IEND":
        length, kind = struct.unpack_from(">I4s", data, at)
        at += 12 + length
    if at > len(data):
        raise ValueError


def _jpeg(data, _name):
    at = 2
    while True:
        while data[at] == 0xFF and data[at + 1] == 0xFF:
            at += 1
        marker, length = struct.unpack_from(">xBH", data, at)
        if data[at] != 0xFF or length < 2:
            raise ValueError
        if marker in _FRAMES:
            height, width = struct.unpack_from(">HH", data, at + 5)
            return ImageHeader(JPEG, width, height, 3)
        at += 2 + length


def _webp(data, _name):
    kind = bytes(data[12:16])
    if kind == b"VP8X":
        sides = (int.from_bytes(data[at : at + 3], "little") + 1 for at in (24, 27))
        return ImageHeader(WEBP, *sides, 4)
    if kind == b"VP8L":
        (packed,) = struct.unpack_from("<I", data, 21)
        return ImageHeader(WEBP, (packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1, 4)
    if kind == b"VP8 ":
        width, height = struct.unpack_from("<HH", data, 26)
        return ImageHeader(WEBP, width & 0x3FFF, height & 0x3FFF, 3)
    raise ValueError


def _bmp(data, _name):
    (size,) = struct.unpack_from("<I", data, 14)
    width, height = struct.unpack_from("<HH" if size == 12 else "<ii", data, 18)
    return ImageHeader(BMP, width, abs(height), 4)


def _tiff(data, name):
    layout = tiff_layout(data, name)
    if layout.dtype is None:
        return ImageHeader(TIFF, layout.width, layout.height, 4, pictures=layout.pictures)
    size = layout.samples * layout.dtype.itemsize
    return ImageHeader(TIFF, layout.width, layout.height, size, layout=layout, pictures=layout.pictures)


_HEADERS = {PNG: _png, JPEG: _jpeg, TIFF: _tiff, WEBP: _webp, BMP: _bmp}
