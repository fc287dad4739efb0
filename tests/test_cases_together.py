"""What exporters write in the field, two faults in one file."""

import numpy as np
import pytest
from hall import COLOR, HALL, NAMES, e57, fields, ptx
from sample_scans import intensity_of, ptx_text

from reflcolor_addon import ReadOptions, ScanSurface, read_scans

TO_SITE = np.array([350.0, 120, 31])
UPSIDE_DOWN = np.diag([1.0, -1, -1])
HALF_TURN = {"w": 0.0, "x": 1.0, "y": 0.0, "z": 0.0}


def require_hall(scan, atol=1e-9):
    np.testing.assert_allclose(scan.reflectance, NAMES)
    np.testing.assert_allclose(scan.points, HALL, atol=atol)


@pytest.mark.parametrize("swapped_header", [False, True])
def test_millimeters_row_by_row(tmp_path, swapped_header):
    lines = ptx_text(HALL * 1000, NAMES).splitlines(keepends=True)
    header, body = lines[:10], np.array(lines[10:]).reshape(90, 40).T
    header[:2] = header[1::-1] if swapped_header else header[:2]
    (scan,) = ptx(tmp_path, "".join(header) + "".join(body.ravel()))
    require_hall(scan)
    assert any("millimeters" in warning for warning in scan.warnings)


def test_millimeters_with_rows_and_columns_exchanged(tmp_path):
    row, col = np.mgrid[:40, :90]
    (scan,) = e57(tmp_path, fields(HALL * 1000, rows=col, cols=row))
    require_hall(scan)


def test_thinned_at_random_in_millimeters(tmp_path):
    (scan,) = e57(tmp_path, fields(HALL * 1000, keep=np.random.default_rng(3).random((40, 90)) < 0.3))
    assert scan.shape == (20, 45) and 1 < np.median(scan.range[scan.valid]) < 6
    assert {"was thinned", "millimeter"} <= {
        word for word in ("was thinned", "millimeter") if word in str(scan.warnings)
    }


@pytest.mark.parametrize("suffix", [".ptx", ".e57"])
def test_upside_down_by_its_pose_with_points_in_the_world_already(tmp_path, suffix):
    if suffix == ".ptx":
        matrix = np.eye(4)
        matrix[:3, :3], matrix[3, :3] = UPSIDE_DOWN, TO_SITE
        text = ptx_text(HALL + TO_SITE, NAMES, matrix=matrix, position=TO_SITE, axes=UPSIDE_DOWN)
        (scan,) = ptx(tmp_path, text)
    else:
        pose = {"rotation": HALF_TURN, "translation": dict(zip("xyz", map(float, TO_SITE), strict=True))}
        (scan,) = e57(tmp_path, fields(HALL + TO_SITE) | {"pose": pose})
    require_hall(scan)
    np.testing.assert_allclose(scan.points @ scan.pose[:3, :3].T + scan.pose[:3, 3], HALL + TO_SITE, atol=1e-9)
    assert "world coordinates already" in scan.warnings[0] and "upside down" in scan.warnings[1]


def test_counted_by_threes_from_below_in_site_coordinates(tmp_path):
    row, col = np.mgrid[:40, :90]
    (scan,) = e57(tmp_path, fields(HALL + TO_SITE, rows=3 * (39 - row) + 1, cols=3 * col + 5))
    require_hall(scan)
    assert "gaps were closed" in scan.warnings[0] and "not measured from the scanner" in scan.warnings[1]


def test_words_for_no_number_and_a_second_scan_cut_short_within_a_line(tmp_path):
    first = ptx_text(HALL, NAMES).splitlines(keepends=True)
    first[10::23] = ["-nan(ind) 1.#QNAN -1.#IND 0.5\r\n"] * len(first[10::23])
    (scan,) = ptx(tmp_path, "".join(first) + ptx_text(HALL * 1.1, NAMES)[:90_000] + "-nan(i")
    assert np.count_nonzero(~scan.valid) == len(first[10::23])
    np.testing.assert_array_equal(scan.points[scan.valid], HALL[scan.valid])
    assert "its scan 2 was left out" in str(scan.warnings)


def test_the_same_intensity_everywhere_with_colors_from_0_to_1(tmp_path):
    (scan,) = ptx(tmp_path, ptx_text(HALL, np.full(NAMES.shape, 1000.0), np.round(COLOR / 255, 6)))
    np.testing.assert_array_equal(scan.color, COLOR)
    np.testing.assert_allclose(scan.reflectance, COLOR @ [0.299, 0.587, 0.114], rtol=1e-5)


@pytest.mark.parametrize("in_degrees", [True, False])
@pytest.mark.parametrize("leftward", [False, True])
def test_columns_that_a_spinning_lidar_dropped_are_left_empty(tmp_path, in_degrees, leftward):
    azimuth, elevation = np.arange(-180.0, 180, 4), np.linspace(10, -20, 16) ** 3 / 400
    gone = np.random.default_rng(0).random(90) < 0.1
    gone[40:50], gone[[0, -1]] = True, False
    azimuth = (-azimuth if leftward else azimuth)[~gone]
    distance = np.full((16, len(azimuth)), 5000, np.uint32)
    angles = {"azimuth_deg": azimuth} if in_degrees else {"azimuth": np.radians(azimuth)}
    signal = intensity_of(distance[..., None] * np.ones(3))
    np.savez(tmp_path / "spin.npz", range=distance, elevation_deg=elevation, signal=signal, **angles)
    (scan,) = read_scans(tmp_path / "spin.npz")
    assert scan.shape == (16, 90) and scan.full_turn
    np.testing.assert_array_equal(scan.valid.all(axis=0), ~gone[::-1] if leftward else ~gone)
    np.testing.assert_array_equal(scan.valid.any(axis=0), scan.valid.all(axis=0))
    assert str(np.count_nonzero(gone)) in scan.warnings[0] and "left empty" in scan.warnings[0]
    (thin,) = read_scans(tmp_path / "spin.npz", options=ReadOptions(step=3))
    np.testing.assert_array_equal(thin.points, scan.points[::3, (2 if leftward else 0) :: 3])
    longest = np.linalg.norm(np.diff(scan.points[:, scan.valid[0]], axis=1), axis=-1).max()
    faces = np.concatenate(list(ScanSurface(scan, np.zeros((*scan.shape, 3), np.uint8), {}).face_blocks()))
    corners = scan.points[scan.valid][faces]
    assert np.linalg.norm(np.diff(corners, axis=1), axis=-1).max() < longest / 3
