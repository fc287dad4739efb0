"""Where a camera stands that shows a scan."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_scans import scan_from_ranges

from benchmarks import real_scans
from reflcolor_addon.view.framing import camera_in_region, frame, frame_in_region, in_world

SCANNER = np.array([20.0, -5.0, 1.5])
ASPECT = 1.6


def seen_from(view, points):
    """(N, 2) places in the picture, right and up from its middle, in halves of its wider side; NaN behind a camera."""
    forward = (view.target - view.position) / np.linalg.norm(view.target - view.position)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    offsets = points - view.position
    depth = offsets @ forward
    across = np.stack([offsets @ right, offsets @ np.cross(right, forward)], axis=1)
    return across / np.where(depth > 0, depth, np.nan)[:, None] / np.tan(np.radians(view.fov_deg) / 2)


def nearly_all_inside(seen, right, up, left=None):
    """Whether the places, but for one at each side or 3 in 1000, are in a picture of these half lengths.

    ``left`` is its left edge, where that is another than ``-right``.
    """
    inside = (seen[:, 0] <= right) & (seen[:, 0] >= (-right if left is None else left)) & (abs(seen[:, 1]) <= up)
    return np.count_nonzero(~inside) <= max(4, 0.003 * len(seen))


def extent(seen):
    """(width, height) of what all but two in a thousand places take."""
    return np.nanpercentile(seen, 99.9, axis=0) - np.nanpercentile(seen, 0.1, axis=0)


@st.composite
def scanned_points(draw, widest_deg=180, highest_deg=100):
    """World points of a scan, up to so wide and high, of things near and far, in any direction."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    near, far = draw(st.floats(0.2, 20)), draw(st.floats(1.5, 20))
    shape = draw(st.tuples(st.integers(20, 60), st.integers(20, 90)))
    ranges = near * rng.choice([1.0, 1.2, far], (4, 4)).repeat(-(-shape[0] // 4), 0).repeat(-(-shape[1] // 4), 1)
    scan = scan_from_ranges(
        ranges[: shape[0], : shape[1]] * rng.uniform(0.98, 1.02, shape),
        np.zeros(shape),
        azimuth_deg=draw(st.floats(10, widest_deg)),
        elevation_deg=draw(st.floats(5, highest_deg)),
    )
    heading = draw(st.floats(0, 2 * np.pi))
    turn = np.array([[np.cos(heading), -np.sin(heading), 0], [np.sin(heading), np.cos(heading), 0], [0, 0, 1]])
    return scan.points[scan.valid] @ turn.T + SCANNER


@settings(max_examples=40)
@given(points=scanned_points(), aspect=st.floats(0.5, 2))
def test_nearly_all_points_are_in_the_picture_and_fill_it(points, aspect):
    seen = seen_from(frame(points, SCANNER, aspect=aspect), points)
    half = np.array([1, 1 / aspect]) if aspect >= 1 else np.array([aspect, 1])
    assert nearly_all_inside(seen, *half)
    assert (extent(seen) / (2 * half)).max() > 0.9


@settings(max_examples=40)
@given(points=scanned_points(), size=st.tuples(st.integers(200, 2000), st.integers(200, 2000)), data=st.data())
def test_nearly_all_points_are_between_the_bars_of_a_region_and_fill_it(points, size, data):
    right = data.draw(st.integers(0, size[0] - 100))
    left = data.draw(st.integers(0, size[0] - 100 - right))
    focal_mm = data.draw(st.floats(20, 100))
    view = frame_in_region(points, SCANNER, size=size, covered=(left, right), focal_mm=focal_mm)
    seen = seen_from(view, points)
    width, height, left, right = np.array([*size, left, right]) / max(size)
    assert nearly_all_inside(seen, width - 2 * right, height, left=2 * left - width)
    assert (extent(seen) / [2 * (width - left - right), 2 * height]).max() > 0.9


def test_what_is_very_far_is_shown_too():
    ranges = np.full((20, 20), 3.0)
    ranges[:5] = 300.0
    points = scan_from_ranges(ranges, np.zeros(ranges.shape)).points.reshape(-1, 3)
    view = frame(points, np.zeros(3), aspect=ASPECT)
    distance = np.linalg.norm(points - view.position, axis=1)
    assert view.clip[0] < distance.min() and distance.max() < view.clip[1]


@settings(max_examples=40)
@given(points=scanned_points(widest_deg=55, highest_deg=50))
def test_a_narrow_scan_is_seen_from_the_scanners_place_in_its_own_shape(points):
    view = frame(points, SCANNER)
    np.testing.assert_array_equal(view.position, SCANNER)
    width, height = extent(seen_from(view, points))
    assert 0.85 * view.aspect < width / height < 1.2 * view.aspect or view.aspect in (0.5, 2.4)


@settings(max_examples=40)
@given(points=scanned_points(widest_deg=120), seed=st.integers(0, 1000))
def test_a_few_stray_points_do_not_shrink_the_others(points, seed):
    points = np.tile(points, (-(-15_000 // len(points)), 1))
    stray = SCANNER + np.random.default_rng(seed).normal(0, 500, (4, 3))
    seen = seen_from(frame(np.concatenate([points, stray]), SCANNER, aspect=ASPECT), points)
    assert nearly_all_inside(seen, 1, 1 / ASPECT)
    assert (extent(seen) / [2, 2 / ASPECT]).max() > 0.85


def test_a_near_thing_before_a_wall_is_about_as_large_as_in_the_scan():
    ranges = np.full((130, 130), 2.5)
    ranges[90:120, 50:80] = 0.25
    scan = scan_from_ranges(ranges, np.zeros(ranges.shape), azimuth_deg=65, elevation_deg=65)
    seen = seen_from(frame(scan.points[scan.valid], np.zeros(3), aspect=ASPECT), scan.points[scan.valid])
    thing = (ranges < 1)[scan.valid]
    assert (extent(seen[thing]) / extent(seen)).min() > 0.5 * 30 / 130
    assert abs(np.median(seen[thing], axis=0)[0]) < 0.15


def test_the_mug_of_a_real_scan_is_large_in_its_picture(data_dir):
    scan = real_scans.load("k4a", data_dir)
    points = scan.points[scan.valid]
    seen = seen_from(frame(points, np.zeros(3), aspect=ASPECT), points)
    mug = (scan.range < 0.6)[scan.valid]
    assert extent(seen[mug])[1] > 0.3 * 2 / ASPECT
    assert (extent(seen) / [2, 2 / ASPECT]).max() > 0.9


@settings(max_examples=40)
@given(seed=st.integers(0, 1000), aspect=st.floats(0.5, 2))
def test_a_scan_all_around_is_seen_from_outside_and_above(seed, aspect):
    ranges = np.random.default_rng(seed).uniform(2, 6, (30, 90))
    scan = scan_from_ranges(ranges, np.zeros(ranges.shape), azimuth_deg=360, elevation_deg=80)
    points = scan.points[scan.valid] + SCANNER
    view = frame(points, SCANNER, aspect=aspect)
    assert view.position[2] > points[:, 2].max()
    assert np.hypot(*(view.position - SCANNER)[:2]) > 6
    half = np.array([1, 1 / aspect]) if aspect >= 1 else np.array([aspect, 1])
    assert nearly_all_inside(seen_from(view, points), *half)


@pytest.mark.parametrize("count", [1, 2])
def test_a_scan_of_hardly_a_point_has_a_view_too(count):
    points = SCANNER + np.array([[3.0, 1, 0], [3, 1, 0.1]])[:count]
    views = [
        frame(points, SCANNER, aspect=ASPECT),
        frame_in_region(points, SCANNER, size=(800, 600), covered=(40, 200), focal_mm=50),
    ]
    for view in views:
        assert np.isfinite([*view.position, *view.target, view.fov_deg]).all() and view.distance > 0.05


def test_points_are_brought_to_the_world_in_doubles():
    matrix = np.array([[0, -2, 0, 5e6], [2, 0, 0, -1], [0, 0, 2, 0.25], [0, 0, 0, 1]])
    points = in_world(np.array([[1, 2, 3], [0.5, 0, 0]], np.float32), matrix)
    np.testing.assert_array_equal(points, [[4_999_996, 1, 6.25], [5_000_000, 0, 0.25]])


@pytest.mark.parametrize("size", [(1000, 700), (600, 900), (1700, 400)])
@pytest.mark.parametrize("covered", [(0, 0), (0, 220), (60, 220)])
@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.2])
def test_a_cameras_picture_is_between_toolbar_and_sidebar(size, covered, aspect):
    """With Blender's own formulas, as its documentation has them, for where the frame of a camera is in a region."""
    zoom, (x, y) = camera_in_region(size, covered, aspect)
    magnified = (zoom / 50 + np.sqrt(2)) ** 2 / 4
    longer = magnified * max(size)
    width, height = (longer, longer / aspect) if aspect >= 1 else (longer * aspect, longer)
    center = size[0] / 2 - 2 * x * magnified * size[0]
    left, right = covered
    assert center - width / 2 >= left and center + width / 2 <= size[0] - right and height <= size[1] and y == 0
    # And as large as it can be, but for what headers cover.
    assert max(width / (size[0] - left - right), height / size[1]) == pytest.approx(0.88)
