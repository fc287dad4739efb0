"""The real scans with a truth import upright, at the right scale, with their poses."""

import numpy as np
import pytest

from benchmarks.real_scans import NAMES, has_truth, load
from reflcolor_addon.scan.orientation import infer_turn


@pytest.fixture(scope="module")
def scans(data_dir):
    return {name: load(name, data_dir) for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_a_real_scan_is_upright_and_colored_and_warns_of_nothing(scans, name):
    scan = scans[name]
    assert infer_turn(scan.points, scan.valid) == (False, False, False, True)
    assert has_truth(scan).mean() > 0.4
    assert scan.warnings == ()
    assert not scan.full_turn


@pytest.mark.parametrize(
    ("name", "shape", "share", "step_deg", "nearest", "farthest"),
    [
        ("pumpA", (1074, 345), 0.419, (0.0675, 0.25), 1.984, 5.429),
        ("doria", (91, 199), 0.947, (0.148, 0.146), 10.58, 22.28),
        ("bildstein_25", (360, 360), 0.553, (0.16, 0.17), 3.6, 82),
        ("k4a", (576, 640), 0.765, (0.11, 0.115), 0.19, 4.0),
    ],
)
def test_sizes_steps_and_ranges_are_those_of_the_place(scans, name, shape, share, step_deg, nearest, farthest):
    scan = scans[name]
    assert scan.shape == shape
    assert scan.valid.mean() == pytest.approx(share, abs=1e-3)
    assert scan.step_deg == pytest.approx(step_deg, rel=0.03)
    assert scan.range[scan.valid].min() == pytest.approx(nearest, rel=0.03)
    assert scan.range.max() == pytest.approx(farthest, rel=0.03)


def test_the_points_lie_within_the_bounds_that_the_file_states(scans):
    points = scans["pumpA"].points[scans["pumpA"].valid]
    assert points.min(axis=0) == pytest.approx([-2.903764, -5.301103, -1.899705], abs=2e-6)
    assert points.max(axis=0) == pytest.approx([1.721604, -0.792647, 1.843003], abs=2e-6)
    assert np.array_equal(scans["pumpA"].pose, np.eye(4))


def test_raw_intensities_are_kept(scans):
    for name, low, high in (("pumpA", 0.3838, 0.6984), ("doria", 0.3835, 0.6869), ("k4a", 23, 15678)):
        seen = scans[name].reflectance[scans[name].valid]
        assert (seen.min(), seen.max()) == pytest.approx((low, high), rel=1e-3)


def test_neighboring_views_of_one_station_meet_in_the_world(scans):
    """The lawn of one view, seen in the world, lies on the lawn of the next."""
    for first, second in (("bildstein_05", "bildstein_10"), ("bildstein_20", "bildstein_25")):
        clouds = []
        for name in (first, second):
            scan = scans[name]
            near = scan.valid & (scan.range < 8)
            clouds.append(scan.points[near] @ scan.pose[:3, :3].T + scan.pose[:3, 3])
        cells = [
            {tuple(cell): z for cell, z in zip(np.floor(c[:, :2] * 4).astype(int), c[:, 2], strict=True)}
            for c in clouds
        ]
        both = cells[0].keys() & cells[1].keys()
        assert len(both) > 40
        assert np.median([abs(cells[0][cell] - cells[1][cell]) for cell in both]) < 0.05


def test_a_flat_wall_of_the_depth_camera_is_flat(scans):
    part = np.s_[100:400, :100]
    wall = scans["k4a"].points[part][scans["k4a"].valid[part]]
    deviation = np.linalg.svd(wall - wall.mean(axis=0), full_matrices=False)[1][2] / np.sqrt(len(wall))
    assert deviation < 0.001
