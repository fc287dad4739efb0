"""TIFF pictures, decided by their own tags: planes, sample format, bits, extra samples, photometric, predictor.

OpenCV reads some layouts wrongly without an error: separate planes of 16 bits stay unset, signed samples end in an
error, gray with alpha loses bits, white-is-zero is inverted for 8 bits only, colors are multiplied by their alpha.
So it only unpacks LZW and PackBits here, strip by strip, and what the samples mean is worked out from the tags (TIFF
6.0; technical note 3 for floating point).
"""

import struct
import zlib
from dataclasses import dataclass

import numpy as np

from ..errors import ImageError
from ..messages import Message

SIGNATURES = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_FORMATS = {1: "B", 2: "B", 3: "H", 4: "I", 6: "b", 7: "B", 8: "h", 9: "i", 13: "I", 16: "Q"}
_MOST_TAGS, _MOST_VALUES = 1000, 1 << 22
_MOST_PICTURES = 1000
_KIND_OF_PICTURE, _REDUCED_OR_MASK = 254, 1 | 4
_NONE, _JPEG, _DEFLATE = 1, 7, (8, 32946)
_COMPRESSIONS = {1: "none", 5: "LZW", 7: "JPEG", 8: "Deflate", 32773: "PackBits", 32946: "Deflate"}
_WHITE_IS_ZERO, _BLACK_IS_ZERO, _RGB, _PALETTE, _YCBCR = 0, 1, 2, 3, 6
_COLORS = {_WHITE_IS_ZERO: 1, _BLACK_IS_ZERO: 1, _RGB: 3}
_MULTIPLIED, _ALONE = 1, 2
_UNSIGNED, _SIGNED, _FLOATING, _UNDEFINED = 1, 2, 3, 4
_KINDS = {_UNSIGNED: "u", _SIGNED: "i", _FLOATING: "f", _UNDEFINED: "u"}


@dataclass(frozen=True, eq=False, kw_only=True)
class TiffLayout:
    """What the tags of the first picture of a file say.

    Parameters
    ----------
    width, height, samples, bits : int
    dtype : np.dtype or None
        Of a sample; None for kinds that cannot be taken apart here.
    photometric, compression, predictor, orientation : int
        As the tags have them.
    planar : bool
        Every sample has a plane of its own.
    alpha : int or None
        Which sample is the opacity, from 0.
    multiplied : bool
        Whether the colors are multiplied by the opacity.
    tile : (width, height) or None
    rows : int
        Of a strip.
    places, sizes : tuple of int
        Of the strips or tiles in the file.
    pictures : int
        How many the file holds; small copies of them, as for a preview, do not count.
    """

    width: int
    height: int
    samples: int
    bits: int
    dtype: np.dtype | None
    photometric: int
    compression: int
    predictor: int
    orientation: int
    planar: bool
    alpha: int | None
    multiplied: bool
    tile: tuple[int, int] | None
    rows: int
    places: tuple[int, ...]
    sizes: tuple[int, ...]
    pictures: int


def is_tiff(start):
    """True where the first bytes of a file are those of a TIFF."""
    return bytes(start[:4]) in SIGNATURES


def tiff_layout(data, name):
    """Return the TiffLayout of the first picture in the bytes of a file.

    Raises
    ------
    ImageError
        In one line, if its tags are damaged, or speak of a kind that is not read.
    """
    try:
        tags, behind = _directory(data, None)
        return _layout(tags, 1 + _others(data, behind), len(data), name)
    except ImageError:
        raise
    except (struct.error, LookupError, ValueError, OverflowError):
        raise ImageError("{file}: not a whole TIFF: its tags are damaged or cut short", file=name) from None


