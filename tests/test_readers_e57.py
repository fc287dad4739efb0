"""Structured E57 with and without all that the standard leaves optional."""

import sys

import numpy as np
import pytest
from e57_samples import write_e57
from sample_scans import intensity_of, room_points

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.readers import read_scans

POINTS = room_points()
INTENSITY = intensity_of(POINTS)
HEIGHT, WIDTH = INTENSITY.shape
COLOR = np.random.default_rng(1).integers(0, 256, POINTS.shape, np.uint8)


def scan_fields(*, keep=None, **changes):
    """Fields of the points of an upright scan, one value per pixel; `None` takes a field away."""
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    fields = {
        "cartesianX": POINTS[..., 0],
        "cartesianY": POINTS[..., 1],
        "cartesianZ": POINTS[..., 2],
        "intensity": INTENSITY,
        "rowIndex": row,
        "columnIndex": column,
        **changes,
    }
    keep = slice(None) if keep is None else keep
    return {name: np.ravel(values)[keep] for name, values in fields.items() if values is not None}


def colors(values=COLOR):
    return dict(zip(("colorRed", "colorGreen", "colorBlue"), np.moveaxis(values, -1, 0), strict=True))


def read(tmp_path, *scans):
    path = tmp_path / "garage.e57"
    write_e57(path, *scans)
    return read_scans(path)


def failure(tmp_path, *scans):
    with pytest.raises(ScanError) as caught:
        read(tmp_path, *scans)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_structured_e57_without_any_header_comes_back_as_stored(tmp_path):
    (scan,) = read(tmp_path, {"fields": scan_fields()})
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.reflectance, INTENSITY)
    assert scan.valid.all()
    assert scan.color is None
    assert np.array_equal(scan.pose, np.eye(4))
    assert scan.name == "garage"
    assert scan.warnings == ()


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("horizontal", [False, True])
def test_any_stored_order_of_rows_and_columns_is_turned_upright(tmp_path, vertical, horizontal):
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    row, column = HEIGHT - 1 - row if vertical else row, WIDTH - 1 - column if horizontal else column
    (scan,) = read(tmp_path, {"fields": scan_fields(rowIndex=row, columnIndex=column)})
    assert np.array_equal(scan.points, POINTS)
    assert scan.warnings == ()


def test_the_pose_is_kept_apart_from_the_points(tmp_path):
    half = np.sqrt(0.5)
    pose = {
        "rotation": {"w": half, "x": 0.0, "y": 0.0, "z": half},
        "translation": {"x": 600000.25, "y": 5000000.5, "z": 431.0},
    }
    (scan,) = read(tmp_path, {"fields": scan_fields(), "pose": pose})
    assert np.array_equal(scan.points, POINTS)
    assert scan.pose @ [1, 0, 0, 1] == pytest.approx([600000.25, 5000001.5, 431.0, 1], abs=1e-9)
    assert scan.pose @ [0, 1, 0, 1] == pytest.approx([599999.25, 5000000.5, 431.0, 1], abs=1e-9)


@pytest.mark.parametrize(
    ("pose", "origin"),
    [
        ({"translation": {"x": 1.0, "y": 2.0, "z": 3.0}}, (1, 2, 3)),
        ({"rotation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}}, (0, 0, 0)),
        ({}, (0, 0, 0)),
    ],
)
def test_every_part_of_the_pose_is_optional(tmp_path, pose, origin):
    (scan,) = read(tmp_path, {"fields": scan_fields(), "pose": pose})
    assert np.array_equal(scan.pose[:3, 3], origin)
    assert np.array_equal(scan.pose[:3, :3], np.eye(3))
    assert scan.warnings == ()


def test_texts_where_numbers_are_expected_are_ignored(tmp_path):
    header = {
        "pose": {"rotation": {"w": "one"}, "translation": "far away"},
        "indexBounds": {"rowMinimum": "first", "rowMaximum": "last"},
        "colorLimits": {"colorRedMinimum": "dark"},
        "name": 7,
    }
    (scan,) = read(tmp_path, {"fields": scan_fields(**colors()), **header})
    assert np.array_equal(scan.pose, np.eye(4))
    assert np.array_equal(scan.color, COLOR)
    assert scan.name == "garage"


def test_numbers_that_are_not_finite_are_no_returns_and_counted(tmp_path):
    points, intensity = POINTS.copy(), INTENSITY.copy()
    points[0, 0, 0], points[1, 1, 1], intensity[2, 2] = np.nan, np.inf, 1e300
    axes = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), np.moveaxis(points, -1, 0), strict=True))
    (scan,) = read(tmp_path, {"fields": scan_fields(**axes, intensity=intensity)})
    assert np.count_nonzero(~scan.valid) == 3
    assert "3 points hold a number that is not finite" in scan.warnings[0]


