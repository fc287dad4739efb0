"""Random changes of a file: of bytes, of numbers in its text, of its structure, with its checksums mended or not."""

import json
import re
import struct
import zlib

from e57_samples import with_valid_checksums

_NUMBERS = (
    *("0", "1", "-1", "2", "3", "255", "256", "65535", "65536", "2147483647", "-2147483648", "4294967296", "1e9"),
    *(
        "9223372036854775807",
        "99999999999999999999",
        "1e-300",
        "1e300",
        "1e308",
        "1e400",
        "-1e300",
        "nan",
        "inf",
        "-inf",
    ),
    *("inf", "-inf", "0.5", "-0.0", "abc", "", "0x10", "1_000", "٣", "9" * 400, "1e", ".", "--1"),
)
_BYTES = (0, 1, 0x7F, 0x80, 0xFE, 0xFF, 0x20, 0x0A, 0x22, 0x3C, 0x7B)
_VALUES = (
    *(None, True, False, 0, -1, 1, 3, 255, 1e300, -1e300, 1e-300, 2**31, 2**63, 2**70, 10**400, float("nan")),
    *(float("inf"), "", "x", "..", "/", "a" * 5000, "\0", "\ud800", "../../a.png", [], {}, [[]], [0] * 3, {"a": 1}),
)
_TOKEN = re.compile(rb"[-+]?[0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?")
_TEXTS = {"E57", "PTX", "PCD", "PLY", "text", "manifest", "pairs"}
_JSON = {"image pair", "seeds", "report"}


def mutated(kind, data, others, chance):
    """Return the bytes of a changed file.

    Parameters
    ----------
    kind : str
        As in `samples`.
    data : bytes
        A valid file.
    others : sequence of bytes
        Valid files of the same kind, to take pieces from.
    chance : random.Random
    """
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        ways = [_bytes, _bytes, _integers, _cut, _doubled, _spliced]
        if kind in _TEXTS:
            ways += [_numbers] * 6 + [_lines] * 2
        if kind == "E57":
            ways += [_tags] * 6
        if kind in _JSON:
            ways += [_document] * 8
        data = chance.choice(ways)(bytearray(data), others, chance)
    if kind == "E57" and chance.random() < 0.9:
        return _mended_e57(data)
    if kind == "PNG" and chance.random() < 0.8:
        return _mended_png(data)
    return bytes(data)


def _bytes(data, _others, chance):
    for _ in range(chance.choice((1, 1, 2, 8))):
        if data:
            at = chance.randrange(len(data))
            turned = data[at] ^ (1 << chance.randrange(8))
            data[at] = chance.choice((chance.choice(_BYTES), chance.randrange(256), turned))
    return data


def _integers(data, _others, chance):
    """A number of 2, 4 or 8 bytes, of either order, in the file's first part or anywhere."""
    form = chance.choice("HIQ")
    order = chance.choice("<>")
    size = struct.calcsize(form)
    end = min(len(data), 200) if chance.random() < 0.7 else len(data)
    if end <= size:
        return data
    top = 1 << (8 * size)
    value = chance.choice((0, 1, top - 1, top // 2, top // 2 - 1, chance.randrange(1 << 16), chance.randrange(top)))
    at = chance.randrange(end - size)
    data[at : at + size] = struct.pack(order + form, value % top)
    return data


def _cut(data, _others, chance):
    del data[chance.randrange(len(data) + 1) :]
    return data


def _doubled(data, _others, chance):
    start = chance.randrange(len(data) + 1)
    piece = data[start : start + chance.choice((1, 4, 16, 100, 1024))]
    at = chance.randrange(len(data) + 1)
    return data[:at] + piece * chance.choice((1, 1, 2, 50)) + data[at + chance.choice((0, len(piece))) :]


def _spliced(data, others, chance):
    other = chance.choice(others)
    return data[: chance.randrange(len(data) + 1)] + other[chance.randrange(len(other) + 1) :]


def _numbers(data, _others, chance):
    """Some of the numbers that stand in the text are others."""
    tokens = list(_TOKEN.finditer(data))
    for token in chance.sample(tokens, min(len(tokens), chance.choice((1, 1, 2, 5)))):
        if token.end() <= len(data):
            new = chance.choice(_NUMBERS).encode()
            # Of the same length, so that what comes after stays in its place, or not.
            if chance.random() < 0.6:
                new = new[: len(token[0])].ljust(len(token[0]))
                data[token.start() : token.end()] = new
            else:
                return data[: token.start()] + new + data[token.end() :]
    return data


def _lines(data, _others, chance):
    """A line is gone, doubled, or in another place."""
    lines = data.split(b"\n")
    line = lines[chance.randrange(len(lines))]
    if chance.random() < 0.7:
        lines.remove(line)
    for _ in range(chance.choice((0, 1, 1, 3))):
        lines.insert(chance.randrange(len(lines) + 1), line)
    return bytearray(b"\n".join(lines))


def _tags(data, _others, chance):
    """The XML of an E57: a name, a type or a whole element is another; its length is kept where that is possible."""
    start = data.rfind(b"<?xml")
    if start < 0:
        return data
    words = list(re.finditer(rb"[A-Za-z][A-Za-z0-9]+", data[start:]))
    if len(words) < 2:
        return data
    one, other = chance.sample(words, 2)
    new = chance.choice((other[0], b"Vector", b"Structure", b"Float", b"String", b"points", b"x"))
    if chance.random() < 0.7:
        new = new[: len(one[0])].ljust(len(one[0]), b"x")
    return data[: start + one.start()] + new + data[start + one.end() :]


def _document(data, _others, chance):
    """A value of a JSON document is another, gone, or has another name."""
    try:
        document = json.loads(data)
    except ValueError:
        return data
    if not isinstance(document, dict | list) or not document:
        return data
    places = list(_places(document))
    holder, key = chance.choice(places)
    act = chance.random()
    if act < 0.7:
        holder[key] = chance.choice(_VALUES)
    elif act < 0.8 and isinstance(holder, dict):
        holder[chance.choice(("x", "range", "rgb", "model", "path"))] = holder.pop(key)
    elif act < 0.9:
        del holder[key]
    else:
        other, place = chance.choice(places)
        holder[key] = other[place]
    try:
        return bytearray(json.dumps(document).encode())
    except (ValueError, RecursionError):  # put into itself
        return data


def _places(value):
    for key, child in value.items() if isinstance(value, dict) else enumerate(value):
        yield value, key
        if isinstance(child, dict | list):
            yield from _places(child)


def _mended_e57(data):
    # What was made longer or shorter is filled up to whole pages, and the header says so.
    data = bytearray(data)
    if len(data) > 48 and len(data) % 1024:
        data += bytes(-len(data) % 1024)
        data[16:24] = struct.pack("<Q", len(data))
    return with_valid_checksums(bytes(data))


def _mended_png(data):
    """The checksums of a PNG's chunks are those of their contents; of pixels that are changed, too."""
    out, at = bytearray(data[:8]), 8
    while at + 12 <= len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        if at + 12 + length > len(data):
            break
        body = data[at + 4 : at + 8 + length]
        out += data[at : at + 4] + body + struct.pack(">I", zlib.crc32(body))
        at += 12 + length
    return bytes(out + data[at:])