def _layout(tags, pictures, file_size, name):
    def refuse(found, expected):
        raise ImageError(
            "{file}: is a TIFF with {found}, expected {expected}; save it as PNG, or as a plain TIFF",
            file=name,
            found=found,
            expected=expected,
        )

    width, height = tags[256][0], tags[257][0]
    if not (width and height):
        raise ValueError("no pixels")
    samples = tags.get(277, (1,))[0]
    depths = set(tags.get(258, (1,))[:samples])
    compression, predictor = tags.get(259, (_NONE,))[0], tags.get(317, (1,))[0]
    photometric = tags[262][0]
    formats = set(tags.get(339, (_UNSIGNED,))[:samples])
    extra = tags.get(338, ())
    if tags.get(_KIND_OF_PICTURE, (0,))[0] & 1:
        refuse(Message("a reduced image as its first one, as raw photos have"), Message("a developed photo"))
    if not 1 <= samples <= 64 or len(depths) != 1 or len(formats) != 1:
        refuse(Message("samples of several kinds"), Message("the same bits and format for all"))
    if tags.get(266, (1,))[0] != 1:
        refuse(Message("bits in reversed order (fill order 2)"), Message("the usual order"))
    if compression not in _COMPRESSIONS:
        known = ", ".join(dict.fromkeys(_COMPRESSIONS.values()))
        refuse(Message("the compression {number}", number=compression), Message("one of {choices}", choices=known))
    (bits,), (form,) = depths, formats
    if photometric not in (*_COLORS, _PALETTE, _YCBCR):
        refuse(Message("the photometric interpretation {number}", number=photometric), Message("gray or RGB"))
    colors = _COLORS.get(photometric, samples)
    if colors > samples:
        refuse(Message("{count} samples", count=samples), Message("at least {count}", count=colors))
    alpha = next((colors + place for place, kind in enumerate(extra) if kind in (_MULTIPLIED, _ALONE)), None)
    if alpha is not None and alpha >= samples:
        refuse(Message("an alpha channel that is not one of its samples"), Message("one of them"))
    dtype = None
    if photometric in _COLORS and compression != _JPEG:
        if bits not in (8, 16, 32, 64) or form not in _KINDS or (form == _FLOATING and bits == 8):
            refuse(
                Message("{bits} bits of the format {number}", bits=bits, number=form),
                Message("8, 16, 32 or 64 bits, whole numbers or floating point"),
            )
        dtype = np.dtype(f"{_KINDS[form]}{bits // 8}")
        if photometric == _WHITE_IS_ZERO and dtype.kind != "u":
            refuse(Message("white as zero in numbers without a greatest value"), Message("black as zero"))
        if (
            predictor not in (1, 2, 3)
            or ((predictor == 2) and dtype.kind == "f")
            or ((predictor == 3) and dtype.kind != "f")
        ):
            refuse(Message("the predictor {number}", number=predictor), Message("1, 2 or, for floating point, 3"))
    elif bits != 8 or extra or form not in (_UNSIGNED, _UNDEFINED) or tags.get(284, (1,))[0] != 1:
        refuse(Message("a palette, YCbCr or JPEG in an unusual layout"), Message("gray or RGB"))
    elif tags.get(274, (1,))[0] != 1:
        refuse(Message("a palette, YCbCr or JPEG that is turned"), Message("an upright one"))
    tile = (tags[322][0], tags[323][0]) if 322 in tags else None
    if tile and not all(tile):
        raise ValueError("no pixels")
    rows = max(1, min(tags.get(278, (height,))[0], height))
    planar = samples > 1 and tags.get(284, (1,))[0] == 2
    places, sizes = tags[324 if tile else 273], tags[325 if tile else 279]
    parts = -(-width // tile[0]) * -(-height // tile[1]) if tile else -(-height // rows)
    if len(places) != len(sizes) or len(places) != parts * (samples if planar else 1):
        raise ValueError("parts are missing")
    if any(place + size > file_size for place, size in zip(places, sizes, strict=True)):
        raise ImageError("{file}: not a whole TIFF: it is damaged or cut short", file=name)
    return TiffLayout(
        width=width,
        height=height,
        samples=samples,
        bits=bits,
        dtype=dtype,
        photometric=photometric,
        compression=compression,
        predictor=predictor,
        orientation=tags.get(274, (1,))[0],
        planar=planar,
        alpha=alpha,
        multiplied=alpha is not None and extra[alpha - colors] == _MULTIPLIED,
        tile=tile,
        rows=rows,
        places=places,
        sizes=sizes,
        pictures=pictures,
    )


def tiff_pixels(data, layout, name, decode):
    """Return the colors of a picture, and its opacity.

    Parameters
    ----------
    data : bytes-like
        The file.
    layout : TiffLayout
        With a dtype.
    name : str
        The file's, for messages.
    decode : callable
        Called as ``decode(data)`` with the bytes of a gray TIFF of 8 bits; returns (H, W) uint8, or raises ImageError.

    Returns
    -------
    values : (H, W) or (H, W, 3) array
        Of the layout's dtype (half floats as float32), black at 0, not multiplied by the opacity.
    alpha : (H, W) array or None

    Raises
    ------
    ImageError
        In one line.
    """
    samples = _samples(data, layout, name, decode)
    if samples.dtype == np.float16:
        samples = samples.astype(np.float32)
    values = samples[..., : _COLORS[layout.photometric]]
    alpha = None if layout.alpha is None else samples[..., layout.alpha]
    if layout.photometric == _WHITE_IS_ZERO:
        values = np.iinfo(values.dtype).max - values
    if layout.multiplied:
        values = _divided(values, alpha)
    return (values[..., 0] if values.shape[-1] == 1 else values), alpha


def upright(image, orientation):
    """Return an (H, W, ...) image as its tag of orientation, 1 to 8, wants it shown."""
    if orientation in (5, 6, 7, 8):
        image = image.swapaxes(0, 1)
    if orientation in (3, 4, 7, 8):
        image = image[::-1]
    if orientation in (2, 3, 6, 7):
        image = image[:, ::-1]
    return np.ascontiguousarray(image)


def _divided(values, alpha):
    """Colors that were multiplied by the opacity, as they were before; 0 where nothing is seen."""
    whole = values.dtype.kind in "ui"
    most = float(np.iinfo(values.dtype).max) if whole else 1.0
    if whole and most > np.iinfo(values.dtype).max:
        # The greatest whole number of 64 bits is no double.
        most = np.nextafter(most, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        single = np.where(alpha[..., None] > 0, values * (most / alpha[..., None].astype(np.float64)), 0)
    return np.clip(np.rint(single), 0, most).astype(values.dtype) if whole else single.astype(values.dtype)


def _samples(data, layout, name, decode):
    """(H, W, S) array of all samples as they are stored, in this machine's byte order."""
    planes = layout.samples if layout.planar else 1
    each = layout.samples // planes
    stored = layout.dtype.newbyteorder("<" if data[:2] == b"II" else ">")
    width, height = layout.tile or (layout.width, layout.rows)
    samples = np.empty((layout.height, layout.width, layout.samples), layout.dtype)
    corners = [
        (plane, top, left)
        for plane in range(planes)
        for top in range(0, layout.height, height)
        for left in range(0, layout.width, width)
    ]
    for (plane, top, left), place, size in zip(corners, layout.places, layout.sizes, strict=True):
        # Tiles are whole beyond the picture's edge, strips end with it.
        rows = height if layout.tile else min(height, layout.height - top)
        length = width * each * stored.itemsize
        packed = data[place : place + size]
        block = _unpacked(packed, layout.compression, rows, length, decode)
        if block is None:
            raise ImageError("{file}: not a whole TIFF: it is damaged or cut short", file=name)
        block = _summed(block, layout.predictor, stored, (rows, width, each))
        here = samples[top : top + height, left : left + width, plane * each : (plane + 1) * each]
        here[:] = block[: here.shape[0], : here.shape[1]]
    return samples


def _unpacked(packed, compression, rows, length, decode):
    """(rows, length) bytes of a strip or tile; None where there are fewer."""
    if compression == _NONE:
        flat = packed
    elif compression in _DEFLATE:
        try:
            flat = zlib.decompressobj().decompress(packed, rows * length)
        except zlib.error:
            return None
    else:
        flat = decode(_gray_tiff(packed, compression, rows, length)).tobytes()
    if len(flat) < rows * length:
        return None
    return np.frombuffer(flat, np.uint8, rows * length).reshape(rows, length)


def _summed(block, predictor, stored, shape):
    """Samples of (rows, bytes) that hold differences from pixel to pixel, where there is a predictor."""
    rows, width, each = shape
    if predictor == 3:
        # Differences of bytes, and of every row first the most significant bytes of all samples.
        sums = np.cumsum(block.reshape(rows, -1, each), axis=1, dtype=np.uint8)
        order = np.ascontiguousarray(sums.reshape(rows, stored.itemsize, width * each).swapaxes(1, 2))
        return order.view(stored.newbyteorder(">")).reshape(shape)
    block = block.view(stored).reshape(shape)
    if predictor == 2:
        return np.cumsum(block, axis=1, dtype=stored.newbyteorder("="))
    return block


def _gray_tiff(packed, compression, rows, length):
    """A TIFF of one gray strip of 8 bits, for what only OpenCV unpacks."""
    tags = {256: length, 257: rows, 258: 8, 259: compression, 262: _BLACK_IS_ZERO, 273: 8, 277: 1, 278: rows}
    tags[279] = len(packed)
    packed = packed + bytes(len(packed) % 2)
    entries = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags.items())
    return struct.pack("<2sHI", b"II", 42, 8 + len(packed)) + packed + struct.pack("<H", len(tags)) + entries + bytes(4)


def _others(data, at):
    """How many pictures of full size a file holds from the directory at a place on; as far as they can be read."""
    count, seen = 0, set()
    while at and at not in seen and len(seen) < _MOST_PICTURES:
        seen.add(at)
        try:
            tags, at = _directory(data, at)
        except (struct.error, ValueError, OverflowError):
            break
        count += not tags.get(_KIND_OF_PICTURE, (0,))[0] & _REDUCED_OR_MASK
    return count


def _directory(data, at):
    """Values of every tag of whole numbers of a picture, by number, and the place of the next one's tags or 0.

    ``at`` is the place of its own tags; None for the first picture.
    """
    order = "<" if data[:2] == b"II" else ">"
    large = struct.unpack_from(f"{order}H", data, 2)[0] == 43
    head, entry, inside = ("Q", "HHQQ", 8) if large else ("H", "HHII", 4)
    link = f"{order}{'Q' if large else 'I'}"
    if at is None:
        (at,) = struct.unpack_from(link, data, 8 if large else 4)
    (count,) = struct.unpack_from(order + head, data, at)
    at += struct.calcsize(order + head)
    if count > _MOST_TAGS:
        raise ValueError("too many tags")
    tags = {}
    for number in range(count):
        place = at + number * struct.calcsize(order + entry)
        tag, kind, length, value = struct.unpack_from(order + entry, data, place)
        if kind not in _FORMATS or not 0 < length <= _MOST_VALUES:
            continue
        form = f"{order}{length}{_FORMATS[kind]}"
        place = place + struct.calcsize(order + entry) - inside if struct.calcsize(form) <= inside else value
        tags[tag] = struct.unpack_from(form, data, place)
    behind = at + count * struct.calcsize(order + entry)
    # Some writers forget the end of the list.
    return tags, struct.unpack_from(link, data, behind)[0] if behind + struct.calcsize(link) <= len(data) else 0
