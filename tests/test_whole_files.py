"""A file of any kind that is cut short, or whose end was never written, is distinguished from a complete one."""

import json
import struct

import cv2
import numpy as np
import pytest
from pxr import Usd, UsdGeom
from small_scans import random_scan

from reflcolor_addon.files.e57_pages import checksums
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.whole import fault_of
from reflcolor_addon.files.writers import write_e57, write_ptx

IMAGE = np.random.default_rng(3).integers(0, 256, (20, 31, 3), np.uint8)


def ply(order):
    """Three vertices, and faces of three, four and three corners."""
    name = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
    header = (
        f"ply\nformat {name} 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\n"
        "property uchar red\nelement face 3\nproperty list uchar int vertex_indices\n"
        "element edge 2\nproperty int a\nproperty list ushort short b\nend_header\n"
    ).encode()
    if not order:
        return header + b"0 1 2\n" * 4 + b"3 0 1 2\n4 0 1 2 3\n3 1 2 3\n" + b"7 1 5\n" * 2
    vertices = struct.pack(f"{order}fdB", 0.5, 1.5, 200) * 4
    faces = b"".join(struct.pack(f"{order}B{n}i", n, *range(n)) for n in (3, 4, 3))
    return header + vertices + faces + struct.pack(f"{order}iHhh", 7, 2, 5, 6) * 2


def glb():
    description = json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 32}]}).encode()
    description += b" " * (-len(description) % 4)
    body = struct.pack("<I4s", len(description), b"JSON") + description + struct.pack("<I4s", 32, b"BIN\0") + bytes(32)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def blend(five):
    """Two blocks and the last one, with the header of Blender 5 or of those before."""
    head, start = ("<4siQqq", b"BLENDER17-01v0500") if five else ("<4siQII", b"BLENDER-v405")

    def block(code, data):
        fields = (code, 0, 1, len(data), 1) if five else (code, len(data), 1, 0, 1)
        return struct.pack(head, *fields) + data

    return start + block(b"SC\0\0", bytes(100)) + block(b"DNA1", bytes(60)) + block(b"ENDB", b"")


def packed_blend():
    """Frames of zstd (only their beginnings are looked at) and the table of a seekable file."""
    frames = [b"\x28\xb5\x2f\xfd" + bytes(size) for size in (50, 70)]
    table = b"".join(struct.pack("<II", len(frame), 1000) for frame in frames) + struct.pack("<IBI", 2, 0, 0x8F92EAB1)
    return b"".join(frames) + struct.pack("<II", 0x184D2A5E, len(table)) + table


@pytest.fixture
def whole(tmp_path, request):
    """A path with a whole file of the kind that the test asks for."""
    path = tmp_path / request.param
    kind = path.suffix.removeprefix(".")
    if kind == "png":
        write_png(path, IMAGE if path.stem == "color" else IMAGE[..., 0].astype(np.uint16) * 200)
    elif kind == "jpg":
        path.write_bytes(cv2.imencode(".jpg", IMAGE)[1])
    elif kind in ("ptx", "e57"):
        {"ptx": write_ptx, "e57": write_e57}[kind]([random_scan(), random_scan(1)], path)
    elif kind == "usd":
        stage = Usd.Stage.CreateNew(str(path))
        UsdGeom.Mesh.Define(stage, "/wall").CreatePointsAttr([(0.0, 0.0, number) for number in range(50)])
        stage.Save()
    elif kind == "blend":
        path.write_bytes(packed_blend() if path.stem == "packed" else blend(path.stem == "five"))
    elif kind == "json":
        path.write_text(json.dumps({"numbers": list(range(50))}))
    else:
        orders = {"little": "<", "big": ">", "text": ""}
        path.write_bytes(glb() if kind == "glb" else ply(orders[path.stem]))
    return path


KINDS = (
    *("color.png", "gray.png", "photo.jpg", "report.json", "little.ply", "big.ply", "text.ply", "scene.glb"),
    *("scene.usd", "four.blend", "five.blend", "packed.blend", "garage.ptx", "garage.e57"),
)


@pytest.mark.parametrize("whole", KINDS, indirect=True)
def test_a_whole_file_is_whole(whole):
    assert fault_of(whole) is None


@pytest.mark.parametrize("whole", KINDS, indirect=True)
def test_a_file_that_is_cut_anywhere_is_told(whole):
    data = whole.read_bytes()
    for place in {*range(0, len(data), max(1, len(data) // 60)), len(data) - 1}:
        whole.write_bytes(data[:place])
        assert fault_of(whole) is not None, place


@pytest.mark.parametrize(
    "whole", [name for name in KINDS if name.endswith(("png", "jpg", "json", "ptx", "e57"))], indirect=True
)
def test_a_file_whose_end_was_never_written_is_told(whole):
    data = whole.read_bytes()
    for place in range(0, len(data) - 4, max(1, len(data) // 60)):
        whole.write_bytes(data[:place] + bytes(len(data) - place))
        assert fault_of(whole) is not None, place


@pytest.mark.parametrize("whole", ["color.png", "garage.e57"], indirect=True)
def test_a_bit_that_has_changed_is_told(whole):
    data = bytearray(whole.read_bytes())
    data[len(data) // 2] ^= 1
    whole.write_bytes(data)
    assert fault_of(whole) is not None


def test_what_is_missing_is_counted(tmp_path):
    path = tmp_path / "a.ply"
    path.write_bytes(ply("<")[:-20])
    assert fault_of(path) == "2 records are missing"
    path.write_bytes(ply("<")[:-1])
    assert fault_of(path).startswith("it is cut short: ")
    path.write_bytes(ply("<") + b"more")
    assert fault_of(path) == "4 bytes follow its end"


def test_pixels_that_a_png_lacks_are_told(tmp_path):
    tall, short = tmp_path / "tall.png", tmp_path / "short.png"
    write_png(tall, IMAGE)
    write_png(short, IMAGE[:-1])
    header = tall.read_bytes()[:33]
    short.write_bytes(header + short.read_bytes()[33:])
    assert fault_of(short) == "some of its pixels are missing"


def test_a_file_of_another_kind_is_whole_if_it_holds_anything(tmp_path):
    path = tmp_path / "notes.txt"
    assert fault_of(path) == "there is no file"
    path.touch()
    assert fault_of(path) == "it is empty"
    path.write_text("a")
    assert fault_of(path) is None


def test_the_checksum_is_that_of_the_standard():
    # The check value of CRC-32C is that of "123456789"; of 1020 zeros it was computed bit by bit here.
    value = 0xFFFFFFFF
    for _ in range(8 * 1020):
        value = (value >> 1) ^ (0x82F63B78 if value & 1 else 0)
    assert checksums(np.zeros((2, 1020), np.uint8)).tolist() == [value ^ 0xFFFFFFFF] * 2
