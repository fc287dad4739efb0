"""Checks whether the size in a picture's header is usable."""

from ..errors import ImageError
from ..messages import Message
from ..scan.limits import MOST_PIXELS
from .memory import require_memory

_LONGEST_SIDE = 1 << 20
# Peak memory of decoding and converting to sRGB, in copies of the decoded picture.
_COPIES = 4


def require_size(width, height, pixel_bytes, name, *, most):
    """Raise ImageError where a picture has no size, an implausible one, or one that does not fit into memory.

    Parameters
    ----------
    width, height : int
    pixel_bytes : int
        Of a decoded pixel.
    name : str
        The file's, for messages.
    most : int
        Bytes that the file can become at most.
    """
    if not (0 < width <= _LONGEST_SIDE and 0 < height <= _LONGEST_SIDE and width * height <= MOST_PIXELS):
        raise ImageError(
            "{file}: claims to be {width:,} x {height:,} pixels, expected 1 to {most:,} in all; make it smaller",
            file=name,
            width=width,
            height=height,
            most=MOST_PIXELS,
        )
    size = width * height * pixel_bytes
    if size > most:
        raise ImageError(
            "{file}: claims to be {width:,} x {height:,} pixels, more than the file can hold",
            file=name,
            width=width,
            height=height,
        )
    require_memory(
        size * _COPIES,
        Message("{file}: {width:,} x {height:,} pixels", file=name, width=width, height=height),
        error=ImageError,
    )