@pytest.mark.parametrize(("length", "said"), [(0.0, "corrupt"), (2.0, "length 2")])
def test_a_rotation_that_is_none_is_told(tmp_path, length, said):
    rotation = {"w": length, "x": 0.0, "y": 0.0, "z": 0.0}
    (scan,) = read(tmp_path, {"fields": scan_fields(), "pose": {"rotation": rotation}, "name": "yard"})
    assert np.array_equal(scan.pose, np.eye(4))
    assert "scan 'yard'" in scan.warnings[0]
    assert said in scan.warnings[0]


def test_spherical_coordinates_become_the_same_points(tmp_path):
    distance = np.linalg.norm(POINTS, axis=-1)
    spherical = {
        "sphericalRange": distance,
        "sphericalAzimuth": np.arctan2(POINTS[..., 1], POINTS[..., 0]),
        "sphericalElevation": np.arcsin(POINTS[..., 2] / distance),
    }
    cartesian = dict.fromkeys(("cartesianX", "cartesianY", "cartesianZ"))
    state = np.zeros(INTENSITY.shape, int)
    state[3, 4], state[5, 6] = 1, 2
    (scan,) = read(tmp_path, {"fields": scan_fields(**cartesian, **spherical, sphericalInvalidState=state)})
    assert np.array_equal(scan.valid, state == 0)
    assert scan.points[scan.valid] == pytest.approx(POINTS[scan.valid], abs=1e-12)


def test_points_whose_state_is_not_valid_are_no_returns(tmp_path):
    state = np.zeros(INTENSITY.shape, int)
    state[0, 0], state[5, 6] = 1, 2
    (scan,) = read(tmp_path, {"fields": scan_fields(cartesianInvalidState=state)})
    assert np.array_equal(scan.valid, state == 0)


def test_points_without_intensity_are_no_returns_and_counted(tmp_path):
    invalid = np.zeros(INTENSITY.shape, int)
    invalid[2, 2:5] = 1
    (scan,) = read(tmp_path, {"fields": scan_fields(isIntensityInvalid=invalid)})
    assert np.array_equal(scan.valid, invalid == 0)
    assert "3 points without intensity" in scan.warnings[0]


def test_rows_and_columns_are_counted_from_the_first_that_occurs(tmp_path):
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    (scan,) = read(tmp_path, {"fields": scan_fields(rowIndex=row - 5, columnIndex=column + 70000)})
    assert np.array_equal(scan.points, POINTS)


def test_pixels_without_a_point_are_holes(tmp_path):
    keep = np.ones(INTENSITY.size, bool)
    keep[[17, 40, 41]] = False
    (scan,) = read(tmp_path, {"fields": scan_fields(keep=keep)})
    assert np.array_equal(scan.valid.ravel(), keep)
    assert np.array_equal(scan.points[scan.valid], POINTS.reshape(-1, 3)[keep])


def test_index_bounds_keep_margins_without_points(tmp_path):
    keep = (np.mgrid[:HEIGHT, :WIDTH][1] < WIDTH - 2).ravel()
    bounds = {"rowMinimum": 0, "rowMaximum": HEIGHT - 1, "columnMinimum": 0, "columnMaximum": WIDTH - 1}
    (scan,) = read(tmp_path, {"fields": scan_fields(keep=keep), "indexBounds": bounds})
    assert np.array_equal(scan.valid.ravel(), keep)


