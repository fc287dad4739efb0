"""PTX in all the ways in which programs write it, and what is said about those that are broken."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_scans import intensity_of, ptx_text, room_points

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.readers import ReadOptions, read_scans

POINTS = room_points()
INTENSITY = intensity_of(POINTS)
COLOR = np.random.default_rng(1).integers(0, 256, POINTS.shape, np.uint8)


def read(tmp_path, text, name="garage.ptx"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_scans(path)


def failure(tmp_path, text):
    with pytest.raises(ScanError) as caught:
        read(tmp_path, text)
    message = str(caught.value)
    assert "\n" not in message
    return message


def lines_of(text):
    return text.splitlines(keepends=True)


def test_a_ptx_comes_back_upright_with_every_value_as_stored(tmp_path):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, COLOR))
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.reflectance, INTENSITY)
    assert np.array_equal(scan.color, COLOR)
    assert scan.valid.all()
    assert scan.name == "garage"
    assert scan.warnings == ()


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("horizontal", [False, True])
def test_any_stored_order_of_rows_and_columns_is_turned_upright(tmp_path, vertical, horizontal):
    turn = (slice(None, None, -1 if vertical else 1), slice(None, None, -1 if horizontal else 1))
    (scan,) = read(tmp_path, ptx_text(POINTS[turn], INTENSITY[turn]))
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.reflectance, INTENSITY)
    assert scan.warnings == ()


def test_intensities_beyond_0_to_1_stay_raw(tmp_path):
    raw = np.linspace(-2048, 2047, INTENSITY.size).round().reshape(INTENSITY.shape)
    (scan,) = read(tmp_path, ptx_text(POINTS, raw))
    assert np.array_equal(scan.reflectance, raw)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\n\n", " \n", "\t\r\n"])
@pytest.mark.parametrize("between", [" ", "\t", "   "])
@pytest.mark.parametrize("start", [b"", b"\xef\xbb\xbf", b"\n\n"])
def test_line_ends_blanks_tabs_and_a_byte_order_mark_change_nothing(tmp_path, end, between, start):
    text = ptx_text(POINTS, INTENSITY, COLOR, end=end, between=between)
    (scan,) = read(tmp_path, start + text.encode())
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.color, COLOR)


def test_the_last_line_needs_no_end(tmp_path):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY).rstrip("\n"))
    assert np.array_equal(scan.points, POINTS)


@pytest.mark.parametrize("block", [64, 100, 1000])
def test_where_blocks_of_reading_end_does_not_matter(tmp_path, monkeypatch, block):
    monkeypatch.setattr("reflcolor_addon.files.readers.text_lines._BLOCK", block)
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, COLOR, end="\r\n"))
    assert np.array_equal(scan.points, POINTS)
    assert np.array_equal(scan.color, COLOR)


def test_zeros_are_no_returns_and_take_no_part_in_the_pose(tmp_path):
    points = POINTS.copy()
    points[2, 3] = points[7, 0] = 0
    matrix = np.eye(4)
    matrix[3, :3] = position = (10, 20, 30)
    (scan,) = read(tmp_path, ptx_text(points, INTENSITY, matrix=matrix, position=position))
    assert np.array_equal(scan.valid, points.any(axis=-1))
    assert not scan.points[~scan.valid].any()
    assert scan.warnings == ()


def test_the_matrix_becomes_a_pose_for_column_vectors(tmp_path):
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[3, :3] = turn.T, (600000.25, 5000000.5, 431.125)
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, position=matrix[3, :3], axes=matrix[:3, :3], matrix=matrix))
    ahead = scan.pose @ [1, 0, 0, 1]
    assert np.array_equal(ahead, [600000.25, 5000001.5, 431.125, 1])
    assert scan.warnings == ()


def test_several_scans_in_one_file_are_told_apart(tmp_path):
    other = room_points(5, 8)
    scans = read(tmp_path, ptx_text(POINTS, INTENSITY, COLOR) + "\n" + ptx_text(other, intensity_of(other)))
    assert [scan.name for scan in scans] == ["garage 1", "garage 2"]
    assert np.array_equal(scans[1].points, other)
    assert scans[0].color is not None
    assert scans[1].color is None


def test_ten_values_per_line_are_read_without_the_normals(tmp_path):
    header, body = lines_of(ptx_text(POINTS, INTENSITY, COLOR))[:10], lines_of(ptx_text(POINTS, INTENSITY, COLOR))[10:]
    (scan,) = read(tmp_path, "".join(header) + "".join(line.rstrip() + " 0 0 1\n" for line in body))
    assert np.array_equal(scan.color, COLOR)


def test_points_without_color_among_colored_ones_are_black_and_counted(tmp_path):
    lines = lines_of(ptx_text(POINTS, INTENSITY, COLOR))
    lines[10] = " ".join(lines[10].split()[:4]) + "\n"
    lines[11] = "0 0 0 0.5\n"
    (scan,) = read(tmp_path, "".join(lines))
    assert not scan.color[-2:, 0].any()
    assert np.array_equal(scan.color[:-2], COLOR[:-2])
    assert [warning for warning in scan.warnings if "1 points have no color" in warning]


def test_three_equal_colors_are_no_color(tmp_path):
    gray = np.repeat(COLOR[..., :1], 3, axis=-1)
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, gray))
    assert scan.color is None
    assert np.array_equal(scan.reflectance, INTENSITY)
    assert "red = green = blue" in scan.warnings[0]


def test_gray_colors_stand_in_for_an_intensity_that_is_the_same_everywhere(tmp_path):
    gray = np.repeat(COLOR[..., :1], 3, axis=-1)
    (scan,) = read(tmp_path, ptx_text(POINTS, np.full(INTENSITY.shape, 0.5), gray))
    assert scan.color is None
    assert np.array_equal(scan.reflectance, gray[..., 0])
    assert "taken as the intensity" in scan.warnings[0]


@pytest.mark.parametrize("scale", [1 / 255, 257.0])
def test_colors_are_brought_to_8_bits_from_the_scale_of_their_values(tmp_path, scale):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, COLOR * scale))
    assert np.array_equal(scan.color, COLOR)
    assert scan.warnings == ()


def test_values_that_are_no_colors_are_not_taken_for_colors(tmp_path):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, COLOR - 300.0))
    assert scan.color is None
    assert "taken as a scan without color" in scan.warnings[0]


@pytest.mark.parametrize("word", ["-nan(ind)", "nan", "1.#QNAN", "-1.#IND00", "nan(snan)", "1.#INF"])
def test_what_programs_print_for_no_number_is_no_return(tmp_path, word):
    lines = lines_of(ptx_text(POINTS, INTENSITY, COLOR))
    lines[13] = f"{word} {word} {word} 0.5 0 0 0\n"
    (scan,) = read(tmp_path, "".join(lines))
    assert np.count_nonzero(~scan.valid) == 1


@pytest.mark.parametrize("end", ["\x1a", "\x1a\r\n", "\n\x1a\n", "\x00\x00", "# made by a program\n", "-1\n"])
def test_what_stands_behind_the_last_scan_is_left_out(tmp_path, end):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY) + end)
    assert np.array_equal(scan.points, POINTS)
    told = [warning for warning in scan.warnings if "what follows its last scan" in warning]
    assert len(told) == (end[0] in "#-")


def test_numbers_that_are_not_finite_are_no_returns_and_counted(tmp_path):
    points = POINTS.copy()
    points[0, 0, 1], points[1, 1, 0], points[2, 2, 2] = np.nan, np.inf, 1e200
    (scan,) = read(tmp_path, ptx_text(points, INTENSITY))
    assert np.count_nonzero(~scan.valid) == 3
    assert "3 points" in scan.warnings[0]


@pytest.mark.parametrize(
    ("matrix", "said"),
    [
        (np.diag([1, 1, 1, 0.0]), "corrupt"),
        (np.full((4, 4), np.nan), "corrupt"),
        (np.zeros((4, 4)) + np.diag([0, 0, 0, 1.0]), "singular"),
    ],
)
@pytest.mark.parametrize("axes", [None, np.zeros((3, 3))])
def test_a_corrupt_matrix_is_never_silently_the_identity(tmp_path, matrix, said, axes):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, matrix=matrix, axes=axes, position=(1, 2, 3)))
    expected = np.eye(4)
    if axes is None:
        expected[:3, 3] = 1, 2, 3
    assert np.array_equal(scan.pose, expected)
    assert "scan 'garage'" in scan.warnings[0]
    assert said in scan.warnings[0]
    assert ("identity" in scan.warnings[0]) == (axes is not None)


@pytest.mark.parametrize("scale", [2.0, 0.3048, 0.001])
def test_a_matrix_that_scales_evenly_says_what_the_points_count(tmp_path, scale):
    matrix = np.diag([scale, scale, scale, 1.0])
    (scan,) = read(tmp_path, ptx_text(POINTS / scale, INTENSITY, matrix=matrix))
    assert scan.points == pytest.approx(POINTS)
    assert np.array_equal(scan.pose, np.eye(4))
    assert f"scales by {scale:g}" in scan.warnings[0]


def test_a_matrix_that_shears_is_kept_and_told(tmp_path):
    matrix = np.eye(4)
    matrix[0, 1] = 0.5
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, matrix=matrix))
    assert np.array_equal(scan.pose, matrix.T)
    assert "scales, shears or mirrors" in scan.warnings[0]


@pytest.mark.parametrize(
    ("header", "said"),
    [({"position": (1, 2, 3)}, "position (1 2 3)"), ({"axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]}, "axes")],
)
def test_a_header_that_disagrees_with_its_matrix_is_told_and_the_matrix_used(tmp_path, header, said):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY, **header))
    assert np.array_equal(scan.pose, np.eye(4))
    assert said in scan.warnings[0]


def test_points_in_world_coordinates_are_kept_and_told(tmp_path):
    world = POINTS + [637012.25, 849028.5, 431.5]
    (scan,) = read(tmp_path, ptx_text(world, INTENSITY))
    assert np.array_equal(scan.points[::-1], world)
    assert "world coordinates" in scan.warnings[0]


@pytest.mark.parametrize(
    ("line", "instead", "message"),
    [
        (12, "1 2 3 4 5", "garage.ptx: line 12: expected 4 or 7 values, found 5"),
        (12, "1 2 3", "garage.ptx: line 12: expected 4 or 7 values, found 3: '1 2 3'"),
        (20, "1 2 three 4", "garage.ptx: line 20: expected a number, found 'three'"),
        (20, "1 2 3 1_0", "garage.ptx: line 20: expected a number, found '1_0'"),
        (20, "1 2 3 0,5", "garage.ptx: line 20: expected a number, found '0,5'"),
        (1, "0", "garage.ptx: line 1: expected the number of columns (a whole number above 0), found '0'"),
        (1, "-14", "garage.ptx: line 1: expected the number of columns (a whole number above 0), found '-14'"),
        (1, "14.5", "garage.ptx: line 1: expected the number of columns (a whole number above 0), found '14.5'"),
        (2, "many", "garage.ptx: line 2: expected the number of rows (a whole number above 0), found 'many'"),
        (3, "0 0", "garage.ptx: line 3: expected the scanner's position (3 numbers), found 2: '0 0'"),
        (5, "0 x 0", "garage.ptx: line 5: expected a number, found 'x'"),
        (10, "0 0 0 1 0", "garage.ptx: line 10: expected a row of the matrix (4 numbers), found 5"),
    ],
)
def test_what_is_wrong_in_a_line_is_told_with_its_number(tmp_path, line, instead, message):
    lines = lines_of(ptx_text(POINTS, INTENSITY))
    lines[line - 1] = instead + "\n"
    assert failure(tmp_path, "".join(lines)) == message


def test_blank_lines_are_counted_in_line_numbers(tmp_path):
    lines = lines_of(ptx_text(POINTS, INTENSITY, end="\n\n"))
    lines[42] = "oops\n"
    assert failure(tmp_path, "".join(lines)).startswith("garage.ptx: line 43: expected 4 or 7 values, found 1")


@pytest.mark.parametrize("lost", [1, 3, 9, 40])
def test_of_a_file_that_ends_early_the_whole_columns_are_kept(tmp_path, lost):
    lines = lines_of(ptx_text(POINTS, INTENSITY))
    (scan,) = read(tmp_path, "".join(lines[:-lost]) + "1.5 0.")
    columns = (126 - lost) // 9
    assert np.array_equal(scan.points, POINTS[:, :columns])
    assert f"the file ends after {126 - lost} of 126 points" in scan.warnings[0]


def test_a_file_without_two_whole_columns_is_refused(tmp_path):
    lines = lines_of(ptx_text(POINTS, INTENSITY))
    assert "it is cut short" in failure(tmp_path, "".join(lines[:20]))
    assert "it is cut short" in failure(tmp_path, "".join(lines[:10]))
    assert "it is cut short" in failure(tmp_path, "".join(lines[:7]))


@pytest.mark.parametrize("kept", [0.9, 0.05, 0.01])
def test_a_second_scan_that_is_cut_short_is_left_out_and_told(tmp_path, kept):
    whole, other = ptx_text(POINTS, INTENSITY), ptx_text(POINTS * 2, INTENSITY)
    (scan,) = read(tmp_path, whole + other[: int(len(other) * kept)])
    assert np.array_equal(scan.points, POINTS)
    assert "its scan 2 was left out: " in scan.warnings[-1]


@pytest.mark.parametrize("size", ["4000000000\n4000000000", "999999999999999999\n1", "1\n999999999999999999"])
def test_sizes_that_the_file_cannot_hold_are_refused_before_anything_is_allocated(tmp_path, size):
    text = ptx_text(POINTS, INTENSITY).split("\n", 2)[2]
    message = failure(tmp_path, f"{size}\n{text}")
    assert message.startswith("garage.ptx: line 1: ")
    assert "has room for at most" in message


def test_a_size_that_does_not_fit_into_memory_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("reflcolor_addon.files.memory.available_bytes", lambda: 1000)
    assert "of memory" in failure(tmp_path, ptx_text(POINTS, INTENSITY))


def test_more_points_than_announced_are_told(tmp_path):
    (scan,) = read(tmp_path, ptx_text(POINTS, INTENSITY) + "1 2 3 4\n")
    assert "line 137: what follows its last scan is not a scan and was left out: '1 2 3 4'" in scan.warnings[-1]


def test_a_scan_without_any_return_is_refused(tmp_path):
    assert "no pixel with a return" in failure(tmp_path, ptx_text(POINTS * 0, INTENSITY))


def test_a_scan_of_one_point_again_and_again_is_refused(tmp_path):
    assert "no pixel with a return" in failure(tmp_path, ptx_text(np.ones_like(POINTS), INTENSITY))


def test_no_grid_by_angle_is_laid_over_nothing(tmp_path):
    (tmp_path / "a.ptx").write_text(ptx_text(POINTS * 0, INTENSITY))
    with pytest.raises(ScanError, match=r"a\.ptx: scan 'a' has no pixel with a return"):
        read_scans(tmp_path / "a.ptx", options=ReadOptions(grid="angle"))


def test_what_is_implausible_once_it_is_moved_is_told_with_the_file_and_the_scan(tmp_path):
    (tmp_path / "a.ptx").write_text(ptx_text(POINTS, INTENSITY))
    with pytest.raises(ScanError, match=r"^a\.ptx: a: the pose is not that of a scanner"):
        read_scans(tmp_path / "a.ptx", options=ReadOptions(position=(2e9, 0, 0)))


def test_an_empty_scan_among_others_is_left_out_and_told(tmp_path):
    scans = read(tmp_path, ptx_text(POINTS * 0, INTENSITY) + ptx_text(POINTS, INTENSITY))
    assert [scan.name for scan in scans] == ["garage 2"]
    assert "left out: scan 'garage 1'" in scans[0].warnings[-1]


def test_binary_and_wide_text_are_refused(tmp_path):
    assert "UTF-16" in failure(tmp_path, ptx_text(POINTS, INTENSITY).encode("utf-16"))
    assert "line 1" in failure(tmp_path, bytes(range(256)) * 1000)
    assert "longer than any line" in failure(tmp_path, b"1" * 200_000)


def test_cancelling_and_progress(tmp_path, monkeypatch):
    monkeypatch.setattr("reflcolor_addon.files.readers.text_lines._BLOCK", 1000)
    path = tmp_path / "garage.ptx"
    path.write_text(ptx_text(POINTS, INTENSITY))
    told = []
    read_scans(path, progress=lambda fraction, text: told.append((fraction, text)))
    assert told[-1] == (1.0, "Reading garage.ptx")
    assert [fraction for fraction, _ in told] == sorted(fraction for fraction, _ in told)
    answers = iter([False, False, True])
    with pytest.raises(Cancelled):
        read_scans(path, cancelled=lambda: next(answers))


@given(data=st.data())
def test_damaged_text_never_leaves_the_error_family(tmp_path_factory, data):
    text = bytearray(ptx_text(POINTS, INTENSITY, COLOR).encode())
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at : at + data.draw(st.integers(0, 40))] = data.draw(st.binary(max_size=12))
    path = tmp_path_factory.getbasetemp() / "damaged.ptx"
    path.write_bytes(text)
    try:
        scans = read_scans(path)
    except ScanError as error:
        assert "\n" not in str(error)
    else:
        assert all(scan.valid.any() for scan in scans)
