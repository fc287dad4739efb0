"""The direction of every pixel of a scan's grid as the scanner saw it, also of those without a return."""

import numpy as np

from .outlines import DOWN, RIGHT, STEPS
from .small_holes import nearest_kept

# Size of the window in which steps from pixel to pixel are averaged, for the directions of pixels without a return.
_STEP_WINDOW = 31


def pixel_directions(scan):
    """Return (H, W, 3) float64 unit vectors; where there is no return, on from the nearest one by the usual step."""
    import cv2

    known, width = scan.valid, scan.shape[1]
    rays = np.where(known[..., None], scan.points / np.where(known, scan.range, 1)[..., None], 0)
    rows, cols = np.nonzero(~known)
    source = nearest_kept(known)[rows, cols]
    lost = rays.reshape(-1, 3)[source]
    for way, offset in ((DOWN, rows - source // width), (RIGHT, cols - source % width)):
        both = known & _beside(known, way)
        if way == DOWN:
            both[-1] = False
        elif not scan.full_turn:
            both[:, -1] = False
        step = _beside(rays, way)
        step -= rays
        step[~both] = 0
        usual = step.sum(axis=(0, 1)) / max(both.sum(), 1)
        window = (_STEP_WINDOW, _STEP_WINDOW)
        sums = cv2.blur(np.dstack([step, both]), window, borderType=cv2.BORDER_REPLICATE).reshape(-1, 4)[source]
        near = sums[:, 3:] > 1e-9
        mean = np.where(near, sums[:, :3] / np.where(near, sums[:, 3:], 1), usual)
        lost = lost + mean * offset[:, None]
    rays[rows, cols] = lost
    rays /= np.maximum(np.linalg.norm(rays, axis=-1, keepdims=True), 1e-12)
    return rays


def _beside(grid, way):
    """Each pixel's neighbor below or to the right; beyond an edge, whatever is at the other."""
    down, right = STEPS[way]
    return np.roll(grid, (-down, -right), axis=(0, 1))
