"""Whether something that the scanner never saw may stand between a surface and a camera.

Space in front of what the scanner saw is empty, space behind it is unknown: a photo from aside sees the unseen side of
a thing, which hides what lies beyond though the scan has no point there. A way to the camera gets into unknown space
through the surface itself, which a depth buffer tells, or where that breaks off: through the strip, along the scanner's
ray, between a thing's outline and what lies behind it. So these strips are drawn into depth buffers of their own. Where
the scan has a hole, a dark or a shining thing may stand, or a pane of glass; that is drawn, too.
"""

from functools import cached_property

import numpy as np

from ..grid_angles import GridAngles
from ..scan_image import pixel_steps
from .occlusion import DepthBuffer

# The range of neighbors differs by more than this share, beyond the slope on both sides, where a surface breaks off.
_JUMP = 0.04
# Things are most often no thicker than this share of their distance; and how far unknown space goes on at most.
_THICKNESS, _FARTHEST = 0.12, 10.0
# What is this much nearer than a surface, as a share of the depth, stands before it.
_BEFORE = 0.03
# Seen at less than this angle apart from the scanner's own view, little unknown can be in the way, and a thin thing's
# long shadow would take away much that is seen well.
_APART_COSINE = np.cos(np.radians(75))
# Pixels, and share of the grid, of a hole; how near to what is around it a thing in it may be.
_SMALLEST_HOLE, _LARGEST_HOLE = 9, 0.05
_BEFORE_HOLE, _NEAR_QUANTILE = 0.95, 0.05


