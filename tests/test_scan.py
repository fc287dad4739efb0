"""A scan is checked when made, and knows its own angles."""

import numpy as np
import pytest
from sample_scans import intensity_of, room_points

from reflcolor_addon.errors import ScanError
from reflcolor_addon.scan.scan import Scan


def scan_of(points, /, valid=None, **changes):
    valid = np.ones(points.shape[:2], bool) if valid is None else valid
    fields = {"name": "yard", "points": points, "reflectance": intensity_of(points), "valid": valid, **changes}
    return Scan(**fields)


def panorama(width=1024, height=32, *, turn_deg=360.0, noise=0.0, seed=0):
    """What a spinning lidar gives: equal steps of azimuth over `turn_deg`."""
    rng = np.random.default_rng(seed)
    points = room_points(height, width, step_deg=(1.4, turn_deg / width), top_deg=22.5, left_deg=13.0)
    return points * rng.uniform(0.3, 3, (height, width, 1)) + rng.normal(0, noise, points.shape)


def test_the_range_is_the_distance_and_zero_without_a_return():
    points = room_points()
    valid = intensity_of(points) > 0.5
    scan = scan_of(points, valid)
    assert scan.range[valid] == pytest.approx(np.linalg.norm(points, axis=-1)[valid])
    assert not scan.range[~valid].any()
    assert not scan.points[~valid].any()


def test_steps_are_measured_in_both_directions():
    assert scan_of(room_points(60, 40, step_deg=(0.0676, 0.25))).step_deg == pytest.approx((0.0676, 0.25))


def test_steps_are_unknown_where_nothing_is_measured():
    points = room_points(1, 1)
    assert np.isnan(scan_of(points).step_deg).all()


@pytest.mark.parametrize("width", [8, 12, 90, 1024])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_a_full_turn_is_recognized(width, noise):
    assert scan_of(panorama(width, noise=noise)).full_turn


def test_a_full_turn_may_have_holes_and_empty_columns():
    rng = np.random.default_rng(5)
    points = panorama()
    valid = rng.random(points.shape[:2]) < 0.4
    valid[:, 500:620] = valid[:, :3] = valid[:, -2:] = False
    assert scan_of(points, valid).full_turn


@pytest.mark.parametrize("extra", [0, 1])
def test_a_full_turn_may_repeat_its_first_column(extra):
    assert scan_of(panorama(360 + extra, turn_deg=360.0 + extra)).full_turn


@pytest.mark.parametrize("turn_deg", [30.0, 180.0, 350.0, 357.0])
def test_less_than_a_turn_is_no_full_turn(turn_deg):
    assert not scan_of(panorama(turn_deg=turn_deg)).full_turn


def test_a_mirrored_order_of_columns_is_a_full_turn_too():
    assert scan_of(panorama()[:, ::-1]).full_turn


def test_real_spinning_lidars_cover_a_full_turn(data_dir):
    for path in sorted((data_dir / "ouster").glob("*.npz")):
        with np.load(path) as file:
            distance = file["range"].astype(np.float64) / 1000
        rays = room_points(*distance.shape, step_deg=(45 / 128, 360 / 1024), top_deg=22.5, left_deg=180)
        rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
        scan = scan_of(rays * distance[..., None], distance > 0)
        assert scan.full_turn
        assert scan.step_deg == pytest.approx((45 / 128, 360 / 1024), rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"valid": np.ones((9, 0), bool)}, "yard: a scan is a grid of rows x columns, found shape (9, 0)"),
        ({"valid": np.ones(9, bool)}, "found shape (9,)"),
        ({"points": np.zeros((9, 14, 2))}, "yard: points has shape (9, 14, 2), expected (9, 14, 3)"),
        ({"reflectance": np.zeros((9, 13))}, "reflectance has shape (9, 13)"),
        ({"color": np.zeros((9, 14, 3))}, "color must be uint8, found float64"),
        ({"pose": np.eye(3)}, "pose has shape (3, 3)"),
        ({"pose": np.full((4, 4), np.nan)}, "the pose holds a number that is not finite"),
        ({"points": np.full((9, 14, 3), np.inf)}, "a valid pixel has a point that is not finite"),
        ({"reflectance": np.full((9, 14), np.nan)}, "a valid pixel has a reflectance that is not finite"),
    ],
)
def test_what_does_not_fit_together_is_refused(changes, said):
    with pytest.raises(ScanError) as caught:
        scan_of(room_points(), **changes)
    assert said in str(caught.value)


@pytest.mark.parametrize(("step_deg", "aspect"), [((0.5, 0.5), 1.0), ((0.5, 2.0), 4.0), ((0.5, 0.125), 0.25)])
def test_a_pixel_is_as_wide_for_its_height_as_its_angles_are(step_deg, aspect):
    scan = scan_of(room_points(30, 40, step_deg=step_deg, top_deg=8, left_deg=13.0))
    assert scan.pixel_aspect == pytest.approx(aspect, rel=0.02)
