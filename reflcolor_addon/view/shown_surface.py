"""What is added to a scan's surface to look at: small holes filled, outlines smoothed. Nothing measured is changed."""

from dataclasses import dataclass

import numpy as np

from ..errors import Cancelled
from ..messages import Message
from ..scan.grid_mesh import MAX_INCIDENCE_DEG, is_jump, row_strips
from .mixed_pixels import mixed_pixels
from .outlines import CORNERS, DOWN, RIGHT, STEPS, outline_shares, square_polygons
from .pixel_directions import pixel_directions
from .small_holes import nearest_kept, small_holes, spread_into

# An outline continues its surface's slope, but by no more than this share of the inverse range.
_LARGEST_SLOPE = 0.05


@dataclass(frozen=True, eq=False, kw_only=True)
class ShownSurface:
    """Faces beside those of a scan's `GridMesh`: M vertices, F faces of 3 to 6 corners, C corners in all.

    Parameters
    ----------
    points : (M, 3) float64
        Meters, in the scanner's frame.
    places : (M, 2) float64
        Row and column in the scan's grid.
    measured : (M,) bool
        Whether a vertex is the return of a pixel, and so one of the scan's own.
    source : (M,) int64
        The pixel whose color a vertex has: its index in reading order.
    corners : (C,) int32
        Vertices of the faces, one face after the other, counterclockwise as seen from the scanner.
    sizes : (F,) int32
        Corners of each face.
    uv : (C, 2) float32
        Place of every corner in the scan's image, as in `GridMesh`.
    mixed : (H, W) bool
        Pixels that are not to be shown.
    """

    points: np.ndarray
    places: np.ndarray
    measured: np.ndarray
    source: np.ndarray
    corners: np.ndarray
    sizes: np.ndarray
    uv: np.ndarray
    mixed: np.ndarray

    @property
    def starts(self):
        """(F,) int32: the place of each face's first corner in ``corners``."""
        return (np.cumsum(self.sizes) - self.sizes).astype(np.int32)


def shown_surface(scan, *, drop_mixed=True, max_incidence_deg=MAX_INCIDENCE_DEG, progress=None, cancelled=None):
    """Return what is added to the surface of a scan to look at.

    Small holes are filled as the surface around them goes on. Where a surface ends, faces reach on to its outline,
    which runs smoothly between the pixels instead of along the grid; so where one surface lies before another, no gap
    is left between them as seen from the scanner.

    Parameters
    ----------
    scan : Scan
    drop_mixed : bool
        Do not show returns of a beam that met two surfaces; see `mixed_pixels`.
    max_incidence_deg : float
        As in `grid_mesh`.
    progress : callable, optional
        Called as ``progress(fraction, text)`` with a fraction of 0 to 1.
    cancelled : callable, optional
        Asked now and then; when it returns True, the work ends.

    Returns
    -------
    ShownSurface

    Raises
    ------
    Cancelled
        If ``cancelled()`` returned True.
    """

    def report(fraction, text):
        if cancelled is not None and cancelled():
            raise Cancelled
        if progress is not None:
            progress(fraction, text)

    report(0.0, Message("Looking for mixed returns"))
    mixed = mixed_pixels(scan, max_incidence_deg) if drop_mixed else np.zeros(scan.shape, bool)
    report(0.2, Message("Filling small holes"))
    grid = _Grid(scan, scan.valid & ~mixed, max_incidence_deg)
    report(0.5, Message("Smoothing outlines"))
    polygons = _Polygons(grid)
    points, vertex, pixels = polygons.vertices()
    report(1.0, Message("Filling small holes"))
    return ShownSurface(
        points=points,
        places=polygons.places,
        measured=polygons.measured,
        source=grid.nearest.ravel()[pixels],
        corners=vertex.astype(np.int32),
        sizes=polygons.sizes,
        uv=polygons.uv(),
        mixed=mixed,
    )


