"""A grid laid over points by angle."""

import numpy as np

from reflcolor_addon.scan.angle_grid import grid_by_angle


def test_angles_that_differ_by_next_to_nothing_do_not_hang():
    # The product of their spans is too small for a float.
    spread = np.random.default_rng(0).random((48, 2)) * 1e-178
    grid = grid_by_angle(np.column_stack([np.ones(48), spread]))
    assert 4 <= grid.shape[0] * grid.shape[1] <= 48 * 16
