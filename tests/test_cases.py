"""What exporters write in the field: each kind on a file of the shared cases, and on one that is built differently.

In most of the shared files the intensity names the pixel: (row x columns + column + 1) / (pixels + 1), row 0 on top.
"""

import numpy as np
import pytest
from hall import COLOR, HALL, NAMES, e57, fields, ptx
from sample_scans import intensity_of, ptx_text

from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.readers import ReadOptions, read_scans


@pytest.fixture
def case(data_dir):
    """A function that reads a file of the shared cases."""

    def read(name, **options):
        return read_scans(data_dir / "cases" / name, options=ReadOptions(**options))

    return read


def names_its_pixels(scan):
    """Whether every return has the intensity that its pixel was given."""
    named = (np.arange(scan.valid.size) + 1) / (scan.valid.size + 1)
    return np.abs(scan.reflectance - named.reshape(scan.shape))[scan.valid].max() < 1e-4


# Reflectance that is none


def test_a_constant_intensity_is_told(case, tmp_path):
    for scan in (*case("ptx_constant_intensity.ptx"), *ptx(tmp_path, ptx_text(HALL, np.full(NAMES.shape, 1000.0)))):
        assert "everywhere, as where a program knew none: it can be viewed, but not colorized" in scan.warnings[0]


def test_the_luminance_of_colors_stands_in_for_a_constant_intensity(tmp_path):
    (scan,) = ptx(tmp_path, ptx_text(HALL, np.ones(NAMES.shape), COLOR))
    assert "luminance of its colors" in scan.warnings[0]
    np.testing.assert_allclose(scan.reflectance, COLOR @ [0.299, 0.587, 0.114], atol=1e-3)


def test_an_intensity_that_is_nowhere_valid_leaves_the_points(case, tmp_path):
    made = e57(tmp_path, fields(isIntensityInvalid=np.ones(NAMES.shape, int)))
    for scan in (*case("e57_all_intensity_invalid.e57"), *made):
        assert scan.valid.all() and not scan.reflectance.any()
        assert any("not colorized" in warning for warning in scan.warnings)


def test_a_field_of_its_maker_is_the_reflectance(case):
    (scan,) = case("e57_riegl_reflectance_only.e57")
    assert "rlms:reflectance is taken" in scan.warnings[0]
    assert scan.shape == (30, 60) and np.ptp(scan.reflectance) > 30


# Grids that are none, or not whole


def test_numbers_that_skip_are_closed_up(case, tmp_path):
    (given,) = case("e57_every_third_row_and_column.e57")
    row, col = np.mgrid[:40, :90]
    (made,) = e57(tmp_path, fields(rows=row * 2 + 1, cols=col * 5 - 7))
    for scan, shape, strides in ((given, (30, 60), (3, 3)), (made, (40, 90), (2, 5))):
        assert scan.shape == shape and scan.valid.all()
        assert f"row numbers go up by {strides[0]} and its column numbers by {strides[1]}" in scan.warnings[0]
    # The case kept pixels 0, 3, 6 ... of 90 x 180.
    np.testing.assert_array_equal(made.points, HALL)


def test_a_grid_thinned_at_random_becomes_coarser_and_is_told(tmp_path):
    keep = np.random.default_rng(0).random(NAMES.shape) < 0.3
    bounds = {"rowMinimum": 0, "rowMaximum": 39, "columnMinimum": 0, "columnMaximum": 89}
    (scan,) = e57(tmp_path, fields(keep=keep) | {"indexBounds": bounds})
    assert scan.shape in ((20, 45), (14, 30)) and scan.valid.mean() > 0.7
    assert "was thinned out: 30% of its pixels hold a point" in scan.warnings[0]
    # Every point is one of the file's.
    assert {*map(tuple, scan.points[scan.valid])} <= {*map(tuple, HALL[keep])}


@pytest.mark.parametrize("one_row", [False, True])
def test_points_in_no_order_have_no_grid_and_the_way_out_is_named(case, tmp_path, one_row):
    order = np.random.default_rng(1).permutation(NAMES.size)
    mixed = {name: values[order] for name, values in fields()["fields"].items()}
    for name in ("rowIndex", "columnIndex"):
        mixed[name] = np.sort(mixed[name])
    mixed["rowIndex"], mixed["columnIndex"] = (np.ravel(index) for index in np.mgrid[:40, :90])
    if one_row:
        mixed["rowIndex"], mixed["columnIndex"] = np.zeros(NAMES.size, int), np.arange(NAMES.size)
    for read in (lambda: case("e57_unordered_in_a_rectangle.e57"), lambda: e57(tmp_path, {"fields": mixed})):
        with pytest.raises(ScanError, match=r"has no grid: .*--grid angle"):
            read()


