"""Which way up a grid is, read from its points, and how a person overrules it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_scans import intensity_of, room_points

from reflcolor_addon.scan.orientation import Flips, flipped, infer_flips
from reflcolor_addon.scan.scan import Scan

TURNS = {(v, h): (slice(None, None, -1 if v else 1), slice(None, None, -1 if h else 1)) for v in (0, 1) for h in (0, 1)}


def needed(points, valid=None):
    return infer_flips(points, np.ones(points.shape[:2], bool) if valid is None else valid)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(
    "points",
    [
        room_points(),
        room_points(2, 2),
        room_points(90, 180, step_deg=(1.0, 2.0), top_deg=44.0, left_deg=170.0),
        room_points(700, 900, step_deg=(0.1, 0.4), top_deg=40.0),
        room_points(40, 30, step_deg=(1.0, 1.0), top_deg=89.0),
        room_points(12, 12, step_deg=(0.01, 0.01), top_deg=-20.0),
    ],
)
def test_the_flips_that_a_stored_order_needs_are_found(points, turn):
    assert needed(points[TURNS[turn]]) == Flips(bool(turn[0]), bool(turn[1]), True)


@given(seed=st.integers(0, 2**32), share=st.floats(0.3, 1), turn=st.sampled_from(sorted(TURNS)))
def test_holes_and_noise_do_not_mislead(seed, share, turn):
    rng = np.random.default_rng(seed)
    points = room_points(60, 80, step_deg=(0.5, 0.7)) * rng.uniform(0.5, 2, (60, 80, 1))
    points += rng.normal(0, 0.01, points.shape)
    valid = rng.random((60, 80)) < share
    points[~valid] = rng.normal(size=3)
    assert needed(points[TURNS[turn]], valid[TURNS[turn]]) == Flips(bool(turn[0]), bool(turn[1]), True)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_single_row_still_tells_left_from_right(mirrored):
    row = room_points(1, 30)
    assert needed(row[:, ::-1] if mirrored else row).horizontal == mirrored


@pytest.mark.parametrize("upside_down", [False, True])
def test_a_single_column_still_tells_up_from_down(upside_down):
    column = room_points(30, 1)
    assert needed(column[::-1] if upside_down else column) == Flips(upside_down, False, True)


def test_a_scanner_that_looks_along_its_z_axis_is_unmirrored_but_uncertain():
    right, down = np.meshgrid(np.linspace(-0.5, 0.5, 20), np.linspace(-0.5, 0.5, 20))
    ahead = np.stack([right, down, np.ones_like(right)], axis=-1)
    assert needed(ahead) == Flips(False, False, False)
    assert needed(ahead[:, ::-1]) == Flips(True, False, False)


def test_points_that_tell_nothing_stay_as_stored():
    assert needed(np.ones((5, 5, 3))) == Flips(False, False, False)
    assert needed(np.zeros((5, 5, 3)), np.zeros((5, 5), bool)) == Flips(False, False, False)


@pytest.mark.parametrize("turn", TURNS)
def test_a_person_may_flip_a_scan(turn):
    points = room_points()
    color = np.random.default_rng(0).integers(0, 256, points.shape, np.uint8)
    valid = intensity_of(points) > 0.1
    pose = np.diag([1.0, -1, -1, 1])
    scan = Scan(name="a", points=points, reflectance=intensity_of(points), valid=valid, color=color, pose=pose)
    other = flipped(scan, vertical=bool(turn[0]), horizontal=bool(turn[1]))
    for key in ("points", "reflectance", "valid", "color", "range"):
        assert np.array_equal(getattr(other, key), getattr(scan, key)[TURNS[turn]])
    assert np.array_equal(other.pose, pose)
    assert flipped(other, vertical=bool(turn[0]), horizontal=bool(turn[1])).points == pytest.approx(scan.points)


def test_a_scan_without_color_may_be_flipped():
    points = room_points()
    scan = Scan(name="a", points=points, reflectance=intensity_of(points), valid=points[..., 0] > 0)
    assert flipped(scan, vertical=True).color is None
