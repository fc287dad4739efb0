"""How large a scan is, and whether it can be read at all, by the header of its file."""

import json

import numpy as np
import pytest
from colored_scans import surface_of
from e57_samples import write_e57
from sample_scans import intensity_of, ptx_text, room_points
from small_scans import random_scan

from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.readers import ReadOptions, read_scans, scan_pixels
from reflcolor_addon.files.writers.ply import write_ply

POINTS = room_points()
INTENSITY = intensity_of(POINTS)
SHAPE = INTENSITY.shape
ROW, COLUMN = (index.ravel() for index in np.indices(SHAPE))
XYZ = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), POINTS.reshape(-1, 3).T, strict=True))


def ptx(path):
    path.write_text(ptx_text(POINTS, INTENSITY))


def e57(path):
    write_e57(path, {"fields": XYZ | {"intensity": INTENSITY.ravel(), "rowIndex": ROW, "columnIndex": COLUMN}})


def pcd(path):
    head = f"VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH {SHAPE[1]}\nHEIGHT {SHAPE[0]}\nDATA binary\n"
    path.write_bytes(head.encode() + POINTS.tobytes())


def ply(path):
    write_ply([surface_of(random_scan(shape=SHAPE), np.zeros((*SHAPE, 3), np.uint8))], path)


def npz(path):
    np.savez(path, xyz=POINTS, intensity=INTENSITY)


def pair(path):
    for name in ("range.png", "ir.png"):
        write_png(path.with_name(name), np.random.default_rng(0).integers(1, 900, SHAPE).astype(np.uint16))
    model = {"type": "pinhole", "fx": 20, "fy": 20, "cx": SHAPE[1] / 2, "cy": SHAPE[0] / 2}
    text = {"format": "reflcolor-scan", "version": 1, "range": "range.png", "reflectance": "ir.png", "model": model}
    path.write_text(json.dumps(text | {"range_scale": 0.01}))


@pytest.mark.parametrize(
    ("name", "write"),
    [("a.ptx", ptx), ("a.e57", e57), ("a.pcd", pcd), ("a.ply", ply), ("a.npz", npz), ("a.scan.json", pair)],
)
@pytest.mark.parametrize("step", [1, 2])
def test_the_header_tells_how_many_pixels_are_read(tmp_path, name, write, step):
    write(path := tmp_path / name)
    (pixels,) = scan_pixels(path, options=ReadOptions(step=step))
    (scan,) = read_scans(path, options=ReadOptions(step=step))
    assert pixels == pytest.approx(scan.valid.size, rel=0 if step == 1 else 0.3)


def test_of_several_scans_in_a_ptx_all_pixels_are_counted(tmp_path):
    path = tmp_path / "a.ptx"
    path.write_text(3 * ptx_text(POINTS, INTENSITY))
    assert sum(scan_pixels(path)) == pytest.approx(3 * INTENSITY.size, rel=0.2)


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.ptx", b"no scan\n", "a.ptx: line 1: expected the number of columns"),
        ("a.ptx", b"5\n7\n0 0 0\n", "it is cut short"),
        ("a.e57", b"ASTM-E57" + bytes(9), "a.e57: cut short"),
        ("a.pcd", b"VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 5\nHEIGHT 9\nDATA binary\n", "cut short"),
        ("a.npy", b"\x93NUMPY\1\0", "a.npy: it is damaged"),
        ("a.pts", b"1 2 3 4\n", "has no grid"),
        ("a.las", b"LASF", "its header does not fit the file"),
        ("a.ply", b"ply\nformat ascii 1.0\nend_header\n", "holds no vertices"),
        ("a.scan.json", b"{}", "a.scan.json: "),
        ("a.xml", b"<xml/>", "not a scan file by its name"),
    ],
)
def test_what_cannot_be_read_is_told_by_its_header_in_the_readers_words(tmp_path, name, data, said):
    (path := tmp_path / name).write_bytes(data)
    with pytest.raises(ScanError) as by_header:
        scan_pixels(path)
    assert said in str(by_header.value)
    with pytest.raises(ScanError) as by_reader:
        read_scans(path)
    assert str(by_header.value) == str(by_reader.value)


def test_an_e57_without_rows_and_columns_is_refused_unless_a_grid_by_angle_is_asked_for(tmp_path):
    write_e57(path := tmp_path / "a.e57", {"fields": XYZ})
    with pytest.raises(ScanError, match="is unstructured"):
        scan_pixels(path)
    assert scan_pixels(path, options=ReadOptions(grid="angle")) == [INTENSITY.size]


def test_an_image_of_another_size_is_told(tmp_path):
    pair(path := tmp_path / "a.scan.json")
    write_png(tmp_path / "ir.png", np.ones((3, 4), np.uint16))
    with pytest.raises(ScanError, match=r"ir\.png has 3 rows x 4 columns"):
        scan_pixels(path)
