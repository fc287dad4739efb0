"""Photos whose colors are in another space than sRGB: the profile that their file carries counts."""

import struct
import zlib

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.files.color_profiles import embedded_profile
from reflcolor_addon.files.images import read_image
from reflcolor_addon.srgb import srgb8_to_linear

# Linear Display P3, Adobe RGB (1998) and sRGB to XYZ under D50, as their profiles have them.
P3 = np.array([[0.51512, 0.29198, 0.15710], [0.24120, 0.69225, 0.06657], [-0.00105, 0.04189, 0.78407]])
ADOBE = np.array([[0.60974, 0.20528, 0.14919], [0.31111, 0.62567, 0.06322], [0.01947, 0.06087, 0.74457]])
SRGB = np.array([[0.43607, 0.38515, 0.14307], [0.22249, 0.71687, 0.06061], [0.01392, 0.09708, 0.71410]])
SRGB_CURVE = ("para", 3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
COLORS = np.array([[[200, 90, 60], [40, 150, 70], [60, 80, 190], [128, 128, 128], [255, 255, 255]]] * 3, np.uint8)


def fixed(*values):
    return struct.pack(f">{len(values)}i", *(round(value * 65536) for value in values))


def curve_tag(kind, *numbers):
    if kind == "para":
        return b"para\0\0\0\0" + struct.pack(">HH", numbers[0], 0) + fixed(*numbers[1:])
    return b"curv\0\0\0\0" + struct.pack(">I", len(numbers)) + struct.pack(f">{len(numbers)}H", *numbers)


def profile(matrix, curve, *, tables=False):
    """The bytes of an ICC profile."""
    name = b"made for a test"
    tags = {b"desc": b"desc\0\0\0\0" + struct.pack(">I", len(name) + 1) + name + b"\0"}
    if tables:
        tags[b"A2B0"] = b"mft2" + bytes(40)
    else:
        for index, color in enumerate((b"r", b"g", b"b")):
            tags[color + b"XYZ"] = b"XYZ \0\0\0\0" + fixed(*matrix[:, index])
            tags[color + b"TRC"] = curve_tag(*curve)
    place, table, body = 132 + 12 * len(tags), b"", b""
    for tag, content in tags.items():
        table += struct.pack(">4sII", tag, place + len(body), len(content))
        body += content + bytes(-len(content) % 4)
    head = bytearray(128)
    head[16:24], head[36:40] = b"RGB XYZ ", b"acsp"
    return bytes(head) + struct.pack(">I", len(tags)) + table + body


def png(rgb, icc):
    data = cv2.imencode(".png", rgb[..., ::-1])[1].tobytes()
    body = b"iCCP" + b"name\0\0" + zlib.compress(icc)
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    return data[:33] + chunk + data[33:]


def jpeg(rgb, icc):
    """In two segments, the second one first."""
    flat = np.repeat(np.repeat(rgb, 16, axis=0), 16, axis=1)
    data = cv2.imencode(".jpg", flat[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 100])[1].tobytes()
    half = len(icc) // 2
    parts = [b"ICC_PROFILE\0" + bytes([number, 2]) + part for number, part in ((2, icc[half:]), (1, icc[:half]))]
    return data[:2] + b"".join(b"\xff\xe2" + struct.pack(">H", len(part) + 2) + part for part in parts) + data[2:]


def tiff(rgb, icc):
    height, width = rgb.shape[:2]
    pixels = rgb.tobytes() + bytes(rgb.size % 2)
    bits, profile_at = 8 + len(pixels), 8 + len(pixels) + 6
    directory = profile_at + len(icc) + len(icc) % 2
    entries = [
        (256, 4, 1, width), (257, 4, 1, height), (258, 3, 3, bits), (259, 3, 1, 1), (262, 3, 1, 2), (273, 4, 1, 8),
        (277, 3, 1, 3), (278, 4, 1, height), (279, 4, 1, rgb.size), (34675, 7, len(icc), profile_at),
    ]  # fmt: skip
    table = b"".join(struct.pack("<HHII", *entry) for entry in entries)
    head = b"II*\0" + struct.pack("<I", directory) + pixels + struct.pack("<3H", 8, 8, 8) + icc + bytes(len(icc) % 2)
    return head + struct.pack("<H", len(entries)) + table + struct.pack("<I", 0)


def in_space(rgb, matrix, gamma):
    """The numbers that sRGB colors have in another space, by the definition of both."""
    light = srgb8_to_linear(rgb) @ (np.linalg.inv(matrix) @ SRGB).T
    if gamma is None:
        encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)
    else:
        encoded = np.maximum(light, 0) ** (1 / gamma)
    return np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)


@pytest.mark.parametrize("container", [png, jpeg, tiff])
@pytest.mark.parametrize("space", ["Display P3", "Adobe RGB"])
def test_colors_in_a_wider_space_are_converted(tmp_path, container, space):
    matrix, gamma, curve = {
        "Display P3": (P3, None, SRGB_CURVE),
        "Adobe RGB": (ADOBE, 563 / 256, ("curv", 563)),
    }[space]
    path = tmp_path / "photo"
    stored = in_space(COLORS, matrix, gamma)
    assert np.abs(stored.astype(int) - COLORS).max() > 8
    path.write_bytes(container(stored, profile(matrix, curve)))
    found = read_image(path)
    if container is jpeg:
        found = found[8::16, 8::16]
    # JPEG rounds, and the conversion raises that where a color is dark and saturated.
    np.testing.assert_allclose(found.astype(int), COLORS, atol=8 if container is jpeg else 3)


def test_colors_of_an_srgb_profile_stay_to_the_bit(tmp_path):
    path = tmp_path / "photo.png"
    path.write_bytes(png(COLORS, profile(SRGB, SRGB_CURVE)))
    np.testing.assert_array_equal(read_image(path), COLORS)


def test_a_table_of_a_curve_is_followed(tmp_path):
    path = tmp_path / "photo.png"
    table = np.rint(65535 * np.linspace(0, 1, 1024) ** 1.8).astype(int)
    path.write_bytes(png(in_space(COLORS, SRGB, 1.8), profile(SRGB, ("curv", *table))))
    np.testing.assert_allclose(read_image(path).astype(int), COLORS, atol=3)


def test_a_profile_of_tables_is_told_and_its_colors_are_taken_as_srgb(tmp_path):
    path, warnings = tmp_path / "photo.png", []
    path.write_bytes(png(COLORS, profile(None, None, tables=True)))
    np.testing.assert_array_equal(read_image(path, warnings), COLORS)
    assert warnings == [
        "photo.png: its color profile (made for a test) consists of tables, which are not supported; "
        "its colors are taken as sRGB"
    ]


@given(st.integers(0, 10_000), st.integers(0, 255), st.sampled_from([png, jpeg, tiff]))
def test_a_damaged_profile_or_file_never_fails(place, value, container):
    data = bytearray(container(COLORS, profile(P3, SRGB_CURVE)))
    data[place % len(data)] = value
    found = embedded_profile(bytes(data))
    assert found is None or found.to_srgb(COLORS).shape == COLORS.shape
    embedded_profile(bytes(data[: place % len(data)]))
