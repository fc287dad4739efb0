"""Returns of a beam that met two surfaces: they float between them, where nothing is."""

import numpy as np

from ..scan.grid_mesh import MAX_INCIDENCE_DEG, is_jump

# A mixed return is at least this share of the jump away from either surface.
_LEAST_SHARE = 0.12
# Rows down and columns to the right: the four ways that a border between two surfaces can run.
_WAYS = ((0, 1), (1, 0), (1, 1), (1, -1))


def mixed_pixels(scan, max_incidence_deg=MAX_INCIDENCE_DEG):
    """Return which pixels lie between two surfaces, and on neither.

    A pixel is mixed if, along a row, a column or a diagonal, there is a jump from the pixel before it to the one behind
    it, and it lies between them, on the continuation of neither side. The floor far away, which rises as steeply, is
    its own continuation.

    Parameters
    ----------
    scan : Scan
    max_incidence_deg : float
        As in `grid_mesh`.

    Returns
    -------
    (H, W) bool
    """
    height, width = scan.shape
    # Along a row, the inverse range of a plane is a straight line; two pixels beyond each edge are unknown.
    inverse = np.full((height + 4, width + 4), np.nan)
    with np.errstate(divide="ignore"):
        inverse[2:-2, 2:-2] = np.where(scan.valid, 1 / scan.range, np.nan)
    points = np.full((height + 4, width + 4, 3), np.nan)
    points[2:-2, 2:-2] = np.where(scan.valid[..., None], scan.points, np.nan)
    if scan.full_turn:
        for grid in (inverse, points):
            grid[:, :2], grid[:, -2:] = grid[:, -4:-2].copy(), grid[:, 2:4].copy()
    mixed = np.zeros(scan.shape, bool)
    for down, right in _WAYS:

        def at(grid, steps, down=down, right=right):
            top, left = 2 + steps * down, 2 + steps * right
            return grid[top : top + height, left : left + width]

        here, before, behind = (at(inverse, steps) for steps in (0, -1, 1))
        jump = np.abs(behind - before)
        # Unknown where there is no second neighbor; then the first one alone has to do.
        off_before = np.fmin(np.abs(here - before), np.abs(here - (2 * before - at(inverse, -2))))
        off_behind = np.fmin(np.abs(here - behind), np.abs(here - (2 * behind - at(inverse, 2))))
        between = (here - before) * (here - behind) < 0
        apart = np.minimum(off_before, off_behind) > _LEAST_SHARE * jump
        mixed |= between & apart & is_jump(at(points, -1), at(points, 1), max_incidence_deg)
    return mixed
