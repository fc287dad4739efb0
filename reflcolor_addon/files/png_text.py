"""What a PNG file tells beside its pixels."""

import struct

_TELLING = (b"tEXt", b"zTXt", b"iTXt", b"tIME")


def without_text(png):
    """Return the bytes of a PNG file without its texts and times; pixels and color space stay.

    Of a file that is cut off, all that is there is returned.
    """
    kept, at = [png[:8]], 8
    while at + 12 <= len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        if kind not in _TELLING:
            kept.append(png[at : at + 12 + length])
        at += 12 + length
    return b"".join((*kept, png[at:]))
