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
        end = at + 12 + length
        if kind not in _TELLING or end > len(png):
            kept.append(png[at:end])
        at = end
    return b"".join((*kept, png[at:]))
