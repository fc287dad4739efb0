"""Formats beside PTX, E57 and image pairs: organized PCD, PLY with a grid, NumPy arrays, texts of points."""

import errno
import struct

import numpy as np
import pytest
from colored_scans import surface_of, tilted_pose
from hall import HALL, NAMES
from sample_scans import intensity_of, ptx_text, room_points

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.readers import FORMATS, ReadOptions, read_scans
from reflcolor_addon.files.readers.formats import REFUSED
from reflcolor_addon.files.readers.numpy_file import NumpyFile
from reflcolor_addon.files.writers.ply import write_ply
from reflcolor_addon.scan.scan import Scan

COLOR = np.random.default_rng(1).integers(0, 256, HALL.shape, np.uint8)
HOLES = np.random.default_rng(2).random(NAMES.shape) < 0.1
ANGLE = ReadOptions(grid="angle")


def packed_rgb(color):
    red, green, blue = (color[..., channel].astype(np.uint32) for channel in range(3))
    return (red << 16 | green << 8 | blue).view(np.float32)


def pcd(kind, points=HALL, holes=HOLES, height=None, viewpoint="0 0 0 1 0 0 0"):
    """A PCD of x, y, z, intensity and packed colors; no return is NaN."""
    table = np.empty(points.shape[:2], [("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("intensity", "<f4"), ("rgb", "<f4")])
    for axis, name in enumerate("xyz"):
        table[name] = np.where(holes, np.nan, points[..., axis])
    table["intensity"], table["rgb"] = NAMES, packed_rgb(COLOR)
    height = points.shape[0] if height is None else height
    header = (
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity rgb\nSIZE 8 8 8 4 4\n"
        f"TYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH {table.size // height}\nHEIGHT {height}\nVIEWPOINT {viewpoint}\n"
        f"POINTS {table.size}\nDATA {kind}\n"
    ).encode()
    if kind == "ascii":
        rows = (" ".join(repr(float(number)) for number in record) for record in table.ravel())
        return header + ("\n".join(rows) + "\n").encode()
    if kind == "binary":
        return header + table.tobytes()
    columns = b"".join(np.ascontiguousarray(table[name]).tobytes() for name in table.dtype.names)
    packed = lzf(columns)
    return header + struct.pack("<II", len(packed), len(columns)) + packed


def lzf(data):
    """LZF with runs of bytes as they are, and a repetition wherever eight bytes are those before."""
    out, at, start = bytearray(), 0, 0

    def flush(end):
        for first in range(start, end, 32):
            piece = data[first : min(first + 32, end)]
            out.append(len(piece) - 1)
            out.extend(piece)

    while at < len(data):
        if at >= 8 and data[at : at + 8] == data[at - 8 : at] and at + 8 <= len(data):
            flush(at)
            out.extend((6 << 5, 7))
            at += 8
            start = at
        else:
            at += 1
    flush(len(data))
    return bytes(out)


def read(tmp_path, name, data, options=None):
    (tmp_path / name).write_bytes(data)
    return read_scans(tmp_path / name, options=options or ReadOptions())


@pytest.mark.parametrize("kind", ["ascii", "binary", "binary_compressed"])
def test_an_organized_pcd_comes_back_as_stored(tmp_path, kind):
    (scan,) = read(tmp_path, "hall.pcd", pcd(kind))
    np.testing.assert_array_equal(scan.valid, ~HOLES)
    np.testing.assert_array_equal(scan.points[scan.valid], HALL[~HOLES])
    np.testing.assert_array_equal(scan.reflectance[scan.valid], NAMES[~HOLES].astype(np.float32))
    np.testing.assert_array_equal(scan.color[scan.valid], COLOR[~HOLES])
    assert scan.warnings == ()


def test_the_viewpoint_of_a_pcd_is_the_pose(tmp_path):
    half = np.sqrt(0.5)
    (scan,) = read(tmp_path, "hall.pcd", pcd("binary", viewpoint=f"1 2 3 {half} 0 0 {half}"))
    np.testing.assert_allclose(scan.pose @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-6)


@pytest.mark.parametrize("kind", ["ascii", "binary", "binary_compressed"])
def test_a_pcd_that_is_cut_short_is_told(tmp_path, kind):
    data = pcd(kind)
    for size in (60, 300, len(data) // 2, len(data) - (100 if kind == "ascii" else 9)):
        with pytest.raises(ScanError) as caught:
            read(tmp_path, "hall.pcd", data[:size])
        assert str(caught.value).startswith("hall.pcd: ") and "\n" not in str(caught.value)


def test_a_size_in_other_digits_is_no_size(tmp_path):
    data = pcd("ascii").replace(b"HEIGHT ", b"HEIGHT \xb9")
    with pytest.raises(ScanError, match=r"HEIGHT is .*expected a whole number"):
        read(tmp_path, "hall.pcd", data)


def test_a_pcd_of_one_row_is_gridded_by_angle_when_that_is_asked_for(tmp_path):
    with pytest.raises(ScanError, match=r"has no grid: .*--grid angle"):
        read(tmp_path, "hall.pcd", pcd("binary", height=1))
    (scan,) = read(tmp_path, "hall.pcd", pcd("binary", height=1), ANGLE)
    assert scan.shape == (40, 90)
    np.testing.assert_array_equal(scan.points[scan.valid], HALL[~HOLES])


def test_pcl_files_are_read(data_dir):
    (office,) = read_scans(data_dir / "pcl_organized" / "office1.pcd")
    assert office.shape == (480, 640) and office.color is not None and 2 < office.range.max() < 7
    top, bottom = (office.points[rows][office.valid[rows]][:, 2].mean() for rows in (slice(0, 50), slice(-50, None)))
    assert top > bottom
    (bunny,) = read_scans(data_dir / "pcl_organized" / "stanford_bun000_rangegrid.ply")
    assert bunny.shape == (400, 512) and bunny.valid.sum() == 40256


def test_a_ply_that_was_written_here_comes_back(tmp_path):
    scan = Scan(name="hall", points=HALL, reflectance=NAMES, valid=~HOLES, pose=tilted_pose((1e5, -3.5, 12.0)))
    other = Scan(
        name="room", points=room_points(), reflectance=intensity_of(room_points()), valid=np.ones((9, 14), bool)
    )
    colors = [COLOR, np.full((9, 14, 3), 200, np.uint8)]
    write_ply([surface_of(scan, COLOR), surface_of(other, colors[1])], tmp_path / "site.ply")
    back = read_scans(tmp_path / "site.ply")
    assert [scan.name for scan in back] == ["hall", "room"]
    np.testing.assert_array_equal(back[0].valid, scan.valid)
    np.testing.assert_allclose(back[0].points, scan.points, atol=1e-9)
    np.testing.assert_array_equal(back[0].pose, scan.pose)
    np.testing.assert_array_equal(back[0].color[scan.valid], COLOR[scan.valid])
    np.testing.assert_array_equal(back[1].reflectance, other.reflectance)


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_ply_of_a_stated_size_is_a_grid(tmp_path, order):
    table = np.empty(NAMES.size, [(name, f"{order}f8") for name in ("x", "y", "z", "intensity")])
    for axis, name in enumerate("xyz"):
        table[name] = HALL[..., axis].ravel()
    table["intensity"] = NAMES.ravel()
    kind = {"<": "little", ">": "big"}[order]
    header = f"ply\nformat binary_{kind}_endian 1.0\nobj_info num_cols 90\nobj_info num_rows 40\n"
    header += f"element vertex {table.size}\n"
    header += "".join(f"property double {name}\n" for name in table.dtype.names) + "end_header\n"
    (scan,) = read(tmp_path, "hall.ply", header.encode() + table.tobytes())
    np.testing.assert_array_equal(scan.points, HALL)
    np.testing.assert_array_equal(scan.reflectance, NAMES)


def save(tmp_path, **arrays):
    np.savez_compressed(tmp_path / "hall.npz", **arrays)
    return read_scans(tmp_path / "hall.npz")


def test_arrays_of_points_are_a_grid(tmp_path):
    x, y, z = np.moveaxis(HALL, -1, 0)
    for arrays in ({"x": x, "y": y, "z": z}, {"xyz": HALL}, {"points": np.dstack([HALL, NAMES])}):
        (scan,) = save(tmp_path, **arrays, reflectance=NAMES, color=COLOR)
        np.testing.assert_array_equal(scan.points, HALL)
        np.testing.assert_array_equal(scan.reflectance, NAMES)
        np.testing.assert_array_equal(scan.color, COLOR)
    np.save(tmp_path / "hall.npy", np.dstack([HALL, NAMES]))
    np.testing.assert_array_equal(read_scans(tmp_path / "hall.npy")[0].reflectance, NAMES)


def test_arrays_behind_a_password_are_said_to_be(tmp_path):
    save(tmp_path, xyz=HALL, reflectance=NAMES)
    data = bytearray((tmp_path / "hall.npz").read_bytes())
    # The flag of each member, at its own header and in the directory at the end.
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = data.find(mark)
        while at >= 0:
            data[at + offset] |= 1
            at = data.find(mark, at + 1)
    (tmp_path / "hall.npz").write_bytes(data)
    with pytest.raises(ScanError, match=r"hall.npz: is encrypted; save it without a password"):
        read_scans(tmp_path / "hall.npz")


def test_a_disk_that_fails_is_no_damaged_file(tmp_path, monkeypatch):
    np.save(tmp_path / "hall.npy", np.dstack([HALL, NAMES]))

    def failing(*_, **__):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(NumpyFile, "_fill", failing)
    with pytest.raises(ScanError, match=r"hall.npy: cannot be read \(Input/output error\)"):
        read_scans(tmp_path / "hall.npy")


@pytest.mark.parametrize("by_pixel", [False, True])
def test_a_range_with_uneven_angles_is_a_grid(tmp_path, by_pixel):
    elevation = np.array([20.0, 15.0, 12.0, 11.0, 10.5, 10.2, 10.0, 4.0, -3.0, -16.0])
    azimuth = np.linspace(-170, 170, 60)
    if by_pixel:
        elevation, azimuth = np.meshgrid(elevation, azimuth, indexing="ij")
        # Beams that are set off from each other, as those of spinning lidars.
        azimuth = azimuth + np.arange(10)[:, None] * 0.3
    millimeters = np.random.default_rng(3).integers(2000, 2100, (10, 60))
    (scan,) = save(tmp_path, range=millimeters, azimuth_deg=azimuth, elevation_deg=elevation, signal=NAMES[:10, :60])
    found = np.degrees(np.arctan2(scan.points[..., 2], np.hypot(scan.points[..., 0], scan.points[..., 1])))
    np.testing.assert_allclose(
        found, np.broadcast_to(elevation if by_pixel else elevation[:, None], (10, 60)), atol=1e-9
    )
    right = np.degrees(np.arctan2(scan.points[..., 0], scan.points[..., 1]))
    np.testing.assert_allclose(right, np.broadcast_to(azimuth, (10, 60)), atol=1e-9)
    np.testing.assert_allclose(scan.range, millimeters / 1000)


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"range": np.ones((4, 5))}, "expected x, y and z, or range with azimuth and elevation"),
        ({"range": np.ones((4, 5)), "azimuth": np.ones(7), "elevation": np.ones(4)}, "do not fit the range's size"),
        ({"x": np.ones((4, 5)), "y": np.ones((4, 5)), "z": np.ones((4, 6))}, "differ in size"),
        ({"xyz": np.ones((4, 5, 2))}, "holds an array of 4 x 5 x 2"),
        ({"xyz": np.array([object()])}, "claims more data than"),
    ],
)
def test_arrays_that_are_no_scan_are_told(tmp_path, arrays, said):
    with pytest.raises(ScanError, match=said):
        save(tmp_path, **arrays)