class UnknownSpace:
    """The space that a scanner did not see into.

    Parameters
    ----------
    scan : Scan
    """

    def __init__(self, scan):
        self._scan = scan

    def between(self, model, sight, chosen):
        """Return which of the chosen pixels something unknown may hide from a camera: certainly, and perhaps.

        From behind a surface the way to the camera begins in unknown space, inside the surface's own thing; only what
        is farther away than that is thick counts there.

        Parameters
        ----------
        model : Camera
        sight : Sight
        chosen : (H, W) bool

        Returns
        -------
        hidden, perhaps : (H, W) bool
        """
        scan = self._scan
        thin = DepthBuffer.of_quads(model, [self._strips(False), self._covers])
        whole = DepthBuffer.of_quads(model, [self._strips(True)])
        before = np.where(sight.cosine[chosen] < 0, _THICKNESS, _BEFORE)
        apart = self._apart(model, chosen)
        hidden, perhaps = np.zeros(scan.shape, bool), np.zeros(scan.shape, bool)
        xy, depth = sight.xy[chosen], sight.depth[chosen]
        perhaps[chosen] = thin.nearest_around(xy) < depth * (1 - before)
        hidden[chosen] = apart & (whole.nearest_around(xy) < depth * (1 - before))
        return hidden, perhaps

    def _apart(self, model, chosen):
        """(N,) bool: which of the chosen pixels a camera sees from quite another side than the scanner."""
        points = self._scan.points[chosen]
        way = model.center - points
        lengths = np.linalg.norm(way, axis=1) * self._scan.range[chosen]
        return -np.einsum("ij,ij->i", way, points) < _APART_COSINE * lengths

    @cached_property
    def _outlines(self):
        """Of all places where a surface breaks off: (K, 3) directions, (K, 3) half the way along the outline, per meter
        of distance; (K,) range from which on space is unknown there, to which a thing goes on, and to which it may."""
        scan = self._scan
        angles = GridAngles.of(scan)
        height, width = scan.shape
        directions = angles.at(np.arange(height), np.arange(width)).astype(np.float32)
        measured = scan.points / np.maximum(scan.range, 1e-12)[..., None]
        directions = np.where(scan.valid[..., None], measured, directions).astype(np.float32)
        found = []
        for axis in (0, 1):
            (near, far), step = outlines(scan, axis), np.radians(pixel_steps(scan)[1 - axis])
            one, other = (tuple(index) for index in (near, far))
            middle = directions[one] + directions[other]
            middle /= np.maximum(np.linalg.norm(middle, axis=-1, keepdims=True), 1e-12)
            # Across the way from one pixel to the other, and square to the line of sight.
            along = np.cross(middle, directions[other] - directions[one])
            along *= (0.5 * step) / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-12)
            begin, behind = scan.range[one], np.where(scan.valid[other], scan.range[other], np.inf)
            ends = [np.minimum(behind, begin * (1 + share)) for share in (_THICKNESS, _FARTHEST)]
            # What stands in a hole has its side there, up to what is seen around.
            hole = self._in_holes[other]
            ends = [np.where(hole > 0, np.maximum(begin, hole), end) for end in ends]
            found.append((middle, along, np.where(hole > 0, hole, begin), *ends))
        return [np.concatenate(parts) for parts in zip(*found, strict=True)]

    def _strips(self, whole):
        """(K, 4, 3) float32: the corners of strips from the outlines on, as long as things are thick, or may be."""
        middle, along, begin, *ends = self._outlines
        corners = [
            (middle + sign * along) * distance[:, None]
            for distance in (begin, ends[whole])
            for sign in (np.float32(-1), np.float32(1))
        ]
        return np.stack(corners, axis=1).astype(np.float32)

    @cached_property
    def _in_holes(self):
        """(H, W) float32: how near a thing in a hole may be; 0 where there is no hole."""
        import cv2

        scan = self._scan
        height, width = scan.shape
        _, label, stats, _ = cv2.connectedComponentsWithStats((~scan.valid).astype(np.uint8), connectivity=4)
        left, top, across, down, size = stats.T
        inner = (top > 0) & (top + down < height)
        if not scan.full_turn:
            inner &= (left > 0) & (left + across < width)
        inner[0] = False
        distance = np.zeros(scan.shape, np.float32)
        for hole in np.flatnonzero(inner & (size >= _SMALLEST_HOLE) & (size <= _LARGEST_HOLE * scan.valid.size)):
            first_row, first_col = top[hole] - 1, max(left[hole] - 1, 0)
            window = np.s_[first_row : top[hole] + down[hole] + 1, first_col : left[hole] + across[hole] + 1]
            own = label[window] == hole
            rim = (cv2.dilate(own.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0) & ~own & scan.valid[window]
            # A thing stands no nearer than what is seen around it: the floor before its foot, a window's wall.
            distance[window][own] = _BEFORE_HOLE * np.quantile(scan.range[window][rim], _NEAR_QUANTILE)
        return distance

    @cached_property
    def _covers(self):
        """(K, 4, 3) float32: the corners of the pixels of holes, as near as a thing in them may be."""
        height, width = self._scan.shape
        rows, cols = np.nonzero(self._in_holes)
        if not len(rows):
            return np.zeros((0, 4, 3), np.float32)
        corners = GridAngles.of(self._scan).at(np.arange(height + 1) - 0.5, np.arange(width + 1) - 0.5)
        quads = [corners[rows + below, cols + right] for below in (0, 1) for right in (0, 1)]
        return (np.stack(quads, axis=1) * self._in_holes[rows, cols][:, None, None]).astype(np.float32)


def outlines(scan, axis):
    """Return (2, K) rows and columns of the near and of the far ones of all neighbors along an axis between which a
    surface breaks off: one is much nearer, or the other has no return."""
    logarithm = np.log(np.maximum(scan.range, 1e-6)).astype(np.float32)
    length = scan.shape[axis]
    first, second = (np.take(scan.valid, index, axis) for index in (range(length - 1), range(1, length)))
    step = np.where(first & second, np.diff(logarithm, axis=axis), 0)
    usual = np.minimum(np.abs(np.roll(step, 1, axis)), np.abs(np.roll(step, -1, axis)))
    jump = np.abs(step) > _JUMP + 2 * usual
    offset = np.array([[1], [0]]) if axis == 0 else np.array([[0], [1]])
    near_first, near_second = (
        np.array(np.nonzero(mask))
        for mask in ((jump & (step > 0)) | (first & ~second), (jump & (step < 0)) | (second & ~first))
    )
    near = np.concatenate([near_first, near_second + offset], axis=1)
    far = np.concatenate([near_first + offset, near_second], axis=1)
    return near, far
