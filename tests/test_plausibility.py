"""One gate for the numbers of every reader: what no scanner can have measured does not get in."""

import json

import numpy as np
import pytest
from sample_scans import intensity_of, ptx_text, room_points
from small_scans import random_scan

from reflcolor_addon import Scan, ScanError, colorize
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.writers import write_image_pair
from reflcolor_addon.messages import LONGEST_LINE
from reflcolor_addon.scan.limits import FARTHEST_M, LONGEST_NAME, MOST_PIXELS
from reflcolor_addon.seeds.seeds import Seeds

POINTS = room_points()


def pose(**changes):
    made = np.eye(4)
    for place, value in changes.items():
        made[tuple(map(int, place.removeprefix("at")))] = value
    return made


def scan(**changes):
    arrays = {"points": np.ones((2, 3, 3)), "reflectance": np.ones((2, 3)), "valid": np.ones((2, 3), bool)}
    return Scan(**{"name": "wall", **arrays, **changes})


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"points": np.full((2, 3, 3), 2e9)}, r"^wall: a valid pixel has a point of 2e\+09, expected at most 1e\+09$"),
        ({"reflectance": np.full((2, 3), 1e35)}, "a reflectance of 1e"),
        ({"pose": pose(at03=1e299)}, "the pose is not that of a scanner"),
        ({"pose": pose(at00=1e9)}, "the pose is not that of a scanner"),
        ({"pose": pose(at00=0.0)}, "the pose is not that of a scanner"),
        ({"pose": pose(at33=2.0)}, "the pose is not that of a scanner"),
        ({"pose": pose(at00=np.nan)}, "not finite"),
        (
            {"valid": np.broadcast_to(True, (MOST_PIXELS, 2))},
            r"500,000,000 rows x 2 columns, expected at most 500,000,000",
        ),
    ],
)
def test_a_scan_beyond_all_reason_is_refused(changes, said):
    with pytest.raises(ScanError, match=said):
        scan(**changes)


def test_what_is_just_within_reason_can_be_worked_with():
    far = scan(points=np.random.default_rng(0).uniform(0.5, 1, (2, 3, 3)) * FARTHEST_M, pose=pose(at03=-FARTHEST_M))
    assert np.isfinite(far.range).all()
    assert colorize(far, Seeds([0], [0], [[9, 8, 7]])).rgb.shape == (2, 3, 3)


def test_names_and_warnings_are_one_line_of_bounded_length():
    made = scan(name="two\nlines\x1b[2J" + "x" * 10_000, warnings=("w\n" * 10_000,))
    assert len(made.name) <= LONGEST_NAME and made.name.startswith(r"two\nlines\x1b[2J") and made.name.isprintable()
    assert len(made.warnings[0]) <= LONGEST_LINE and made.warnings[0].isprintable()


@pytest.mark.parametrize("value", ["1e20", "-3e9", "1e-200", "nan", "1e400"])
def test_points_of_a_file_beyond_all_reason_are_no_returns(tmp_path, value):
    path = tmp_path / "a.ptx"
    lines = ptx_text(POINTS, intensity_of(POINTS)).splitlines()
    lines[10] = f"{value} {value} {value} 0.5"
    path.write_text("\n".join(lines))
    (found,) = read_scans(path)
    assert np.count_nonzero(~found.valid) == 1
    assert "1 points hold a number that is not finite, far too large or far too small" in found.warnings[0]


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("fx", 1e-300),
        ("fx", 1e30),
        ("cy", 1e12),
        ("distortion", [1e9, 0, 0, 0]),
        ("model", {"type": "spherical", "azimuth_deg": [0, 1e-300], "elevation_deg": [-1, 1]}),
        ("model", {"type": "spherical", "azimuth_deg": [0, 90], "elevation_deg": [0, 0]}),
        ("pose", [[1, 0, 0, 1e299], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
        ("pose", [[1e-9, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
        ("range_scale", 1e-300),
        ("range_scale", 1e99),
        ("range_offset", 1e99),
    ],
)
def test_a_description_beyond_all_reason_is_refused_by_its_key(tmp_path, key, value):
    path = tmp_path / "a.scan.json"
    write_image_pair(random_scan(shape=(6, 10)), path)
    content = json.loads(path.read_text())
    model = {"type": "pinhole", "fx": 9, "fy": 9, "cx": 4.5, "cy": 2.5}
    content |= {"model": {**model, key: value}} if key in (*model, "distortion") else {"model": model, key: value}
    path.write_text(json.dumps(content))
    with pytest.raises(ScanError, match=rf"^a\.scan\.json: (model\.)?{key}(\.\w+)?: expected ") as caught:
        read_scans(path)
    assert len(str(caught.value)) < 300


def test_what_a_file_holds_is_quoted_in_one_line_of_bounded_length(tmp_path):
    path = tmp_path / "a.scan.json"
    write_image_pair(random_scan(shape=(6, 10)), path)
    content = json.loads(path.read_text())
    for change in (
        {"range": "a\n" * 10_000},
        {"name": 7 * ["x" * 10_000]},
        {"key\n" * 10_000: 1},
        {"pose": [[9] * 9999]},
    ):
        path.write_text(json.dumps(content | change))
        with pytest.raises(ScanError) as caught:
            read_scans(path)
        assert len(str(caught.value)) < 1000
        assert str(caught.value).isprintable()


def test_many_scans_that_are_left_out_are_counted(tmp_path):
    path = tmp_path / "a.ptx"
    good = ptx_text(POINTS, intensity_of(POINTS))
    path.write_text(good + ptx_text(np.zeros((1, 1, 3)), np.zeros((1, 1))) * 1000)
    (found,) = read_scans(path)
    assert len(found.warnings) == 6
    assert found.warnings[-1] == "left out: 995 more scans, for similar reasons"


def test_a_ptx_of_many_scans_can_be_cancelled_between_any_two(tmp_path):
    path = tmp_path / "a.ptx"
    path.write_text(ptx_text(np.ones((1, 1, 3)), np.ones((1, 1))) * 50)
    asked = []
    assert len(read_scans(path, cancelled=lambda: asked.append(1))) == 50
    assert len(asked) >= 100
