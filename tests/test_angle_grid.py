"""A grid laid over points by angle."""

import numpy as np
import pytest

from reflcolor_addon.errors import ScanError
from reflcolor_addon.scan.angle_grid import grid_by_angle


def test_angles_that_differ_by_next_to_nothing_do_not_hang():
    # The product of their spans is too small for a float.
    spread = np.random.default_rng(0).random((48, 2)) * 1e-178
    grid = grid_by_angle(np.column_stack([np.ones(48), spread]))
    assert 4 <= grid.shape[0] * grid.shape[1] <= 48 * 16


def test_points_in_next_to_one_line_through_the_scanner_have_no_grid():
    noise = 1e-7 * np.random.default_rng(0).normal(size=(400, 2))
    along = np.repeat([1.0, 1.0, 1.0, -1.0], 100)
    with pytest.raises(ScanError, match="more than 65,536 rows or columns"):
        grid_by_angle(np.column_stack([along, noise]))


def test_a_step_that_would_leave_the_grid_all_but_empty_is_refused():
    points = np.random.default_rng(0).normal(size=(50, 3))
    with pytest.raises(ScanError, match="pixels for 50 points; check the scanner's position, and the step"):
        grid_by_angle(points, step_deg=0.02)
