"""The color profile (ICC) that an image file carries, and its colors brought to sRGB.

Only the profiles that cameras and phones write are applied: RGB profiles with a matrix and a curve for each channel
(ICC.1:2022, 8.3), such as Display P3 and Adobe RGB. Profiles with tables are recognized and not applied.
"""

import struct
import zlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..srgb import linear_to_srgb8

_LARGEST, _MOST_TAGS, _MOST_CHUNKS = 4 << 20, 200, 4096
_LONGEST_CURVE = 65536
# Linear sRGB to XYZ under D50, as profiles have it (IEC 61966-2-1, adapted by Bradford's method).
_SRGB_TO_XYZ = np.array(
    [[0.4360747, 0.3850649, 0.1430804], [0.2225045, 0.7168786, 0.0606169], [0.0139322, 0.0971045, 0.7141733]]
)
# A profile whose colors differ by no more than this is sRGB: its many versions differ by as much.
_SAME_LEVELS = 2
_ROWS = 256
# How many numbers each kind of parametric curve has (ICC.1:2022, table 68).
_PARAMETERS = (1, 3, 4, 5, 7)


@dataclass(frozen=True, eq=False)
class ColorProfile:
    """An RGB profile: linear light is a curve of each channel, and a matrix brings that to XYZ.

    name : str
        As the profile calls itself; empty where it does not.
    curves : (3, 256) float64
        Linear light of 0..1 for each value of 8 bits; None where the profile is of tables, or of another kind.
    matrix : (3, 3) float64
        To XYZ under D50; None with the curves.
    """

    name: str
    curves: np.ndarray | None
    matrix: np.ndarray | None

    @property
    def known(self):
        """Whether colors can be converted."""
        return self.curves is not None

    @cached_property
    def is_srgb(self):
        """Whether converting changes nothing that counts."""
        levels = np.array([0, 16, 64, 128, 192, 255], np.uint8)
        colors = np.stack(np.meshgrid(levels, levels, levels), axis=-1).reshape(1, -1, 3)
        return bool(np.abs(self._converted(colors).astype(int) - colors).max() <= _SAME_LEVELS)

    def to_srgb(self, rgb):
        """Return the (H, W, 3) uint8 sRGB of colors (H, W, 3) uint8 in this profile, clipped to what sRGB has."""
        if not self.known or self.is_srgb:
            return rgb
        result = np.empty_like(rgb)
        for start in range(0, len(rgb), _ROWS):
            result[start : start + _ROWS] = self._converted(rgb[start : start + _ROWS])
        return result

    def _converted(self, rgb):
        light = np.stack([self.curves[channel][rgb[..., channel]] for channel in range(3)], axis=-1)
        return linear_to_srgb8(np.clip(light @ (np.linalg.inv(_SRGB_TO_XYZ) @ self.matrix).T, 0, 1))


def embedded_profile(data):
    """Return the `ColorProfile` in the bytes of a JPEG, PNG, TIFF or WebP file; None without a sound one."""
    try:
        profile = _stored(data)
        return None if profile is None or not 128 < len(profile) <= _LARGEST else _parsed(profile)
    except (ValueError, IndexError, struct.error, zlib.error):
        return None


def _stored(data):
    """The bytes of the profile in a file."""
    if data.startswith(b"\xff\xd8"):
        return _in_jpeg(data)
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return _in_png(data)
    if data[:4] in (b"II*\0", b"MM\0*"):
        return _in_tiff(data)
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return _in_webp(data)
    return None


def _in_jpeg(data):
    """In numbered APP2 segments."""
    place, parts = 2, {}
    for _ in range(_MOST_CHUNKS):
        marker, length = struct.unpack_from(">HH", data, place)
        if marker in (0xFFDA, 0xFFD9) or marker < 0xFF00 or length < 2:
            break
        body = data[place + 4 : place + 2 + length]
        if marker == 0xFFE2 and body.startswith(b"ICC_PROFILE\0") and len(body) > 14:
            parts[body[12]] = body[14:]
        place += 2 + length
    if sorted(parts) != list(range(1, len(parts) + 1)):
        return None
    return b"".join(parts[number] for number in sorted(parts)) or None