class _Grid:
    """The pixels that are shown: those that are kept, and small holes between them."""

    def __init__(self, scan, kept, max_incidence_deg):
        self.height, self.width = scan.shape
        self.wrap, self.kept = scan.full_turn, kept
        self.holes = small_holes(kept)
        self.there = kept | self.holes
        # A scan without any pixel is not shown.
        self.nearest = nearest_kept(kept) if kept.any() else np.zeros(scan.shape, np.int64)
        joined = self._measured_joints(scan.points, max_incidence_deg)
        self.surface = self._surfaces(joined)
        self.joined = [
            np.where(self._beside(kept, way) & kept, joint, self._alike(way)) & self._inside(way)
            for way, joint in zip((RIGHT, DOWN), joined, strict=True)
        ]
        self.directions = pixel_directions(scan)
        with np.errstate(divide="ignore"):
            inverse = np.where(kept, 1 / np.where(kept, scan.range, 1), 0).ravel()[self.nearest]
        self.inverse = spread_into(self.holes, inverse, self.surface)
        self.points = scan.points

    def _beside(self, grid, way):
        """Each pixel's neighbor to the right or below; beyond an edge, whatever is at the other."""
        down, right = STEPS[way]
        return np.roll(grid, (-down, -right), axis=(0, 1))

    def _inside(self, way):
        """Where there is such a neighbor."""
        inside = np.ones((self.height, self.width), bool)
        if way == DOWN:
            inside[-1] = False
        elif not self.wrap:
            inside[:, -1] = False
        return inside

    def _measured_joints(self, points, max_incidence_deg):
        joined = [self.kept & self._beside(self.kept, way) & self._inside(way) for way in (RIGHT, DOWN)]
        for rows in row_strips(self.height, self.width):
            here, below = points[rows], points[rows.start + 1 : rows.stop + 1]
            joined[RIGHT][rows] &= ~is_jump(here, np.roll(here, -1, axis=1), max_incidence_deg)
            joined[DOWN][rows][: len(below)] &= ~is_jump(here[: len(below)], below, max_incidence_deg)
        return joined

    def _surfaces(self, joined):
        """Number the surfaces: pixels that joints connect; a hole is of the surface that is nearest to it."""
        import cv2

        # An image of pixels with the joints between them.
        image = np.zeros((2 * self.height, 2 * self.width), np.uint8)
        image[::2, ::2] = self.kept
        image[::2, 1::2], image[1::2, ::2] = joined
        _, labels = cv2.connectedComponents(image, connectivity=4)
        seam = joined[RIGHT][:, -1]
        labels = labels[::2, ::2].copy()
        labels = _merged(labels, labels[seam, -1], labels[seam, 0])
        return np.where(self.there, labels.ravel()[self.nearest], np.int32(-1))

    def _alike(self, way):
        """Where a pixel and its neighbor are shown, and on the same surface."""
        return self.there & self._beside(self.there, way) & (self.surface == self._beside(self.surface, way))


def _merged(labels, some, others):
    """(H, W) int32 labels of which some pairs are made one."""
    if not len(some):
        return labels
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = labels.max() + 1
    _, one = connected_components(
        coo_array((np.ones(len(some), bool), (some, others)), shape=(count, count)), directed=False
    )
    return one.astype(np.int32)[labels]


