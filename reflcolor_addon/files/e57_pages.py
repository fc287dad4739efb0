"""The pages of an E57 file: 1020 bytes of contents and their checksum each (ASTM E2807, section 7)."""

import struct
from functools import cache

import numpy as np

PAGE, PAYLOAD = 1024, 1020
HEADER = struct.Struct("<8sIIQQQQ")
"""Signature, major and minor version, length of the file, start and length of the XML section, size of a page."""

_POLYNOMIAL = 0x82F63B78
_PAGES_AT_ONCE = 1024


def first_bad_page(file, start, count):
    """Return the number of the first page whose checksum is wrong; None where all are right.

    Parameters
    ----------
    file : binary file
    start, count : int
        Number of the first page to look at, and how many.

    Raises
    ------
    EOFError
        If the file has fewer pages.
    """
    file.seek(start * PAGE)
    done = 0
    while done < count:
        pages = min(count - done, _PAGES_AT_ONCE)
        data = file.read(pages * PAGE)
        if len(data) < pages * PAGE:
            raise EOFError
        data = np.frombuffer(data, np.uint8).reshape(pages, PAGE)
        wrong = checksums(data[:, :PAYLOAD]) != data[:, PAYLOAD:].copy().view(">u4").ravel()
        if wrong.any():
            return start + done + int(np.argmax(wrong))
        done += pages
    return None


def contents(file, start, length):
    """Return ``length`` bytes of contents from a place of the file on, across pages, without their checksums.

    Raises
    ------
    EOFError
        If the file ends before that, or ``start`` lies in a checksum.
    """
    if start % PAGE >= PAYLOAD:
        raise EOFError
    before = start % PAGE
    pages = -(-(before + length) // PAYLOAD)
    file.seek(start - before)
    data = file.read(pages * PAGE)
    if len(data) < pages * PAGE:
        raise EOFError
    joined = np.frombuffer(data, np.uint8).reshape(pages, PAGE)[:, :PAYLOAD].tobytes()
    return joined[before : before + length]


def checksums(pages):
    """Return the (N,) uint32 CRC-32C of (N, 1020) uint8, each two bytes at a time, all pages together."""
    table = _table()
    words = np.ascontiguousarray(pages).view("<u2").astype(np.uint32)
    value = np.full(len(words), 0xFFFFFFFF, np.uint32)
    for word in words.T.copy():
        value = table[(value ^ word) & 0xFFFF] ^ (value >> 16)
    return ~value


@cache
def _table():
    value = np.arange(1 << 16, dtype=np.uint32)
    for _ in range(16):
        value = (value >> 1) ^ np.where(value & 1, np.uint32(_POLYNOMIAL), np.uint32(0))
    return value
