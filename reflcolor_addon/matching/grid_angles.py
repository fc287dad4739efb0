"""The directions of all pixels of a scan's grid, of those without a return, too, and isolated holes closed.

What a photo shows at a pixel must not depend on whether the scanner got a return there: else the pattern of the holes
is printed into what is taken from the photo, and agrees with that of the scan by itself.
"""

from dataclasses import dataclass, replace

import numpy as np

# A hole is isolated if so many of its eight neighbors are there; twice, so that two beside each other are closed, too.
_LEAST_NEIGHBORS, _ROUNDS = 5, 2
# A row has one elevation, a column one azimuth, if nine of ten pixels are so near to it, in the larger step of the
# grid. The rings of spinning lidars are often turned against each other.
_LEVEL_STEPS, _TURNED_STEPS = 1.0, 8.0
_DEGREE = 4
_UNEVEN = 1.5
_SAMPLES = 4000


def closed(scan):
    """Return the scan with isolated holes filled from around; the same one where there are none.

    A line of one pixel's width is closed, too; larger holes stay. The reflectance is the mean of the neighbors, the
    range that of the nearest half of them.
    """
    points, reflectance, valid = scan.points, scan.reflectance, scan.valid
    for _ in range(_ROUNDS):
        count = _neighbor_sum(valid.astype(np.float32))
        rows, cols = np.nonzero(~valid & (count >= _LEAST_NEIGHBORS))
        if not len(rows):
            break
        points, reflectance, valid = (array.copy() for array in (points, reflectance, valid))
        near = [(rows + down, cols + right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]
        inside = [(r >= 0) & (c >= 0) & (r < valid.shape[0]) & (c < valid.shape[1]) for r, c in near]
        near = [(np.clip(r, 0, valid.shape[0] - 1), np.clip(c, 0, valid.shape[1] - 1)) for r, c in near]
        there = np.stack([valid[place] & ok for place, ok in zip(near, inside, strict=True)], axis=-1)
        around = np.stack([points[place] for place in near], axis=1)
        distance = np.where(there, np.linalg.norm(around, axis=-1), np.inf)
        direction = np.where(
            there[..., None], around / np.maximum(np.linalg.norm(around, axis=-1), 1e-12)[..., None], 0
        )
        direction = direction.sum(axis=1)
        direction /= np.maximum(np.linalg.norm(direction, axis=-1, keepdims=True), 1e-12)
        # The middle one, or the nearer of the two: the mean would stand between a thing and what lies behind it.
        middle = np.sort(distance, axis=1)[np.arange(len(rows)), (there.sum(axis=1) - 1) // 2]
        mean = np.where(there, np.stack([reflectance[place] for place in near], axis=-1), 0).sum(axis=1)
        points[rows, cols] = direction * middle[:, None]
        reflectance[rows, cols] = mean / there.sum(axis=1)
        valid[rows, cols] = True
    return scan if valid is scan.valid else replace(scan, points=points, reflectance=reflectance, valid=valid)


def _neighbor_sum(image):
    import cv2

    kernel = np.ones((3, 3), np.float32)
    kernel[1, 1] = 0
    return cv2.filter2D(image, cv2.CV_32F, kernel, borderType=cv2.BORDER_CONSTANT)


@dataclass(frozen=True, eq=False)
class GridAngles:
    """Where the pixels of a grid look, those without a return, too: a model of the whole grid.

    elevation_deg : (H,) float64 or None
        Of each row, where all of a row look equally far up, as a scanner's panorama does; None otherwise.
    azimuth_deg : (W,) float64 or None
        Of each column, to the right of straight ahead (+Y), along with it.
    weights : (K, 3) float64 or None
        Of a polynomial over the grid otherwise, as the lens of a camera makes it.
    """

    shape: tuple[int, int]
    elevation_deg: np.ndarray | None
    azimuth_deg: np.ndarray | None
    weights: np.ndarray | None

    @classmethod
    def of(cls, scan):
        """Measure those of a scan with at least one return."""
        separable = _separable(scan.points, scan.valid)
        if separable is not None:
            return cls(scan.shape, *separable, None)
        rows, cols = np.nonzero(scan.valid)
        every = max(1, len(rows) // _SAMPLES)
        rows, cols = rows[::every], cols[::every]
        directions = scan.points[rows, cols] / np.maximum(scan.range[rows, cols], 1e-12)[:, None]
        weights = np.linalg.lstsq(_terms(rows, cols, scan.shape), directions, rcond=None)[0]
        return cls(scan.shape, None, None, weights)

    @property
    def uneven(self):
        """Whether the rows are not evenly far apart."""
        if self.elevation_deg is None:
            return False
        step = np.abs(np.diff(self.elevation_deg))
        return bool(step.max() > _UNEVEN * np.median(step))

    def at(self, rows, cols):
        """Return the (h, w, 3) unit vectors of a lattice of rows (h,) and columns (w,), also between pixels."""
        if self.weights is not None:
            row, col = np.meshgrid(rows, cols, indexing="ij")
            directions = _terms(row, col, self.shape) @ self.weights
            return directions / np.maximum(np.linalg.norm(directions, axis=-1, keepdims=True), 1e-12)
        up = np.radians(np.interp(rows, np.arange(self.shape[0]), self.elevation_deg))[:, None]
        turn = np.radians(np.interp(cols, np.arange(self.shape[1]), self.azimuth_deg))[None]
        return np.stack([np.sin(turn) * np.cos(up), np.cos(turn) * np.cos(up), np.sin(up) + 0 * turn], axis=-1)


def _separable(points, valid):
    """Each row's elevation and each column's azimuth in degrees, or None where there are no such."""
    across = np.hypot(points[..., 0], points[..., 1])
    elevation = np.degrees(np.arctan2(points[..., 2], across))
    azimuth = np.arctan2(points[..., 0], points[..., 1])
    row_known, col_known = valid.sum(axis=1) >= 4, valid.sum(axis=0) >= 2
    if row_known.sum() < 4 or col_known.sum() < 4:
        return None
    of_row = np.array(
        [
            np.median(elevation[r][own]) if known else np.nan
            for r, (own, known) in enumerate(zip(valid, row_known, strict=True))
        ]
    )
    sine, cosine = (np.where(valid, function(azimuth), 0).sum(axis=0) for function in (np.sin, np.cos))
    of_col = np.where(col_known, np.arctan2(sine, cosine), np.nan)
    of_col[col_known] = np.unwrap(of_col[col_known])
    of_row, of_col = _extended(of_row), np.degrees(_extended(of_col))
    off_row = np.abs(elevation - of_row[:, None])[valid]
    level = np.cos(np.radians(elevation))
    off_col = (np.abs((np.degrees(azimuth) - of_col[None] + 180) % 360 - 180) * level)[valid]
    step = np.median(np.abs(np.diff(of_row)))
    step_across = max(step, np.median(np.abs(np.diff(of_col))))
    if np.quantile(off_row, 0.9) > _LEVEL_STEPS * step or np.quantile(off_col, 0.9) > _TURNED_STEPS * step_across:
        return None
    return of_row, of_col


def _extended(values):
    """A line of values with its gaps interpolated, and continued at both ends as it begins and ends."""
    known = np.flatnonzero(np.isfinite(values))
    index = np.arange(len(values))
    full = np.interp(index, known, values[known])
    step = np.median(np.diff(values[known]) / np.diff(known))
    full[: known[0]] += (index[: known[0]] - known[0]) * step
    full[known[-1] + 1 :] += (index[known[-1] + 1 :] - known[-1]) * step
    return full


def _terms(rows, cols, shape):
    """(..., K): the powers of a polynomial over the grid."""
    y, x = 2 * np.asarray(rows) / shape[0] - 1, 2 * np.asarray(cols) / shape[1] - 1
    return np.stack([y**i * x**j for i in range(_DEGREE + 1) for j in range(_DEGREE + 1 - i)], axis=-1)
