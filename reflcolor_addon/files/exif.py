"""When and where a photo was taken, as its camera wrote it (Exif 2.32): the date and the position, nothing else."""

import struct
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime

from ..errors import ReflcolorError
from .gate import opened

# Cameras write it at the beginning; a segment of a JPEG holds 64 KB at most.
_BEGINNING, _MOST_PARTS = 1 << 20, 256
_EXIF_IFD, _GPS_IFD, _TAKEN, _CHANGED = 0x8769, 0x8825, 0x9003, 0x0132
_SIZES = {2: 1, 3: 2, 4: 4, 5: 8}


@dataclass(frozen=True, kw_only=True)
class Moment:
    """When and where something was taken; each is None where that is not known.

    Parameters
    ----------
    seconds : float or None
        Since 1970, by the clock of the place: cameras seldom know their time zone.
    latitude, longitude : float or None
        Degrees, north and east.
    """

    seconds: float | None = None
    latitude: float | None = None
    longitude: float | None = None


def moment_of(path):
    """Return the `Moment` that a JPEG or PNG file tells; an empty one where it tells none, or cannot be read."""
    try:
        with opened(path, "a photo") as file:
            data = file.read(_BEGINNING)
        return _moment(_block(data))
    except (ReflcolorError, struct.error, LookupError, ValueError, OverflowError):
        return Moment()


def _block(data):
    """The block of Exif in the first bytes of a file: a TIFF of its own."""
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        at = 8
        for _ in range(_MOST_PARTS):
            length, kind = struct.unpack_from(">I4s", data, at)
            if kind == b"eXIf":
                return data[at + 8 : at + 8 + length]
            at += 12 + length
    elif data.startswith(b"\xff\xd8"):
        at = 2
        for _ in range(_MOST_PARTS):
            marker, length = struct.unpack_from(">HH", data, at)
            if marker == 0xFFE1 and data[at + 4 : at + 10] == b"Exif\0\0":
                return data[at + 10 : at + 2 + length]
            at += 2 + length
    raise ValueError("no Exif")


def _moment(block):
    order = {b"II*\0": "<", b"MM\0*": ">"}[bytes(block[:4])]
    whole = _tags(block, order, struct.unpack_from(order + "I", block, 4)[0])
    exif, gps = (_tags(block, order, whole[tag][0]) if tag in whole else {} for tag in (_EXIF_IFD, _GPS_IFD))
    return Moment(
        seconds=_seconds(exif.get(_TAKEN) or whole.get(_CHANGED)),
        latitude=_degrees(gps.get(1), gps.get(2), b"S", 90),
        longitude=_degrees(gps.get(3), gps.get(4), b"W", 180),
    )


def _tags(block, order, at):
    """The values of a directory, by their tags: bytes for texts, else a tuple of numbers."""
    (count,) = struct.unpack_from(order + "H", block, at)
    found = {}
    for number in range(min(count, _MOST_PARTS)):
        place = at + 2 + 12 * number
        tag, kind, length = struct.unpack_from(order + "HHI", block, place)
        size = length * _SIZES.get(kind, len(block))
        if size > len(block):
            continue
        start = place + 8 if size <= 4 else struct.unpack_from(order + "I", block, place + 8)[0]
        if kind == 2:
            found[tag] = bytes(block[start : start + length])
        elif kind == 5:
            parts = struct.unpack_from(f"{order}{2 * length}I", block, start)
            found[tag] = tuple(
                over / under if under else float("nan") for over, under in zip(parts[::2], parts[1::2], strict=True)
            )
        elif kind in (3, 4):
            found[tag] = struct.unpack_from(f"{order}{length}{'H' if kind == 3 else 'I'}", block, start)
    return found


def _seconds(text):
    with suppress(AttributeError, ValueError):
        taken = datetime.strptime(text.rstrip(b"\0 ").decode("ascii"), "%Y:%m:%d %H:%M:%S")
        return taken.replace(tzinfo=UTC).timestamp()
    return None


def _degrees(side, parts, negative, most):
    if not isinstance(side, bytes) or not isinstance(parts, tuple) or len(parts) != 3:
        return None
    degrees = parts[0] + parts[1] / 60 + parts[2] / 3600
    if not 0 <= degrees <= most:
        return None
    return -degrees if side[:1] == negative else degrees