class _Polygons:
    """The faces: of every square of four pixels that the scan's own mesh does not fill."""

    def __init__(self, grid):
        self._grid = grid
        height, width = grid.height, grid.width
        self._size = height * width
        rows, cols = np.nonzero(self._open_squares())
        self._rows, self._cols = rows, cols
        corner = [((rows + down), (cols + right) % width) for down, right in CORNERS]
        there = [grid.there[place] for place in corner]
        right, down = grid.joined
        # From each corner to the next one: down, right, up, left.
        ahead = [down[corner[0]], right[corner[1]], down[corner[3]], right[corner[0]]]
        kind = sum(bits.astype(int) << place for place, bits in enumerate([*there, *ahead]))
        tokens, sizes, squares = [], [], []
        for code in np.unique(kind):
            bits = tuple(bool(code >> place & 1) for place in range(8))
            chosen = np.flatnonzero(kind == code)
            for polygon in square_polygons((bits[:4], bits[4:])):
                # A vertex is a pixel, or where the outline crosses the way from it to a neighbor.
                columns = [
                    corner[k][0][chosen] * width + corner[k][1][chosen] + self._size * (way + 1) for k, way in polygon
                ]
                tokens.append(np.stack(columns, axis=1).ravel())
                sizes.append(np.full(len(chosen), len(polygon), np.int32))
                squares.append(np.repeat(chosen, len(polygon)))
        self._tokens = np.concatenate(tokens) if tokens else np.zeros(0, np.int64)
        self._squares = np.concatenate(squares) if squares else np.zeros(0, np.int64)
        self.sizes = np.concatenate(sizes) if sizes else np.zeros(0, np.int32)

    def vertices(self):
        """Return the (M, 3) points, the (C,) vertices of the corners, and (M,) flat indices of their pixels."""
        grid = self._grid
        unique, vertex = np.unique(self._tokens, return_inverse=True)
        pixel, way = unique % self._size, unique // self._size - 1
        shares = np.zeros(len(unique))
        self._vertex = vertex
        crosses = way >= 0
        shares[crosses] = outline_shares(grid.surface, pixel[crosses], way[crosses], wrap=grid.wrap)
        directions, inverse = grid.directions.reshape(-1, 3), grid.inverse.ravel()
        beside, opposite = self._neighbor(pixel, way, 1), self._neighbor(pixel, way, -1)
        ray = directions[pixel] + shares[:, None] * (directions[beside] - directions[pixel])
        slope = np.where(self._is_joined(pixel, opposite), inverse[pixel] - inverse[opposite], 0)
        slope = np.clip(slope, -_LARGEST_SLOPE * inverse[pixel], _LARGEST_SLOPE * inverse[pixel])
        points = ray / np.linalg.norm(ray, axis=1, keepdims=True) / (inverse[pixel] + shares * slope)[:, None]
        measured = ~crosses & grid.kept.ravel()[pixel]
        points[measured] = grid.points.reshape(-1, 3)[pixel[measured]]
        self.measured = measured
        steps = np.array([*STEPS, (0, 0)])[way] * shares[:, None]
        self.places = np.stack(np.divmod(pixel, grid.width), axis=1) + steps
        return points, vertex, pixel

    def uv(self):
        """Return the (C, 2) float32 places in the scan's image; call it after `vertices`."""
        grid = self._grid
        row, col = self.places[self._vertex].T
        # Beyond the seam of a full turn the picture continues.
        col = np.where(col < self._cols[self._squares] - 1, col + grid.width, col)
        return np.stack([(col + 0.5) / grid.width, 1 - (row + 0.5) / grid.height], axis=1).astype(np.float32)

    def _open_squares(self):
        """(H - 1, W) bool: squares with a pixel that is shown, but for those that are faces of the scan's own."""
        grid = self._grid
        right, down = grid.joined
        below = lambda bits: bits[1:]  # noqa: E731
        beside = lambda bits: np.roll(bits, -1, axis=1)  # noqa: E731
        whole = right[:-1] & below(right) & down[:-1] & beside(down)[:-1]
        measured = grid.kept[:-1] & below(grid.kept) & beside(grid.kept)[:-1] & below(beside(grid.kept))
        shown = grid.there[:-1] | below(grid.there) | beside(grid.there)[:-1] | below(beside(grid.there))
        squares = shown & ~(whole & measured)
        if not grid.wrap:
            squares[:, -1] = False
        return squares

    def _neighbor(self, pixel, way, sign):
        """Flat indices of the neighbors that way, or of those opposite; beyond an edge the pixel itself."""
        grid = self._grid
        steps = sign * np.array([*STEPS, (0, 0)])[way]
        row, col = pixel // grid.width + steps[:, 0], pixel % grid.width + steps[:, 1]
        if grid.wrap:
            col = col % grid.width
        inside = (row >= 0) & (row < grid.height) & (col >= 0) & (col < grid.width)
        return np.where(inside, row * grid.width + col, pixel)

    def _is_joined(self, pixel, other):
        grid = self._grid
        surface = grid.surface.ravel()
        return (pixel != other) & grid.there.ravel()[other] & (surface[pixel] == surface[other])