def test_index_bounds_keep_margins_of_most_of_the_grid(tmp_path):
    keep = (np.mgrid[:HEIGHT, :WIDTH][1] == 1).ravel()
    bounds = {"rowMinimum": 0, "rowMaximum": HEIGHT - 1, "columnMinimum": 0, "columnMaximum": WIDTH - 1}
    (scan,) = read(tmp_path, {"fields": scan_fields(keep=keep), "indexBounds": bounds})
    assert scan.shape == (HEIGHT, WIDTH)


@pytest.mark.parametrize("bounds", [(3, 4), (0, 10**15), (0, 65535), (-5, 3)])
def test_index_bounds_that_cannot_be_true_are_ignored(tmp_path, bounds):
    bounds = {"columnMinimum": bounds[0], "columnMaximum": bounds[1]}
    (scan,) = read(tmp_path, {"fields": scan_fields(), "indexBounds": bounds})
    assert scan.shape == (HEIGHT, WIDTH)


def test_of_points_in_one_pixel_the_first_return_is_kept_and_the_others_counted(tmp_path):
    order = np.r_[0 : INTENSITY.size, 5, 5, 9]
    state = np.zeros(INTENSITY.size, int)
    state[5] = 2
    fields = scan_fields(cartesianInvalidState=state, keep=order)
    fields["cartesianInvalidState"][-3:-1] = 0
    fields["intensity"][-3:] = 100, 200, 300
    (scan,) = read(tmp_path, {"fields": fields})
    assert scan.valid.all()
    assert scan.reflectance.ravel()[5] == 100
    assert scan.reflectance.ravel()[9] == INTENSITY.ravel()[9]
    assert "2 pixels have several returns; the first was taken, 2 others were left out" in scan.warnings[0]


def test_the_order_of_points_in_the_file_does_not_matter(tmp_path):
    order = np.random.default_rng(3).permutation(INTENSITY.size)
    (scan,) = read(tmp_path, {"fields": scan_fields(keep=order, **colors())})
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.color, COLOR)


def limits(low, high):
    return {f"color{name}{end}": value for name in ("Red", "Green", "Blue") for end, value in
            (("Minimum", low), ("Maximum", high))}  # fmt: skip


@pytest.mark.parametrize(
    ("stored", "stated"),
    [
        (COLOR, None),
        (COLOR, limits(0, 255)),
        (COLOR, limits(3, 250)),
        (COLOR.astype(int) * 257, limits(0, 65535)),
        (COLOR / 255, limits(0.0, 1.0)),
        (COLOR / 255 * 4.0 + 1.0, limits(1.0, 5.0)),
        (COLOR, limits(7, 7)),
    ],
)
def test_colors_are_brought_to_8_bits_by_their_limits(tmp_path, stored, stated):
    header = {} if stated is None else {"colorLimits": stated}
    (scan,) = read(tmp_path, {"fields": scan_fields(**colors(stored)), **header})
    assert np.array_equal(scan.color, COLOR)


def test_three_equal_colors_are_no_color(tmp_path):
    gray = np.repeat(COLOR[..., :1], 3, axis=-1)
    (scan,) = read(tmp_path, {"fields": scan_fields(**colors(gray))})
    assert scan.color is None
    assert "red = green = blue" in scan.warnings[0]


def test_gray_colors_stand_in_for_a_missing_intensity(tmp_path):
    gray = np.repeat(COLOR[..., :1], 3, axis=-1)
    (scan,) = read(tmp_path, {"fields": scan_fields(intensity=None, **colors(gray))})
    assert np.array_equal(scan.reflectance, gray[..., 0])
    assert scan.color is None


def test_the_luminance_of_colors_stands_in_for_a_missing_intensity(tmp_path):
    (scan,) = read(tmp_path, {"fields": scan_fields(intensity=None, **colors())})
    assert "luminance of its colors stands in" in scan.warnings[0]
    np.testing.assert_allclose(scan.reflectance, COLOR @ [0.299, 0.587, 0.114], atol=1e-3)
    assert np.array_equal(scan.color, COLOR)


def test_a_scan_with_nothing_to_colorize_can_be_looked_at(tmp_path):
    (scan,) = read(tmp_path, {"fields": scan_fields(intensity=None)})
    assert "not colorized" in scan.warnings[0] and not scan.reflectance.any() and scan.valid.all()


