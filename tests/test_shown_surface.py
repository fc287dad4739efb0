"""What is added to a scan's surface to look at: holes, outlines, mixed returns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_scans import scan_from_ranges

from reflcolor_addon import Cancelled, Scan
from reflcolor_addon.scan.grid_mesh import grid_mesh
from reflcolor_addon.view.mixed_pixels import mixed_pixels
from reflcolor_addon.view.outlines import outline_shares
from reflcolor_addon.view.shown_surface import shown_surface

SHAPE = (24, 36)


def wall(distance=5.0, shape=SHAPE, step=0.01):
    """(H, W, 3) points of a wall across the view, as a camera's pixels see it."""
    right, up = np.meshgrid((np.arange(shape[1]) - shape[1] / 2) * step, (shape[0] / 2 - np.arange(shape[0])) * step)
    return distance * np.stack([right, np.ones(shape), up], axis=-1)


def scan_of(points, valid=None):
    shape = points.shape[:2]
    valid = np.ones(shape, bool) if valid is None else valid
    return Scan(name="wall", points=points, reflectance=np.zeros(shape), valid=valid)


def squares_covered(surface, scan):
    """How many squares of four pixels the added faces cover, as seen from the scanner."""
    height, width = scan.shape
    places = surface.uv.astype(float) * [width, -height]
    first = np.cumsum(surface.sizes) - surface.sizes
    area = 0.0
    for start, size in zip(first, surface.sizes, strict=True):
        x, y = places[start : start + size].T
        # Rows run down, so counterclockwise as seen is a negative area here.
        area -= 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
    return area


def test_small_holes_are_filled_as_the_wall_goes_on():
    valid = np.ones(SHAPE, bool)
    valid[5, 7] = valid[10:14, 20:25] = valid[12, 3] = False
    scan = scan_of(wall(), valid)
    surface = shown_surface(scan)
    np.testing.assert_allclose(surface.points[:, 1], 5.0, rtol=1e-3)
    filled = len(grid_mesh(scan_of(wall())).quads) - len(grid_mesh(scan).quads)
    assert squares_covered(surface, scan) == pytest.approx(filled, abs=1e-3)
    assert scan.valid.ravel()[surface.source].all()


def test_large_holes_and_those_at_the_edge_stay():
    valid = np.ones(SHAPE, bool)
    valid[4:16, 4:16] = valid[0, 20] = False
    scan = scan_of(wall(), valid)
    whole = len(grid_mesh(scan_of(wall())).quads)
    left = whole - len(grid_mesh(scan).quads) - squares_covered(shown_surface(scan), scan)
    # Outlines reach about half a pixel into them.
    assert 11 * 11 < left < 13 * 13


@settings(max_examples=25)
@given(angle=st.floats(0, np.pi), offset=st.floats(-3, 3))
def test_where_one_wall_stands_before_another_no_gap_is_left_between_them(angle, offset):
    rows, cols = np.indices(SHAPE) - np.array(SHAPE)[:, None, None] / 2
    before = (np.cos(angle) * cols + np.sin(angle) * rows) > offset
    scan = scan_of(np.where(before[..., None], wall(2.0), wall(5.0)))
    surface = shown_surface(scan)
    squares = (SHAPE[0] - 1) * (SHAPE[1] - 1)
    assert squares_covered(surface, scan) + len(grid_mesh(scan).quads) == pytest.approx(squares, abs=0.02 * squares)
    # Each face is on one of the walls. At the image's border nothing shows how a wall goes on: the range stays.
    near = np.abs(surface.points[:, 1:2] - [2.0, 5.0]).min(axis=1)
    row, col = np.divmod(surface.source, SHAPE[1])
    border = (row == 0) | (row == SHAPE[0] - 1) | (col == 0) | (col == SHAPE[1] - 1)
    assert near[~border].max() < 5e-3
    steps = [np.abs(np.diff(np.linalg.norm(wall(5.0), axis=-1), axis=axis)).max() for axis in (0, 1)]
    assert near[border].max() < max(steps)


