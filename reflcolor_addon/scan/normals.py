"""Directions of the scanned surface."""

import numpy as np

# The points are averaged over this many pixels either side; the averages this far apart span the surface.
_RADIUS = 2
_STEP = 2
_PAD = _RADIUS + _STEP
_CHUNK_PIXELS = 1 << 19


def surface_normals(points, valid, *, wrap=False):
    """Estimate the surface's unit normal at every pixel, from averages of 5 x 5 points.

    Parameters
    ----------
    points : (H, W, 3) float
        Meters, in the scanner's frame.
    valid : (H, W) bool
    wrap : bool
        Whether the left and the right edge are neighbors.

    Returns
    -------
    (H, W, 3) float32
        Pointing to the scanner's side; zeros where not valid, or where the neighbors span no surface.
    """
    height, width = valid.shape
    normals = np.zeros((height, width, 3), np.float32)
    rows = max(1, _CHUNK_PIXELS // width)
    for top in range(0, height, rows):
        bottom = min(height, top + rows)
        # A strip sees the rows beyond its ends, so that strips leave no seam.
        first, last = max(0, top - _PAD), min(height, bottom + _PAD)
        above, below = _PAD - (top - first), _PAD - (last - bottom)
        strip = slice(first, last)
        normals[top:bottom] = _of_strip(points[strip], valid[strip], above, below, wrap)
    return normals


def _of_strip(points, valid, above, below, wrap):
    """Normals of the rows that lie `_PAD` inside, once `above` and `below` empty rows are added."""
    import cv2

    grid = np.concatenate([np.where(valid[..., None], points, 0), valid[..., None]], axis=-1, dtype=np.float32)
    grid = np.pad(grid, ((above, below), (0, 0), (0, 0)))
    grid = np.pad(grid, ((0, 0), (_PAD, _PAD), (0, 0)), mode="wrap" if wrap else "constant")
    box = (2 * _RADIUS + 1, 2 * _RADIUS + 1)
    sums = cv2.boxFilter(grid, -1, box, normalize=False, borderType=cv2.BORDER_CONSTANT)
    # Sums of zeros and ones may be off by a rounding.
    there = sums[..., 3] > 0.5
    mean = sums[..., :3] / np.where(there, sums[..., 3], 1)[..., None]

    def shifted(down, right):
        """The averages that many pixels away; where there are none, those of the pixel itself."""
        inside = slice(_PAD + down, mean.shape[0] - _PAD + down), slice(_PAD + right, mean.shape[1] - _PAD + right)
        return np.where(there[inside][..., None], mean[inside], mean[_PAD:-_PAD, _PAD:-_PAD])

    across = shifted(0, _STEP) - shifted(0, -_STEP)
    along = shifted(_STEP, 0) - shifted(-_STEP, 0)
    normal = np.cross(across, along)
    inside = grid[_PAD:-_PAD, _PAD:-_PAD]
    away = np.einsum("ijk,ijk->ij", normal, inside[..., :3]) > 0
    length = np.linalg.norm(normal, axis=-1)
    # Averages of the same points differ only by rounding, which has no direction.
    span = np.linalg.norm(across, axis=-1) * np.linalg.norm(along, axis=-1)
    spans = (inside[..., 3] > 0) & (length > 1e-3 * span) & (span > 0)
    scale = np.divide(np.where(away, -1, 1), length, out=np.zeros_like(length), where=spans)
    return normal * scale[..., None]