def test_a_whole_scan_in_one_row_has_no_grid(tmp_path):
    flat = fields(HALL.reshape(1, -1, 3), **{"intensity": NAMES})
    with pytest.raises(ScanError, match="has no grid"):
        e57(tmp_path, flat)


def test_points_in_no_order_are_gridded_by_angle_when_that_is_asked_for(case, tmp_path):
    (given,) = case("e57_unordered_in_a_rectangle.e57", grid="angle")
    order = np.random.default_rng(1).permutation(NAMES.size)
    (made,) = e57(tmp_path, {"fields": {n: v[order] for n, v in fields()["fields"].items()}}, grid="angle")
    assert given.shape == (30, 60) and given.valid.all() and names_its_pixels(given)
    assert made.shape == (40, 90)
    np.testing.assert_allclose(made.points, HALL, atol=1e-9)


# Layouts


def test_a_depth_camera_by_rows_in_millimeters_comes_in_upright_in_meters(case, tmp_path):
    (given,) = case("ptx_photoneo_like_rows_first_rowmajor_mm.ptx")
    right, down = np.meshgrid((np.arange(40) - 20) / 60, (np.arange(30) - 15) / 60)
    depth = 900 + 200 * right + 50 * np.sin(9 * down)
    points = np.stack([right * depth, down * depth, depth], axis=-1)
    # The header names columns and rows rightly, the body follows row by row.
    stored = points.reshape(40, 30, 3).swapaxes(0, 1)[::-1]
    (made,) = ptx(tmp_path, ptx_text(stored, intensity_of(points).reshape(40, 30).T[::-1]))
    for scan in (given, made):
        assert scan.shape == (30, 40)
        assert 0.7 < np.median(scan.range[scan.valid]) < 1.5
        assert any("millimeters" in warning for warning in scan.warnings)
        top, bottom = (scan.points[rows][scan.valid[rows]][:, 2].mean() for rows in (slice(0, 5), slice(-5, None)))
        left, right = (scan.points[:, c][scan.valid[:, c]][:, 0].mean() for c in (slice(0, 5), slice(-5, None)))
        assert top > bottom and left < right
    np.testing.assert_array_equal(made.reflectance, intensity_of(points))


@pytest.mark.parametrize("swapped_header", [False, True])
@pytest.mark.parametrize("by_rows", [False, True])
def test_every_order_of_a_ptx_comes_in_the_same(tmp_path, swapped_header, by_rows):
    lines = ptx_text(HALL, NAMES).splitlines(keepends=True)
    header, body = lines[:10], np.array(lines[10:]).reshape(90, 40)
    if by_rows:
        body = body.T
    if swapped_header:
        header[:2] = header[1::-1]
    (scan,) = ptx(tmp_path, "".join(header) + "".join(body.ravel()))
    np.testing.assert_array_equal(scan.reflectance, NAMES)
    np.testing.assert_array_equal(scan.points, HALL)
    assert bool(scan.warnings) == (swapped_header or by_rows)


def test_a_scan_is_turned_flipped_and_counted_as_a_person_says(tmp_path):
    (tmp_path / "hall.ptx").write_text(ptx_text(HALL, NAMES))
    options = ReadOptions(turn_deg=90, flip_horizontal=True, unit="ft", step=2)
    (scan,) = read_scans(tmp_path / "hall.ptx", options=options)
    # The file counts its rows from the bottom: of the 40 the last one is the first of those that are kept.
    np.testing.assert_array_equal(scan.reflectance, np.rot90(NAMES[1::2, ::2], -1)[:, ::-1])
    np.testing.assert_allclose(scan.points, np.rot90(HALL[1::2, ::2], -1)[:, ::-1] * 0.3048)


# Poses and places


def test_a_scanner_upside_down_has_its_image_upright(case, tmp_path):
    (given,) = case("ptx_scanner_upside_down.ptx")
    assert names_its_pixels(given)
    frame = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[3, :3] = frame, (5, 6, 7)
    (made,) = ptx(tmp_path, ptx_text(HALL @ frame.T, NAMES, matrix=matrix, position=(5, 6, 7), axes=frame))
    np.testing.assert_array_equal(made.reflectance, NAMES)
    for scan in (given, made):
        assert "upside down" in scan.warnings[0]
        world = scan.points @ scan.pose[:3, :3].T
        assert world[0, ..., 2].mean() > world[-1, ..., 2].mean()
    np.testing.assert_allclose(made.points @ made.pose[:3, :3].T + made.pose[:3, 3], HALL + (5, 6, 7), atol=1e-9)


