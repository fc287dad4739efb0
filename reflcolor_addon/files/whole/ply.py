"""Whether a PLY holds every record that its header announces."""

import numpy as np

from .fault import Fault, require_end

_SIZES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
_LONGEST_HEADER = 1 << 16
_CHUNK = 1 << 20
_LONGEST_RECORD = 1 << 26


def check_ply(file, size):
    """A PLY, as text or binary, with exactly the records of its header."""
    order, elements, at = _header(file)
    if order is None:
        _check_text(file, sum(count for count, _ in elements))
        return
    for count, properties in elements:
        file.seek(at)
        at = _end_of(file, at, size, order, count, properties)
    require_end(at, size)


def _header(file):
    """Byte order (None for text), (count, properties) of each element, and where the records begin.

    A property is a size, or for a list a pair of sizes: of its length, and of one item.
    """
    lines = []
    while not lines or lines[-1] != "end_header":
        line = file.readline(_LONGEST_HEADER)
        if not line.endswith(b"\n") or file.tell() > _LONGEST_HEADER:
            raise Fault("its header is cut short")
        lines.append(line.decode("ascii", "replace").strip())
    if lines[0] != "ply":
        raise Fault("it is not a PLY")
    order, elements = None, []
    for word, *words in (line.split() for line in lines[1:] if line):
        if word == "format":
            order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[words[0]]
        elif word == "element":
            elements.append((int(words[-1]), []))
        elif word == "property":
            found = (_SIZES[words[1]], _SIZES[words[2]]) if words[0] == "list" else _SIZES[words[0]]
            elements[-1][1].append(found)
    return order, elements, file.tell()


def _end_of(file, at, size, order, count, properties):
    """Where the records of an element end, in bytes from the start of the file."""
    if not any(isinstance(found, tuple) for found in properties):
        return at + count * sum(properties)
    order = "little" if order == "<" else "big"
    while count:
        file.seek(at)
        data = file.read(_CHUNK)
        if not data:
            raise Fault("{count:,} records are missing", count=count)
        done, length = _records(data, order, count, properties)
        if not done:
            # A record that is longer than a chunk, or its list's length was cut off.
            done, length = _records(data + file.read(_LONGEST_RECORD), order, 1, properties)
            if not done:
                raise Fault("{count:,} records are missing", count=count)
        at, count = at + length, count - done
    return at


def _records(data, order, count, properties):
    """How many records, at most ``count``, begin in this piece of the file, and where the last of them ends."""
    at = done = 0
    (first, *others), end = properties, len(data)
    if not others and isinstance(first, tuple) and first[0] == 1:
        # Faces in the usual form, mostly with as many corners as the first one.
        item = first[1]
        lengths = np.frombuffer(data, np.uint8)[:: 1 + item * data[0]][:count]
        other = np.flatnonzero(lengths != data[0])
        done = int(other[0]) if other.size else lengths.size
        at = done * (1 + item * data[0])
        while done < count and at < end:
            at += 1 + item * data[at]
            done += 1
        return done, at
    while done < count:
        place = at
        for found in properties:
            if isinstance(found, tuple):
                if place + found[0] > end:
                    return done, at
                place += found[0] + found[1] * int.from_bytes(data[place : place + found[0]], order)
            else:
                place += found
        at, done = place, done + 1
    return done, at


def _check_text(file, expected):
    found, line = 0, b""
    for line in file:
        found += not line.isspace()
    if found < expected or not line.endswith(b"\n"):
        raise Fault("{count:,} records are missing", count=max(1, expected - found))