@pytest.mark.parametrize("name", ["hall.pts", "hall.xyz", "hall.csv"])
def test_texts_of_points_are_gridded_by_angle(tmp_path, name):
    rows = [" ".join(f"{number:.9f}" for number in (*point, value)) for point, value in
            zip(HALL.reshape(-1, 3), NAMES.ravel(), strict=True)]  # fmt: skip
    head = {"hall.pts": f"{NAMES.size}\n", "hall.xyz": "# made by a program\n", "hall.csv": "x,y,z,i\n"}[name]
    text = head + "\n".join(rows)
    if name == "hall.csv":
        text = head + "\n".join(rows).replace(" ", ",")
    with pytest.raises(ScanError, match=r"has no grid: .*--grid angle"):
        read(tmp_path, name, text.encode())
    (scan,) = read(tmp_path, name, text.encode(), ANGLE)
    assert scan.shape == (40, 90)
    np.testing.assert_allclose(scan.points, HALL, atol=1e-8)
    np.testing.assert_allclose(scan.reflectance, NAMES, atol=1e-6)


def test_points_in_scanning_order_are_gridded_from_where_the_scanner_stood(tmp_path):
    place = np.array([412.0, -77.5, 9.25])
    points = (HALL[::-1].swapaxes(0, 1).reshape(-1, 3)) + place
    text = "\n".join(" ".join(f"{number:.9f}" for number in (*point, 0.5)) for point in points)
    (scan,) = read(tmp_path, "hall.xyz", text.encode(), ANGLE)
    assert scan.shape[0] in range(38, 43) and scan.shape[1] in range(85, 95) and scan.valid.mean() > 0.9
    np.testing.assert_allclose(scan.pose[:3, 3], place, atol=0.1)
    named = ReadOptions(grid="angle", position=tuple(place))
    (scan,) = read(tmp_path, "hall.xyz", text.encode(), named)
    np.testing.assert_allclose(scan.points, HALL, atol=1e-8)