@pytest.mark.parametrize("slope", [0.13, 0.37, 0.8])
def test_an_outline_is_nearer_to_the_true_one_than_the_steps_of_the_grid(slope):
    shape = (60, 80)
    rows, cols = np.indices(shape)
    line = 20 + slope * rows[:, 0]
    surface = np.where(cols > line[:, None], 1, 0)
    edge_rows = np.arange(8, 52)
    edge_cols = np.array([np.flatnonzero(surface[row])[0] for row in edge_rows])
    shares = outline_shares(surface, edge_rows * shape[1] + edge_cols, np.full(len(edge_rows), 2))
    smooth, stepped = edge_cols - shares - line[edge_rows], edge_cols - 0.5 - line[edge_rows]
    assert np.sqrt((smooth**2).mean()) < 0.35 * np.sqrt((stepped**2).mean())


def test_measured_points_stay_where_they_are():
    valid = np.random.default_rng(3).random(SHAPE) > 0.05
    scan = scan_of(wall() * np.random.default_rng(4).uniform(0.99, 1.01, (*SHAPE, 1)), valid)
    surface = shown_surface(scan)
    exact = (surface.points[:, None] == scan.points[scan.valid]).all(axis=-1).any(axis=1)
    # Corners of the added faces that are measured are exactly those, and nothing else is near them.
    own = np.linalg.norm(surface.points - scan.points.reshape(-1, 3)[surface.source], axis=1) < 1e-9
    assert exact.sum() > 50 and (exact == own).all()


def test_a_return_between_two_walls_is_mixed():
    cols = np.indices(SHAPE)[1]
    points = np.where((cols < 18)[..., None], wall(2.0), wall(5.0))
    points[:, 18] = wall(3.1)[:, 18]
    mixed = mixed_pixels(scan_of(points))
    assert mixed[:, 18].all() and mixed.sum() == SHAPE[0]
    surface = shown_surface(scan_of(points))
    assert (surface.mixed == mixed).all() and not np.isclose(surface.points[:, 1], 3.1).any()
    assert not shown_surface(scan_of(points), drop_mixed=False).mixed.any()


def test_a_floor_that_runs_far_away_holds_no_mixed_returns():
    down = np.radians(np.linspace(-40, -0.8, 80))
    ranges = 1.5 / np.sin(-down)[:, None] * np.ones((80, 40))
    scan = scan_from_ranges(ranges, np.zeros((80, 40)), azimuth_deg=40, elevation_deg=39.2)
    points = scan.range[..., None] * np.stack(
        [np.cos(down)[:, None] * np.sin(a := np.radians(np.linspace(-20, 20, 40))), np.cos(down)[:, None] * np.cos(a),
         np.sin(down)[:, None] * np.ones(40)], axis=-1,
    )  # fmt: skip
    assert not mixed_pixels(scan_of(points)).any()


def test_a_full_turn_goes_on_across_its_seam():
    ranges = np.full((10, 72), 4.0)
    scan = scan_from_ranges(ranges, np.zeros(ranges.shape), azimuth_deg=360)
    valid = scan.valid.copy()
    valid[4:6, 71] = False
    scan = Scan(name="tower", points=scan.points, reflectance=scan.reflectance, valid=valid)
    assert scan.full_turn
    surface = shown_surface(scan)
    np.testing.assert_allclose(np.linalg.norm(surface.points, axis=1), 4.0, rtol=1e-3)
    assert surface.uv[:, 0].max() > 1 - 0.5 / 72


@pytest.mark.parametrize("valid", [np.zeros(SHAPE, bool), np.eye(*SHAPE, dtype=bool)])
def test_scans_with_nothing_or_next_to_nothing_to_show(valid):
    surface = shown_surface(scan_of(wall(), valid))
    assert np.isfinite(surface.points).all() and len(surface.corners) == surface.sizes.sum()


def test_it_can_be_cancelled():
    with pytest.raises(Cancelled):
        shown_surface(scan_of(wall()), cancelled=lambda: True)
