"""LAS and LAZ, as laspy writes them."""

import struct

import numpy as np
import pytest
from hall import HALL, NAMES

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.readers import ReadOptions, las, read_scans

laspy = las.imported_laspy()
ANGLE = ReadOptions(grid="angle")
COLOR = np.random.default_rng(1).integers(0, 256, HALL.shape, np.uint8)
KINDS = pytest.mark.parametrize("suffix", [".las", ".laz"])
STRENGTH = np.rint(NAMES * 1000).astype(np.uint16)
ROWS, COLS = np.indices(NAMES.shape)
_COUNT, _VLRS, _POINTS_AT = 107, 100, 96


def written(path, *, version="1.4", point_format=7, points=HALL, color=COLOR, extra=None):
    """Write points to a micrometer, an intensity of 16 bits, colors of 16 bits, and fields beyond the standard's."""
    header = laspy.LasHeader(version=version, point_format=point_format)
    header.scales, header.offsets = np.full(3, 1e-6), np.floor(points.reshape(-1, 3).min(axis=0))
    for name, values in (extra or {}).items():
        header.add_extra_dim(laspy.ExtraBytesParams(name=name, type=values.dtype))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points.reshape(-1, 3).T
    cloud.intensity = STRENGTH.ravel()
    if color is not None:
        cloud.red, cloud.green, cloud.blue = color.reshape(-1, 3).astype(np.uint16).T * 257
    for name, values in (extra or {}).items():
        cloud[name] = values.ravel()
    cloud.write(path)
    return path


@KINDS
@pytest.mark.parametrize(("version", "point_format"), [("1.2", 2), ("1.2", 3), ("1.4", 7)])
def test_points_are_gridded_by_angle(tmp_path, suffix, version, point_format):
    path = written(tmp_path / f"hall{suffix}", version=version, point_format=point_format)
    (scan,) = read_scans(path, options=ANGLE)
    assert scan.name == "hall" and scan.shape == NAMES.shape and scan.valid.all()
    np.testing.assert_allclose(scan.points, HALL, atol=1e-6)
    np.testing.assert_array_equal(scan.reflectance, STRENGTH.astype(np.float32))
    np.testing.assert_array_equal(scan.color, COLOR)


def test_points_in_the_world_are_seen_from_where_the_scanner_stood(tmp_path):
    place = np.array([468_213.5, 5_524_071.25, 112.0])
    path = written(tmp_path / "site.laz", points=HALL + place)
    (scan,) = read_scans(path, options=ReadOptions(grid="angle", position=tuple(place)))
    np.testing.assert_allclose(scan.points, HALL, atol=2e-6)
    np.testing.assert_array_equal(scan.pose[:3, 3], place)


@KINDS
def test_rows_and_columns_among_the_fields_make_the_grid(tmp_path, suffix):
    holes = np.random.default_rng(2).random(NAMES.shape) < 0.1
    points = np.where(holes[..., None], 0, HALL)
    extra = {"Grid Row": ROWS.astype(np.uint16), "Grid Col": COLS.astype(np.uint16)}
    (scan,) = read_scans(written(tmp_path / f"hall{suffix}", points=points, extra=extra))
    assert scan.shape == NAMES.shape
    np.testing.assert_array_equal(scan.valid, ~holes)
    np.testing.assert_allclose(scan.points[~holes], HALL[~holes], atol=1e-6)


@KINDS
def test_without_a_grid_the_way_out_is_told(tmp_path, suffix):
    with pytest.raises(ScanError, match=r"has no grid: .*--grid angle"):
        read_scans(written(tmp_path / f"hall{suffix}"))


def test_black_is_no_color(tmp_path):
    (scan,) = read_scans(written(tmp_path / "hall.las", color=None), options=ANGLE)
    assert scan.color is None


@KINDS
def test_reading_is_told_and_can_be_cancelled(tmp_path, suffix):
    path, told = written(tmp_path / f"hall{suffix}"), []
    read_scans(path, options=ANGLE, progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told) and told[-1] == 1.0
    with pytest.raises(Cancelled):
        read_scans(path, options=ANGLE, cancelled=lambda: True)


@KINDS
def test_a_file_that_is_cut_short_is_told(tmp_path, suffix):
    whole = written(tmp_path / f"hall{suffix}").read_bytes()
    path = tmp_path / f"cut{suffix}"
    for size in (10, 200, 300, len(whole) // 2):
        path.write_bytes(whole[:size])
        with pytest.raises(ScanError, match=rf"cut{suffix}: .*(damaged|cut short)"):
            read_scans(path, options=ANGLE)


@KINDS
@pytest.mark.parametrize(
    ("at", "format_", "value", "said"),
    [
        (_VLRS, "<I", 0xFFFFFFF0, "does not fit the file"),
        (_POINTS_AT, "<I", 0x7FFFFFFF, "does not fit the file"),
        (104, "<B", 77, "damaged"),
        (94, "<H", 100, "damaged"),
    ],
)
def test_a_header_that_does_not_fit_is_told(tmp_path, suffix, at, format_, value, said):
    data = bytearray(written(tmp_path / f"hall{suffix}").read_bytes())
    struct.pack_into(format_, data, at, value)
    path = tmp_path / f"odd{suffix}"
    path.write_bytes(data)
    with pytest.raises(ScanError, match=rf"odd{suffix}: .*{said}"):
        read_scans(path, options=ANGLE)


def test_a_count_beyond_the_file_is_told_before_anything_is_allocated(tmp_path):
    data = bytearray(written(tmp_path / "hall.las", version="1.2", point_format=2).read_bytes())
    for count, said in ((400_000_000, "memory|cut short"), (2**32 - 1, "its header says 4,294,967,295 points")):
        struct.pack_into("<I", data, _COUNT, count)
        (tmp_path / "odd.las").write_bytes(data)
        with pytest.raises(ScanError, match=said):
            read_scans(tmp_path / "odd.las", options=ANGLE)


def test_chunks_that_no_file_has_room_for_are_refused(tmp_path):
    data = bytearray(written(tmp_path / "hall.laz").read_bytes())
    with laspy.open(tmp_path / "hall.laz") as reader:
        start = reader.header.offset_to_point_data
    (table,) = struct.unpack_from("<q", data, start)
    struct.pack_into("<I", data, table + 4, 2**32 - 1)
    (tmp_path / "odd.laz").write_bytes(data)
    with pytest.raises(ScanError, match=r"^odd\.laz: [^\n]*(damaged|memory)[^\n]*$"):
        read_scans(tmp_path / "odd.laz", options=ANGLE)


def test_compressed_points_that_make_no_sense_are_told(tmp_path):
    whole = written(tmp_path / "hall.laz").read_bytes()
    with laspy.open(tmp_path / "hall.laz") as reader:
        start = reader.header.offset_to_point_data
    data = whole[: start + 8] + bytes(255 - byte for byte in whole[start + 8 :])
    (tmp_path / "odd.laz").write_bytes(data)
    with pytest.raises(ScanError, match=r"^odd\.laz: [^\n]*(damaged|too few)[^\n]*$"):
        read_scans(tmp_path / "odd.laz", options=ANGLE)


def test_a_package_that_is_missing_is_named(tmp_path, monkeypatch):
    path = written(tmp_path / "hall.laz")
    monkeypatch.setattr(las, "native_library", lambda *_: None)
    with pytest.raises(ScanError, match=r"hall.laz: LAZ needs lazrs, which is missing; export its points as LAS"):
        read_scans(path, options=ANGLE)
