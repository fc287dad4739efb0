"""Returns of a beam that met two surfaces: they float between them, where nothing is."""

import numpy as np

from ..scan.grid_mesh import MAX_INCIDENCE_DEG, is_jump, row_strips

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
    mixed = np.empty(scan.shape, bool)
    for rows in row_strips(*scan.shape):
        mixed[rows] = _of_strip(scan, rows.start, rows.stop, max_incidence_deg)
    return mixed


def _of_strip(scan, top, bottom, max_incidence_deg):
    """The same for the rows from ``top`` to ``bottom``."""
    height, width = bottom - top, scan.shape[1]
    # A strip sees two rows beyond its ends, so that strips leave no seam.
    first, last = max(0, top - 2), min(scan.shape[0], bottom + 2)
    inside = np.s_[2 - (top - first) : 2 + height + (last - bottom), 2:-2]
    valid = scan.valid[first:last]
    # Along a row, the inverse range of a plane is a straight line; two pixels beyond each edge are unknown.
    inverse = np.full((height + 4, width + 4), np.nan)
    with np.errstate(divide="ignore"):
        inverse[inside] = np.where(valid, 1 / scan.range[first:last], np.nan)
    points = np.full((height + 4, width + 4, 3), np.nan)
    points[inside] = np.where(valid[..., None], scan.points[first:last], np.nan)
    if scan.full_turn:
        for grid in (inverse, points):
            grid[:, :2], grid[:, -2:] = grid[:, -4:-2].copy(), grid[:, 2:4].copy()
    mixed = np.zeros((height, width), bool)
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
