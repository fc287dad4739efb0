"""Which pixels of a scan a camera sees, by a depth buffer of the scan's own surface.

The surface is the grid's quads, each filled in the photo, so that it hides what is behind it between its points, too,
however coarse the grid is.
"""

from dataclasses import dataclass

import numpy as np

# Cells of the buffer along the photo's longer side; and the most that a quad may take, a power of two.
_CELLS, _LARGEST_QUAD = 1500, 64
_CHUNK_VALUES = 1 << 20
# What lies farther than the nearest in the same cell by more than this share is hidden.
_TOLERANCE = 0.02


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """The depth of the nearest surface in every cell of a photo.

    Parameters
    ----------
    nearest : (rows, columns) float32
        Meters along the camera's axis; very large where there is none.
    cell : float
        Side of a cell in pixels of the photo.
    """

    nearest: np.ndarray
    cell: float

    @classmethod
    def empty(cls, model):
        """Return one of a `Camera` without any surface."""
        cell = max(model.width, model.height) / _CELLS
        shape = int(model.height / cell) + 1, int(model.width / cell) + 1
        return cls(np.full(shape, 1e9, np.float32), cell)

    @classmethod
    def of(cls, model, xy, depth, joined):
        """Fill the quads of a grid.

        Parameters
        ----------
        model : Camera
        xy, depth : (H, W, 2), (H, W) float32
            Where it sees the grid's points; NaN where there is none or it does not.
        joined : (H - 1, W - 1) or (H - 1, W) bool
            Which quads are surface; the last column of a full turn joins the first one.
        """
        buffer = cls.empty(model)
        rows = max(1, _CHUNK_VALUES // max(1, xy.shape[1]))
        for top in range(0, len(joined), rows):
            strip = slice(top, top + rows + 1)
            places, depths, own = xy[strip], depth[strip], joined[top : top + rows]
            if joined.shape[1] == xy.shape[1]:
                places, depths = (np.concatenate([values, values[:, :1]], axis=1) for values in (places, depths))
            corners = [np.s_[:-1, :-1], np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[1:, 1:]]
            x, y, z = ([plane[corner] for corner in corners] for plane in (places[..., 0], places[..., 1], depths))
            wanted = own & buffer._touched(x, y)
            buffer._fill(*(np.stack([values[wanted] for values in plane], axis=-1) for plane in (x, y, z)))
        return buffer

    @classmethod
    def of_quads(cls, model, groups):
        """Fill quads given by their corners: arrays (K, 4, 3), meters, in the order of a grid's rows."""
        buffer = cls.empty(model)
        for corners in groups:
            for start in range(0, len(corners), _CHUNK_VALUES // 4):
                xy, depth = model.project(corners[start : start + _CHUNK_VALUES // 4].astype(np.float64))
                x, y, z = (plane.astype(np.float32) for plane in (xy[..., 0], xy[..., 1], depth))
                wanted = buffer._touched(x.T, y.T)
                buffer._fill(x[wanted], y[wanted], z[wanted])
        return buffer

    def _touched(self, x, y):
        """Which quads may lie in the photo; places are given by four arrays, one for each corner. NaN does not."""
        (left, right), (top, bottom) = _ends(x), _ends(y)
        rows, columns = (length * self.cell for length in self.nearest.shape)
        return (right >= 0) & (left < columns) & (bottom >= 0) & (top < rows)

    def _fill(self, x, y, depth):
        """Fill quads: (N, 4) pixels of the photo, and meters."""
        x, y, inverse = x / np.float32(self.cell), y / np.float32(self.cell), 1 / depth
        (left, right), (top, bottom) = _ends(x.T), _ends(y.T)
        side = np.maximum(right - left, bottom - top)
        finest, smallest = 1, -1.0
        while finest <= _LARGEST_QUAD:
            largest = finest if finest < _LARGEST_QUAD else np.inf
            chosen = np.flatnonzero((side > smallest) & (side <= largest))
            step = max(1, _CHUNK_VALUES // finest**2)
            for start in range(0, len(chosen), step):
                part = chosen[start : start + step]
                self._splat(x[part], y[part], inverse[part], finest)
            finest, smallest = 2 * finest, largest

    def _splat(self, x, y, inverse, finest):
        """Put ``finest`` x ``finest`` places of each quad into the buffer."""
        share = (np.arange(finest, dtype=np.float32) + 0.5) / finest
        across, down = (grid.ravel() for grid in np.meshgrid(share, share))
        weights = np.stack([(1 - across) * (1 - down), across * (1 - down), (1 - across) * down, across * down])
        column, row, depth = x @ weights, y @ weights, 1 / (inverse @ weights)
        rows, columns = self.nearest.shape
        inside = (column >= 0) & (row >= 0) & (column < columns) & (row < rows)
        index = row[inside].astype(np.int64) * columns + column[inside].astype(np.int64)
        np.minimum.at(self.nearest.reshape(-1), index, depth[inside])

    def at(self, xy):
        """Return (N,) int row and column of the cells of (N, 2) places inside the photo."""
        column, row = (xy / self.cell).astype(np.int64).T
        rows, columns = self.nearest.shape
        return np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)

    def sees(self, xy, depth, slope):
        """Return (N,) bool: whether nothing hides (N, 2) places at (N,) depths.

        ``slope`` (N,): by how much the depth of the surface there changes over a cell, meters.
        """
        return depth <= self.nearest[self.at(xy)] * (1 + _TOLERANCE) + slope

    def nearest_around(self, xy):
        """Return (N,) float32: the least depth in the cells of (N, 2) places and in those beside them."""
        import cv2

        return cv2.erode(self.nearest, np.ones((3, 3), np.uint8))[self.at(xy)]

    def outlines(self, radius):
        """Return two (rows, columns) float32: the farthest and the nearest depth within ``radius`` cells.

        Where there is no surface it is very far; beyond the photo's border nothing is known.
        """
        import cv2

        kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
        return (
            cv2.dilate(self.nearest, kernel, borderType=cv2.BORDER_REPLICATE),
            cv2.erode(self.nearest, kernel, borderType=cv2.BORDER_REPLICATE),
        )


def _ends(values):
    """The least and the greatest of four arrays, element by element."""
    first, second, third, fourth = values
    return (
        np.minimum(np.minimum(first, second), np.minimum(third, fourth)),
        np.maximum(np.maximum(first, second), np.maximum(third, fourth)),
    )