@pytest.mark.parametrize("suffix", REFUSED)
def test_a_closed_format_names_the_way_out(tmp_path, suffix):
    with pytest.raises(ScanError, match=f"hall\\{suffix}: this format is not supported. .*(export|save)"):
        read(tmp_path, f"hall{suffix}", b"something")


def test_a_file_under_another_formats_name_is_told(tmp_path):
    for data, name in ((pcd("binary"), "hall.ptx"), (pcd("binary"), "hall.e57"), (b"ply\nformat", "hall.pcd")):
        with pytest.raises(ScanError, match="its contents look like"):
            read(tmp_path, name, data)
    # Plain numbers of any kind begin as a PTX does.
    with pytest.raises(ScanError, match="has no grid"):
        read(tmp_path, "hall.pts", ptx_text(HALL, NAMES).split("\n", 10)[-1].encode())


def test_a_ptx_under_the_name_of_a_text_of_points_is_told(tmp_path):
    with pytest.raises(ScanError, match=r"hall.pts: its contents look like .ptx: rename it"):
        read(tmp_path, "hall.pts", ptx_text(HALL, NAMES).encode())


def test_every_format_has_a_name_suffixes_and_a_line_about_it():
    suffixes = [suffix for kind in FORMATS for suffix in kind.suffixes]
    assert len(suffixes) == len(set(suffixes)) and not set(suffixes) & set(REFUSED)
    assert all(kind.name and kind.about and callable(kind.read) for kind in FORMATS)


@pytest.mark.parametrize("kind", ["ascii", "binary_compressed"])
def test_reading_a_pcd_can_be_cancelled(tmp_path, kind, monkeypatch):
    monkeypatch.setattr("reflcolor_addon.files.readers.pcd._ASKED_EVERY", 1000)
    (tmp_path / "hall.pcd").write_bytes(pcd(kind))
    with pytest.raises(Cancelled):
        read_scans(tmp_path / "hall.pcd", cancelled=lambda: True)


def test_points_almost_in_one_line_are_refused_by_the_size_of_their_grid(tmp_path):
    turn = np.radians(np.linspace(-40, 40, 300))
    points = np.stack([9 * np.cos(turn), 9 * np.sin(turn), np.zeros(300)], axis=-1)
    points[7, 2] = 1e-12
    text = "\n".join(" ".join(repr(float(number)) for number in (*point, 0.5)) for point in points)
    with pytest.raises(ScanError, match=r"hall.xyz: scan 'hall': a grid by angle would have more than 65,536 rows"):
        read(tmp_path, "hall.xyz", text.encode(), ReadOptions(grid="angle", position=(0, 0, 0)))