def test_a_scanner_on_its_side_has_its_image_upright(tmp_path):
    frame = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] = frame
    # Its grid turns about the world's X axis: rows of it are upright half circles there.
    stored = ptx_text(HALL, NAMES, matrix=matrix, axes=frame)
    (scan,) = ptx(tmp_path, stored)
    world = scan.points @ scan.pose[:3, :3].T
    np.testing.assert_allclose(
        np.sort(world.reshape(-1, 3), axis=0), np.sort((HALL @ frame).reshape(-1, 3), axis=0), atol=1e-9
    )
    assert "on its side" in scan.warnings[0]


@pytest.mark.parametrize("place", [(35.0, 12.0, 2.0), (-40.0, 7.0, 3.0)])
def test_points_in_site_coordinates_are_measured_from_where_the_scanner_stood(case, tmp_path, place):
    (given,) = case("e57_site_coordinates.e57")
    assert 1.5 < given.range.min() < 1.7 and 6.0 < given.range.max() < 6.2 and names_its_pixels(given)
    (made,) = e57(tmp_path, fields(HALL + place))
    np.testing.assert_allclose(made.points, HALL, atol=1e-6)
    np.testing.assert_allclose(made.pose[:3, 3], place, atol=1e-6)


def test_a_position_in_the_header_alone_is_taken_exactly(tmp_path):
    (scan,) = ptx(tmp_path, ptx_text(HALL + (35, 12, 2), NAMES, position=(35, 12, 2)))
    np.testing.assert_allclose(scan.points, HALL, atol=1e-12)
    np.testing.assert_array_equal(scan.pose[:3, 3], (35, 12, 2))
    assert any("the position in its header" in warning for warning in scan.warnings)


def test_points_that_were_brought_into_the_world_already_are_not_brought_there_again(tmp_path):
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[3, :3] = turn.T, (35, 12, 2)
    world = HALL @ turn.T + (35, 12, 2)
    (scan,) = ptx(tmp_path, ptx_text(world, NAMES, matrix=matrix, position=(35, 12, 2), axes=turn.T))
    np.testing.assert_allclose(scan.points, HALL, atol=1e-9)
    assert "in world coordinates already" in scan.warnings[0]


def test_no_returns_that_repeat_the_scanners_place_are_none_and_tell_the_place(tmp_path):
    points = HALL + (35, 12, 2)
    gone = np.random.default_rng(0).random(NAMES.shape) < 0.2
    points[gone] = 35, 12, 2
    (scan,) = ptx(tmp_path, ptx_text(points, NAMES))
    np.testing.assert_array_equal(scan.valid, ~gone)
    np.testing.assert_allclose(scan.points[scan.valid], HALL[~gone], atol=1e-12)
    assert f"{np.count_nonzero(gone):,} pixels repeat one and the same point, (35 12 2)" in scan.warnings[0]


# Broken texts


def test_what_windows_prints_for_no_number_is_no_return(case):
    (scan,) = case("ptx_windows_nan.ptx")
    assert names_its_pixels(scan) and scan.valid.sum() == 1636


def test_the_first_of_two_scans_is_read_where_the_second_is_cut_short(case):
    (scan,) = case("ptx_second_scan_cut.ptx")
    assert scan.shape == (20, 40) and names_its_pixels(scan)
    assert "its scan 2 was left out" in scan.warnings[-1]


# Several returns


@pytest.mark.parametrize(("returns", "chosen"), [("first", 0), ("strongest", 1), ("last", 2)])
def test_of_three_returns_one_is_taken_by_its_number(case, tmp_path, returns, chosen):
    (given,) = case("e57_three_returns.e57", returns=returns)
    assert given.shape == (16, 30) and given.valid.all()
    assert "480 pixels have several returns" in given.warnings[0]
    three = [fields(HALL * far, intensity=NAMES + strong, returnIndex=np.full(NAMES.shape, number))["fields"]
             for number, (far, strong) in enumerate([(1.0, 0.0), (1.5, 100.0), (2.0, 50.0)])]  # fmt: skip
    order = np.random.default_rng(2).permutation(3 * NAMES.size)
    mixed = {name: np.concatenate([part[name] for part in three])[order] for name in three[0]}
    (made,) = e57(tmp_path, {"fields": mixed}, returns=returns)
    np.testing.assert_allclose(made.points, HALL * (1.0, 1.5, 2.0)[chosen], atol=1e-12)


