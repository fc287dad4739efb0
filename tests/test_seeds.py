"""Seeds: in memory, as a file, and on a scan."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import ImageError, OutputError, Seeds, SeedsError
from reflcolor_addon.files.images import write_png
from reflcolor_addon.seeds.seeds import nearest_valid
from reflcolor_addon.seeds.seeds_file import sample_photo

PHOTO = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)


def write_seeds(path, *seeds, **changes):
    document = {"format": "reflcolor-seeds", "version": 1, "seeds": list(seeds)} | changes
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


@pytest.fixture
def seeds_path(tmp_path):
    return tmp_path / "seeds.json"


def test_a_seed_with_a_color_is_read(seeds_path):
    seeds = Seeds.load(write_seeds(seeds_path, {"row": 10, "col": 20, "rgb": [200, 80, 40]}))
    assert (seeds.rows.tolist(), seeds.cols.tolist(), seeds.rgb.tolist()) == ([10], [20], [[200, 80, 40]])
    assert seeds.photos == (None,)
    assert len(seeds) == 1


def test_a_seed_by_a_point_of_a_photo_has_the_color_of_the_pixel_there(seeds_path, tmp_path):
    write_png(tmp_path / "view.png", PHOTO)
    write_seeds(seeds_path, {"row": 5, "col": 7, "photo": "view.png", "x": 2.9, "y": 1.0})
    seeds = Seeds.load(seeds_path)
    assert (seeds.rgb[0] == PHOTO[1, 2]).all()
    assert seeds.photos == ("view.png",)
    assert seeds.photo_xy.tolist() == [[2.9, 1.0]]


def test_a_photo_that_is_given_goes_before_one_beside_the_seeds(seeds_path, tmp_path):
    (tmp_path / "other").mkdir()
    write_png(tmp_path / "view.png", PHOTO)
    write_png(tmp_path / "other" / "view.png", 255 - PHOTO)
    write_seeds(seeds_path, {"row": 5, "col": 7, "photo": "view.png", "x": 0, "y": 0})
    assert (Seeds.load(seeds_path, [tmp_path / "other" / "view.png"]).rgb[0] == 255 - PHOTO[0, 0]).all()
    assert (Seeds.load(seeds_path).rgb[0] == PHOTO[0, 0]).all()


def test_two_photos_of_the_name_that_a_seed_means_are_refused(seeds_path, tmp_path):
    write_seeds(seeds_path, {"row": 5, "col": 7, "photo": "view.png", "x": 0, "y": 0})
    with pytest.raises(SeedsError, match=r"view\.png may be .*a.view\.png or .*b.view\.png; give them different names"):
        Seeds.load(seeds_path, [tmp_path / "b" / "view.png", tmp_path / "a" / "view.png"])


def test_a_color_that_is_given_goes_before_the_photo_which_need_not_be_there(seeds_path):
    write_seeds(seeds_path, {"row": 5, "col": 7, "rgb": [1, 2, 3], "photo": "lost.png", "x": 0, "y": 0})
    seeds = Seeds.load(seeds_path)
    assert seeds.rgb.tolist() == [[1, 2, 3]]
    assert seeds.photos == ("lost.png",)


@given(
    entries=st.lists(
        st.tuples(
            st.integers(0, 10**6),
            st.integers(0, 10**6),
            st.tuples(*[st.integers(0, 255)] * 3),
            st.none() | st.tuples(st.text(min_size=1), st.floats(0, 1e6), st.floats(0, 1e6)),
        ),
        max_size=5,
    )
)
def test_what_is_saved_is_loaded_again(tmp_path_factory, entries):
    path = tmp_path_factory.mktemp("seeds") / "seeds.json"
    seeds = Seeds(
        [row for row, *_ in entries],
        [col for _, col, *_ in entries],
        [rgb for _, _, rgb, _ in entries],
        [photo and photo[0] for *_, photo in entries],
        [photo[1:] if photo else (np.nan, np.nan) for *_, photo in entries],
    )
    seeds.save(path)
    again = Seeds.load(path)
    assert again.photos == seeds.photos
    for name in ("rows", "cols", "rgb", "photo_xy"):
        np.testing.assert_array_equal(getattr(again, name), getattr(seeds, name))


def test_a_file_with_a_byte_order_mark_is_read(seeds_path):
    write_seeds(seeds_path, {"row": 1, "col": 2, "rgb": [3, 4, 5]})
    seeds_path.write_bytes(b"\xef\xbb\xbf" + seeds_path.read_bytes())
    assert len(Seeds.load(seeds_path)) == 1


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "is empty, expected a JSON file of seeds"),
        (b'{"format": "reflcolor-seeds",\n "version": }', "line 2, column 13: expected a JSON file of seeds"),
        (b"\xff\xfe\x00", "found bytes that are not text"),
        (b"[" * 100_000, "expected a JSON file of seeds"),
        (b'{"seeds": [' + b"1" * 5000 + b"]}", "expected a JSON file of seeds"),
        (b"[]", '"format": "reflcolor-seeds"'),
        (b'{"format": "reflcolor-scan"}', '"format": "reflcolor-seeds"'),
        (b'{"format": "reflcolor-seeds", "version": 2, "seeds": []}', '"version": expected 1, found 2'),
        (b'{"format": "reflcolor-seeds", "version": 1}', '"seeds": expected a list, found None'),
        (b'{"format": "reflcolor-seeds", "version": 1, "seeds": {}}', '"seeds": expected a list'),
    ],
    ids=lambda value: repr(value[:30]) if isinstance(value, bytes) else "",
)
def test_a_file_that_holds_no_seeds_is_refused_in_one_line(seeds_path, content, problem):
    seeds_path.write_bytes(content)
    with pytest.raises(SeedsError) as raised:
        Seeds.load(seeds_path)
    message = str(raised.value)
    assert message.startswith(f"{seeds_path}: ")
    assert problem in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("entry", "problem"),
    [
        (7, "expected an object with row, col and a color, found 7"),
        ({"col": 1, "rgb": [1, 2, 3]}, "row: expected a whole number, found None"),
        ({"row": 1.5, "col": 1, "rgb": [1, 2, 3]}, "row: expected a whole number, found 1.5"),
        ({"row": True, "col": 1, "rgb": [1, 2, 3]}, "row: expected a whole number, found True"),
        ({"row": 1, "col": "2", "rgb": [1, 2, 3]}, "col: expected a whole number, found '2'"),
        ({"row": 1, "col": 10**40, "rgb": [1, 2, 3]}, "col: expected a whole number, found 1000"),
        ({"row": 1, "col": 1}, "expected a color: either rgb, or photo with x and y"),
        ({"row": 1, "col": 1, "rgb": [1, 2]}, "rgb: expected three whole numbers from 0 to 255, found [1, 2]"),
        ({"row": 1, "col": 1, "rgb": [1, 2, 256]}, "rgb: expected three whole numbers from 0 to 255"),
        ({"row": 1, "col": 1, "rgb": [1.0, 2, 3]}, "rgb: expected three whole numbers from 0 to 255"),
        ({"row": 1, "col": 1, "rgb": "red"}, "rgb: expected three whole numbers from 0 to 255"),
        ({"row": 1, "col": 1, "rgb": list(range(10_000))}, "rgb: expected three whole numbers from 0 to 255"),
        ({"row": 1, "col": 1, "photo": ""}, "photo: expected a file name, found ''"),
        ({"row": 1, "col": 1, "photo": "view.png", "x": 1}, "y: expected a number, found None"),
        ({"row": 1, "col": 1, "photo": "view.png", "x": float("nan"), "y": 1}, "x: expected a number, found nan"),
        ({"row": 1, "col": 1, "photo": "gone.png", "x": 1, "y": 1}, "gone.png was not given and is not beside"),
        ({"row": 1, "col": 1, "photo": "a\0b", "x": 1, "y": 1}, "was not given and is not beside"),
        ({"row": 1, "col": 1, "photo": "view.png", "x": 7, "y": 1}, "view.png: point 7, 1 is outside the photo (6 x 4"),
        ({"row": 1, "col": 1, "photo": "view.png", "x": 1, "y": -1}, "view.png: point 1, -1 is outside the photo"),
    ],
    ids=lambda value: "" if isinstance(value, str) else str(value)[:40].replace("\0", "0"),
)
def test_a_seed_that_cannot_be_used_is_named_in_one_line(seeds_path, tmp_path, entry, problem):
    write_png(tmp_path / "view.png", PHOTO)
    write_seeds(seeds_path, {"row": 0, "col": 0, "rgb": [0, 0, 0]}, entry)
    with pytest.raises(SeedsError) as raised:
        Seeds.load(seeds_path)
    message = str(raised.value)
    assert f"{seeds_path}: seed 2: " in message
    assert problem in message
    assert "\n" not in message
    assert len(message) < 300 + len(str(tmp_path))


def test_a_photo_that_is_no_image_is_refused(seeds_path, tmp_path):
    (tmp_path / "view.png").write_text("no image", encoding="ascii")
    write_seeds(seeds_path, {"row": 1, "col": 1, "photo": "view.png", "x": 1, "y": 1})
    with pytest.raises(ImageError, match=r"view\.png"):
        Seeds.load(seeds_path)


@pytest.mark.parametrize("kind", ["missing", "directory"])
def test_a_file_that_cannot_be_opened_is_named(tmp_path, kind):
    path = tmp_path if kind == "directory" else tmp_path / "seeds.json"
    with pytest.raises(SeedsError, match=r"(no such file|is a directory), expected a JSON file of seeds"):
        Seeds.load(path)


def test_saving_where_there_is_no_folder_is_refused_and_leaves_nothing(tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        Seeds([1], [2], [[3, 4, 5]]).save(tmp_path / "gone" / "seeds.json")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (([1, 2], [1], [[0, 0, 0]] * 2), "cols has shape"),
        (([1], [1], [[0, 0]]), "rgb has shape"),
        (([1.0], [1], [[0, 0, 0]]), "rows: expected whole numbers"),
        (([1], [1], [[0, 0, 256]]), "rgb: expected 0 to 255"),
        (([1], [1], [[0, 0, 0]], ["a", "b"]), "2 photo names for 1 seeds"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(arguments, problem):
    with pytest.raises(SeedsError, match=problem):
        Seeds(*arguments)


def test_seeds_on_pixels_with_a_return_stay():
    seeds = Seeds([0, 5], [9, 0], [[1, 2, 3]] * 2)
    placed, warnings = seeds.placed_on(random_scan(shape=(6, 10)))
    assert (placed.rows.tolist(), placed.cols.tolist()) == ([0, 5], [9, 0])
    assert warnings == []


def test_a_seed_without_return_is_moved_to_the_nearest_and_that_is_said():
    valid = np.zeros((5, 8), bool)
    valid[4, 6], valid[0, 0] = True, True
    scan = scan_from_ranges(np.full((5, 8), 2.0), np.ones((5, 8)), valid)
    seeds = Seeds([0, 3], [0, 4], [[9, 9, 9], [1, 2, 3]], [None, "view.jpg"], [(np.nan, np.nan), (4, 5)])
    placed, warnings = seeds.placed_on(scan)
    assert (placed.rows.tolist(), placed.cols.tolist()) == ([0, 4], [0, 6])
    assert placed.photos == seeds.photos
    assert warnings == ["seed 2: no return at row 3, column 4; moved to row 4, column 6"]


def test_many_seeds_without_return_are_asked_after():
    valid = np.zeros((5, 8), bool)
    valid[4] = True
    scan = scan_from_ranges(np.full((5, 8), 2.0), np.ones((5, 8)), valid)
    seeds = Seeds([4, *[0] * 5], range(6), [[9, 9, 9]] * 6)
    _, warnings = seeds.placed_on(scan)
    assert warnings == [
        f"5 of 6 seeds lie where {scan.name} has no return, and were moved to the nearest pixel with one; "
        "are they of another scan?"
    ]


@pytest.mark.parametrize("pixel", [(-1, 0), (6, 0), (0, -1), (0, 10), (10**8, 0)])
def test_a_seed_outside_the_grid_is_refused(pixel):
    seeds = Seeds([0, pixel[0]], [0, pixel[1]], [[1, 2, 3]] * 2)
    with pytest.raises(SeedsError, match=r"^seed 2: row .* outside the scan's grid \(rows 0 to 5, columns 0 to 9\)$"):
        seeds.placed_on(random_scan(shape=(6, 10)))


def test_no_seeds_are_refused():
    with pytest.raises(SeedsError, match="no seeds"):
        Seeds([], [], []).placed_on(random_scan())


def test_a_scan_without_any_return_is_refused():
    with pytest.raises(SeedsError, match="no pixel has a return"):
        Seeds([0], [0], [[1, 2, 3]]).placed_on(random_scan(valid=np.zeros((6, 10), bool)))


@given(
    data=st.data(),
    shape=st.tuples(st.integers(1, 7), st.integers(1, 13)),
    share=st.sampled_from([0.02, 0.1, 0.6]),
    full_turn=st.booleans(),
)
def test_the_nearest_pixel_with_a_return_is_found_around_a_full_turn_too(data, shape, share, full_turn):
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    valid = rng.random(shape) < share
    valid[data.draw(st.integers(0, shape[0] - 1)), data.draw(st.integers(0, shape[1] - 1))] = True
    row, col = data.draw(st.integers(0, shape[0] - 1)), data.draw(st.integers(0, shape[1] - 1))
    rows, cols = np.nonzero(valid)
    across = np.abs(cols - col)
    if full_turn:
        across = np.minimum(across, shape[1] - across)
    squared = (rows - row) ** 2 + across**2
    assert nearest_valid(valid, row, col, wrap=full_turn) == (rows[squared.argmin()], cols[squared.argmin()])


@pytest.mark.parametrize(
    ("x", "y", "pixel"), [(0, 0, (0, 0)), (0.99, 0.99, (0, 0)), (1, 1, (1, 1)), (5.5, 3.5, (3, 5)), (6, 4, (3, 5))]
)
def test_the_point_of_a_photo_means_the_pixel_that_contains_it(x, y, pixel):
    assert (sample_photo(PHOTO, x, y) == PHOTO[pixel]).all()
