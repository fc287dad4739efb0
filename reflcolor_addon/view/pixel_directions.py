"""The direction of every pixel of a scan's grid as the scanner saw it, also of those without a return."""

import numpy as np

from ..scan.grid_mesh import row_strips
from .outlines import DOWN, RIGHT, STEPS
from .small_holes import nearest_kept

# Size of the window in which steps from pixel to pixel are averaged, for the directions of pixels without a return.
_STEP_WINDOW = 31


def pixel_directions(scan):
    """Return (H, W, 3) float64 unit vectors; where there is no return, on from the nearest one by the usual step."""
    known, width = scan.valid, scan.shape[1]
    # Points without a return are zeros.
    rays = scan.points / np.where(known, scan.range, 1)[..., None]
    rows, cols = np.nonzero(~known)
    source = nearest_kept(known)[rows, cols]
    lost = rays.reshape(-1, 3)[source]
    for way, offset in ((DOWN, rows - source // width), (RIGHT, cols - source % width)):
        both = known & _beside(known, way)
        if way == DOWN:
            both[-1] = False
        elif not scan.full_turn:
            both[:, -1] = False
        lost = lost + _steps(rays, both, way, source) * offset[:, None]
    rays[rows, cols] = lost
    for strip in row_strips(*scan.shape):
        rays[strip] /= np.maximum(np.linalg.norm(rays[strip], axis=-1, keepdims=True), 1e-12)
    return rays


def _steps(rays, both, way, source):
    """(N, 3): the mean step to the next pixel that way around each of N pixels; where none is near, the usual one."""
    share = _mean_around(both.astype(np.float64), source)
    near, pairs = share > 1e-9, max(both.sum(), 1)
    found = np.empty((len(source), 3))
    for axis in range(3):
        step = _beside(rays[..., axis], way)
        step -= rays[..., axis]
        step[~both] = 0
        mean = _mean_around(step, source)
        # Added one by one, unlike `sum`, as of all three axes at once: the last bits stay as they were.
        usual = np.cumsum(step, out=step.reshape(-1))[-1] / pairs
        found[:, axis] = np.where(near, mean / np.where(near, share, 1), usual)
    return found


def _mean_around(grid, pixels):
    """(N,): the mean of an (H, W) grid in a window around each of some pixels."""
    import cv2

    window = (_STEP_WINDOW, _STEP_WINDOW)
    return cv2.blur(grid, window, borderType=cv2.BORDER_REPLICATE).reshape(-1)[pixels]


def _beside(grid, way):
    """Each pixel's neighbor below or to the right; beyond an edge, whatever is at the other."""
    down, right = STEPS[way]
    return np.roll(grid, (-down, -right), axis=(0, 1))