def test_of_three_returns_without_numbers_the_nearest_is_taken(tmp_path):
    three = [fields(HALL * far)["fields"] for far in (2.0, 1.0, 1.5)]
    (scan,) = e57(tmp_path, {"fields": {name: np.concatenate([part[name] for part in three]) for name in three[0]}})
    np.testing.assert_array_equal(scan.points, HALL)
    assert "3,600 pixels have several returns; the first was taken, 7,200 others were left out" in scan.warnings[0]


@pytest.mark.parametrize("numbers", [(2, 1, 0), (7, 7, 7), (3, 3, 1)])
@pytest.mark.parametrize(("returns", "far"), [("first", 1.0), ("last", 2.0)])
def test_numbers_that_run_backward_or_say_nothing_do_not_make_a_far_return_the_first(tmp_path, numbers, returns, far):
    three = [fields(HALL * far, returnIndex=np.full(NAMES.shape, number))["fields"]
             for far, number in zip((1.0, 1.5, 2.0), numbers, strict=True)]  # fmt: skip
    order = np.random.default_rng(2).permutation(3 * NAMES.size)
    mixed = {name: np.concatenate([part[name] for part in three])[order] for name in three[0]}
    (scan,) = e57(tmp_path, {"fields": mixed}, returns=returns)
    np.testing.assert_array_equal(scan.points, HALL * far)
    assert ("turned around" in scan.warnings[0]) == (len(set(numbers)) > 1)


# Lines instead of rows and columns, coordinates of two kinds


def test_lines_of_points_are_rows_and_columns(case, tmp_path):
    (given,) = case("e57_grouping_by_line_only.e57")
    assert given.shape == (30, 60) and names_its_pixels(given)
    for alone in ({"rows": None, "rowIndex": None}, {"columnIndex": None}):
        alone.pop("rows", None)
        (made,) = e57(tmp_path, fields(**alone))
        np.testing.assert_array_equal(made.points, HALL)


def test_spherical_coordinates_are_taken_where_the_cartesian_are_zero(tmp_path):
    distance = np.linalg.norm(HALL, axis=-1)
    spherical = {
        "sphericalRange": distance,
        "sphericalAzimuth": np.arctan2(HALL[..., 1], HALL[..., 0]),
        "sphericalElevation": np.arcsin(HALL[..., 2] / distance),
    }
    (scan,) = e57(tmp_path, fields(HALL * 0, **spherical))
    np.testing.assert_allclose(scan.points, HALL, atol=1e-12)
    assert "spherical coordinates only" in scan.warnings[0]


def test_an_invalid_state_of_the_other_kind_counts_where_there_is_no_own(tmp_path):
    state = np.zeros(NAMES.shape, int)
    state[3, 4:9] = 2
    (scan,) = e57(tmp_path, fields(sphericalInvalidState=state))
    np.testing.assert_array_equal(scan.valid, state == 0)


# Colors


def test_colors_from_0_to_1_are_colors(case, tmp_path):
    for scan in (*case("ptx_color_0_to_1.ptx"), *case("e57_color_0_to_1_without_limits.e57")):
        assert scan.color is not None and scan.color.max() == 255 and len(np.unique(scan.color)) > 50
    for stored in (np.round(COLOR / 255, 6), np.round(COLOR / 255 * 1023)):
        (made,) = ptx(tmp_path, ptx_text(HALL, NAMES, stored))
        np.testing.assert_array_equal(made.color, COLOR)


@pytest.mark.parametrize(
    ("stored", "limits", "told"),
    [
        (COLOR.astype(int) * 257, None, False),
        (COLOR.astype(int), (0, 65535), True),
        (COLOR / 255, (0, 255), True),
        (COLOR.astype(int), (0.0, 1.0), True),
        (np.round(COLOR / 255 * 4095).astype(int), (0, 65535), True),
    ],
    ids=["16 bits", "8 bits said to be 16", "0 to 1 said to be 8 bits", "8 bits said to be 0 to 1", "12 said to be 16"],
)
def test_colors_are_scaled_by_what_they_are(tmp_path, stored, limits, told):
    names = ("colorRed", "colorGreen", "colorBlue")
    header = {}
    if limits:
        ends = zip(("Minimum", "Maximum"), limits, strict=True)
        header = {"colorLimits": {f"{name}{end}": value for end, value in ends for name in names}}
    (scan,) = e57(tmp_path, fields(**dict(zip(names, np.moveaxis(stored, -1, 0), strict=True))) | header)
    np.testing.assert_array_equal(scan.color, COLOR)
    assert any("does not fit the scale" in warning for warning in scan.warnings) == told