def test_an_unstructured_scan_is_told_what_to_do(tmp_path):
    fields = scan_fields(rowIndex=None, columnIndex=None)
    message = failure(tmp_path, {"fields": fields, "name": "yard"})
    assert message.startswith(
        "garage.e57: scan 'yard' is unstructured (its points have no rowIndex and columnIndex); "
        "export it as PTX or as a structured (gridded) E57, or have a grid laid over its points: --grid angle"
    )
    assert "none of its 2 scans can be used: scan" in failure(tmp_path, {"fields": fields}, {"fields": fields})


def test_structured_scans_beside_unstructured_ones_are_read_and_the_others_told(tmp_path):
    unstructured = {"fields": scan_fields(rowIndex=None, columnIndex=None)}
    scans = read(tmp_path, unstructured, {"fields": scan_fields(), "name": "b"},
                 {"fields": scan_fields()})  # fmt: skip
    assert [scan.name for scan in scans] == ["b", "garage 3"]
    assert scans[0].warnings[0].startswith("left out: scan 'garage 1' is unstructured")
    assert scans[1].warnings == ()


def test_row_and_column_numbers_that_tell_nothing_apart_are_refused(tmp_path):
    zero = np.zeros(INTENSITY.shape, int)
    assert "do not tell its points apart" in failure(tmp_path, {"fields": scan_fields(rowIndex=zero)})


def test_a_grid_that_asks_for_terabytes_is_refused(tmp_path):
    row = np.mgrid[:HEIGHT, :WIDTH][0] * 10**9
    assert "span 8,000,000,001 x 14 pixels" in failure(tmp_path, {"fields": scan_fields(rowIndex=row)})


def test_row_numbers_that_are_no_whole_numbers_are_refused(tmp_path):
    row = np.mgrid[:HEIGHT, :WIDTH][0] + 0.5
    assert "rowIndex holds values that are not whole numbers" in failure(
        tmp_path, {"fields": scan_fields(rowIndex=row)}
    )


def test_a_file_without_points_or_returns_is_refused(tmp_path):
    assert failure(tmp_path) == "garage.e57: holds no scan"
    nothing = {name: values[:0] for name, values in scan_fields().items()}
    assert "has no points" in failure(tmp_path, {"fields": nothing})
    invalid = np.full(INTENSITY.shape, 2)
    assert "no pixel with a return" in failure(tmp_path, {"fields": scan_fields(cartesianInvalidState=invalid)})


def test_files_larger_than_a_chunk_are_read_in_pieces_with_progress(tmp_path, monkeypatch):
    monkeypatch.setattr("reflcolor_addon.files.readers.e57_columns._ROOM", 10)
    path = tmp_path / "garage.e57"
    write_e57(path, {"fields": scan_fields(), "name": "yard"})
    told = []
    (scan,) = read_scans(path, progress=lambda fraction, text: told.append((fraction, text)))
    assert np.array_equal(scan.points, POINTS)
    assert told[0] == (0.0, "Reading garage.e57: yard")
    assert told[-1] == (1.0, "Reading garage.e57: yard")
    assert len(told) == 14
    for number in range(1, 20, 3):
        answers = iter([*[False] * number, True])
        with pytest.raises(Cancelled):
            read_scans(path, cancelled=lambda answers=answers: next(answers))


def test_a_name_of_several_lines_becomes_one(tmp_path):
    (scan,) = read(tmp_path, {"fields": scan_fields(), "name": " the\nyard "})
    assert scan.name == "the yard"


@pytest.mark.parametrize("name", ["Hof und Straße.e57", "庭.E57"])
def test_any_file_name_opens(tmp_path, name):
    write_e57(tmp_path / name, {"fields": scan_fields()})
    assert read_scans(tmp_path / name)[0].shape == (HEIGHT, WIDTH)


def test_where_there_is_no_pye57_the_way_out_is_named(tmp_path, monkeypatch):
    path = tmp_path / "garage.e57"
    write_e57(path, {"fields": scan_fields()})
    monkeypatch.setitem(sys.modules, "pye57", None)
    with pytest.raises(ScanError, match=r"^garage\.e57: E57 needs pye57, .*; export the scan as PTX$"):
        read_scans(path)