def _in_png(data):
    """In the chunk iCCP, compressed."""
    place = 8
    for _ in range(_MOST_CHUNKS):
        length, kind = struct.unpack_from(">I4s", data, place)
        if kind in (b"IDAT", b"IEND"):
            return None
        if kind == b"iCCP":
            body = data[place + 8 : place + 8 + length]
            begin = body.index(b"\0") + 2
            return zlib.decompressobj().decompress(body[begin:], _LARGEST)
        place += 12 + length
    return None


def _in_tiff(data):
    """In the tag 34675 of the first page."""
    order = "<" if data[:2] == b"II" else ">"
    (place,) = struct.unpack_from(order + "I", data, 4)
    (count,) = struct.unpack_from(order + "H", data, place)
    for number in range(min(count, _MOST_CHUNKS)):
        tag, kind, length, at = struct.unpack_from(order + "HHII", data, place + 2 + 12 * number)
        if tag == 34675 and kind in (1, 7) and 4 < length <= _LARGEST:
            return data[at : at + length]
    return None


def _in_webp(data):
    """In the chunk ICCP."""
    place = 12
    for _ in range(_MOST_CHUNKS):
        kind, length = struct.unpack_from("<4sI", data, place)
        if kind == b"ICCP":
            return data[place + 8 : place + 8 + length]
        place += 8 + length + length % 2
    return None


def _parsed(profile):
    """The `ColorProfile` in the bytes of a profile."""
    if profile[36:40] != b"acsp":
        raise ValueError("no profile")
    (count,) = struct.unpack_from(">I", profile, 128)
    if count > _MOST_TAGS:
        raise ValueError("too many tags")
    tags = {}
    for number in range(count):
        tag, at, length = struct.unpack_from(">4sII", profile, 132 + 12 * number)
        tags[tag] = profile[at : at + length]
    name = _name(tags.get(b"desc", b""))
    needed = [color + kind for kind in (b"XYZ", b"TRC") for color in (b"r", b"g", b"b")]
    if profile[16:20] == b"GRAY":
        raise ValueError("gray images have their colors as they are")
    if profile[16:24] != b"RGB XYZ " or not all(tag in tags for tag in needed):
        return ColorProfile(name, None, None)
    matrix = np.stack([np.array(struct.unpack_from(">3i", tags[tag], 8)) / 65536 for tag in needed[:3]], axis=1)
    curves = np.stack([_curve(tags[tag]) for tag in needed[3:]])
    if not np.isfinite(curves).all() or abs(np.linalg.det(matrix)) < 1e-4:
        raise ValueError("no colors")
    return ColorProfile(name, np.clip(curves, 0, 1), matrix)


def _curve(tag):
    """(256,) linear light of the values of 8 bits."""
    value = np.arange(256) / 255
    if tag[:4] == b"curv":
        (count,) = struct.unpack_from(">I", tag, 8)
        if count == 0:
            return value
        if count == 1:
            return value ** (struct.unpack_from(">H", tag, 12)[0] / 256)
        if count > _LONGEST_CURVE:
            raise ValueError("too long a curve")
        table = np.array(struct.unpack_from(f">{count}H", tag, 12)) / 65535
        return np.interp(value, np.linspace(0, 1, count), table)
    if tag[:4] != b"para":
        raise ValueError("no curve")
    (kind,) = struct.unpack_from(">H", tag, 8)
    g, a, b, c, d, e, f = (*(np.array(struct.unpack_from(f">{_PARAMETERS[kind]}i", tag, 12)) / 65536), *(0.0,) * 7)[:7]
    if kind == 0:
        return value**g
    if kind > 0 and a == 0:
        raise ValueError("no curve")
    # The start of the curve is a line, or for the first two kinds a constant.
    begin, slope, offset, rise = (-b / a, 0.0, 0.0, 0.0) if kind == 1 else (-b / a, 0.0, c, c)
    if kind >= 3:
        begin, slope, offset, rise = d, c, f, e
    return np.where(value >= begin, np.maximum(a * value + b, 0) ** g + rise, slope * value + offset)


def _name(tag):
    """What a profile calls itself, in either form that the text has."""
    if tag[:4] == b"desc":
        (length,) = struct.unpack_from(">I", tag, 8)
        return tag[12 : 12 + min(length, 80)].rstrip(b"\0").decode("ascii", "replace")
    if tag[:4] == b"mluc":
        length, at = struct.unpack_from(">II", tag, 20)
        return tag[at : at + min(length, 160)].decode("utf-16-be", "replace")
    return ""
