"""The number that stands for a material in a Cryptomatte layer of a render."""

import struct

_MASK = 0xFFFFFFFF


def name_as_float(name):
    """Return the float that stands for a name in a Cryptomatte rank channel.

    Parameters
    ----------
    name : str

    Returns
    -------
    float
        MurmurHash3 (32 bits, seed 0) of the UTF-8 name, read as a float32; one exponent bit is flipped where that would
        be a denormal, an infinity or no number (Cryptomatte specification 1.2).
    """
    bits = _murmur3_32(name.encode("utf-8"))
    if (bits >> 23) & 0xFF in (0, 0xFF):
        bits ^= 1 << 23
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def _murmur3_32(data):
    """MurmurHash3_x86_32 with seed 0 (A. Appleby, public domain)."""
    state = 0
    whole = len(data) // 4 * 4
    for (word,) in struct.iter_unpack("<I", data[:whole]):
        state = (_rotated(state ^ _mixed(word), 13) * 5 + 0xE6546B64) & _MASK
    state ^= _mixed(int.from_bytes(data[whole:], "little"))
    state ^= len(data)
    state = ((state ^ state >> 16) * 0x85EBCA6B) & _MASK
    state = ((state ^ state >> 13) * 0xC2B2AE35) & _MASK
    return state ^ state >> 16


def _mixed(word):
    return (_rotated((word * 0xCC9E2D51) & _MASK, 15) * 0x1B873593) & _MASK


def _rotated(word, places):
    return (word << places | word >> (32 - places)) & _MASK
