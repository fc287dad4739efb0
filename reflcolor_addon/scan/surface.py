"""A colored scan as vertices and faces, given strip by strip, so that a large one can be written in little memory."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .georeference import local_center
from .grid_mesh import CORNERS, MAX_INCIDENCE_DEG, face_mask, quads_of, row_strips
from .scan import Scan


@dataclass(frozen=True, eq=False, kw_only=True)
class VertexBlock:
    """Some of a surface's vertices, in its order.

    Parameters
    ----------
    points : (N, 3) float64
        Meters, in the scanner's frame.
    rgb : (N, 3) uint8
        sRGB.
    values : dict of (N,) float32 or int32
        By the attribute's name.
    uv : (N, 2) float32
        Place in the scan's image, 0..1 from its top left corner.
    """

    points: np.ndarray
    rgb: np.ndarray
    values: dict[str, np.ndarray]
    uv: np.ndarray


class ScanSurface:
    """The surface of a colored scan: one vertex per pixel with a return, in reading order, and the faces between them.

    Parameters
    ----------
    scan : Scan
    rgb : (H, W, 3) uint8 or None
        sRGB of every pixel; None where only the surface's size is of interest.
    values : dict of (H, W) float or int, optional
        What else is known of every pixel, by a name of lower-case letters, digits and ``_``.
    max_incidence_deg : float
        As in `grid_mesh`.
    split_seam : bool
        Give a full turn its first column of vertices once more at the end, with a place right of the image for the
        faces across the seam. An image on the surface needs it.

    Attributes
    ----------
    name : str
    shape : (H, W)
        Of the scan's grid.
    pose : (4, 4) float64
        Scanner's frame to world.
    value_types : dict of numpy dtype
        float32 or int32, by the names of what every vertex has: ``reflectance``, ``range``, ``grid_row``, ``grid_col``
        and those of ``values``.
    vertex_count : int

    Examples
    --------
    >>> from reflcolor_addon import ScanSurface, read_scans
    >>> scan = read_scans("garage.ptx")[0]
    >>> ScanSurface(scan, None).vertex_count == int(scan.valid.sum())
    True
    """

    def __init__(
        self,
        scan: Scan,
        rgb: np.ndarray | None,
        values: Mapping[str, np.ndarray] | None = None,
        *,
        max_incidence_deg: float = MAX_INCIDENCE_DEG,
        split_seam: bool = False,
    ) -> None:
        self.scan, self.name, self.shape, self.pose = scan, scan.name, scan.shape, scan.pose
        self._rgb, self._max_incidence_deg = rgb, max_incidence_deg
        self._split = split_seam and scan.full_turn
        self._values = {"reflectance": scan.reflectance, **(values or {})}
        whole = {name: np.asarray(grid).dtype.kind in "iub" for name, grid in self._values.items()}
        self.value_types = {name: np.dtype(np.int32 if whole[name] else np.float32) for name in self._values}
        self.value_types |= {"range": np.dtype(np.float32)}
        self.value_types |= dict.fromkeys(("grid_row", "grid_col"), np.dtype(np.int32))
        # Index of each row's first vertex, and behind the last one that of the seam's first.
        self._first = np.concatenate([[0], np.cumsum(np.count_nonzero(scan.valid, axis=1))])
        self.vertex_count = int(self._first[-1]) + self._split * int(np.count_nonzero(scan.valid[:, 0]))

    @property
    def has_colors(self):
        """Whether its vertices can be handed out."""
        return self._rgb is not None

    @cached_property
    def _mask(self):
        return face_mask(self.scan, self._max_incidence_deg)

    @cached_property
    def center(self):
        """(3,) float64, what single-precision coordinates are best measured from; see `local_center`."""
        return local_center(self.scan)

    @cached_property
    def face_count(self):
        """How many faces of four corners there are."""
        return int(np.count_nonzero(self._mask))

    @property
    def triangle_count(self):
        """How many triangles these are cut into."""
        return 2 * self.face_count

    def vertex_blocks(self):
        """Yield a VertexBlock of every strip of the grid."""
        height, width = self.scan.shape
        for strip in row_strips(height, width):
            yield self._vertex_block(strip, slice(None))
        if self._split:
            yield self._vertex_block(slice(0, height), slice(0, 1), width)

    def face_blocks(self):
        """Yield (F, 4) int32 vertices of the faces of every strip, counterclockwise as seen from the scanner."""
        for strip in row_strips(len(self._mask), self.shape[1]):
            yield quads_of(self._mask[strip], self._closed_vertices(slice(strip.start, strip.stop + 1)))

    def triangle_blocks(self):
        """Yield (2 F, 3) int32, each face of `face_blocks` cut along the shorter of its diagonals."""
        for strip, quads in zip(row_strips(len(self._mask), self.shape[1]), self.face_blocks(), strict=True):
            mask = self._mask[strip]
            a, b, c, d = self._corners(mask, strip.start)
            first, second = _squares(c - a)[mask], _squares(d - b)[mask]
            halves = quads[:, [0, 1, 2, 0, 2, 3]]
            other = first > second
            halves[other] = quads[other][:, [0, 1, 3, 1, 2, 3]]
            yield halves.reshape(-1, 3)

    def loose_blocks(self):
        """Yield (N,) int32, the vertices that are in no face, of every strip."""
        for strip in row_strips(*self.shape):
            yield self._vertices(strip)[self.scan.valid[strip] & ~self._in_faces(strip)]

    def normal_blocks(self):
        """Yield (N, 3) float32 unit normals of the vertices of `vertex_blocks`.

        They are the means of the adjoining faces' normals, weighted by area. A vertex in no face looks at the scanner.
        """
        scan, seam = self.scan, []
        for strip in row_strips(*self.shape):
            sums, valid = self._normals(strip).astype(np.float64), scan.valid[strip]
            # Points at the scanner itself have no direction.
            towards = np.where(_squares(scan.points[strip])[..., None] > 0, -scan.points[strip], [0.0, 0.0, 1.0])
            normals = np.where(_squares(sums)[..., None] > 0, sums, towards)[valid]
            yield (normals / np.sqrt(_squares(normals))[:, None]).astype(np.float32)
            seam.append(normals[np.nonzero(valid)[1] == 0])
        if self._split:
            yield np.concatenate(seam)

    def _vertex_block(self, rows, cols, cols_to_the_right=0):
        scan, place = self.scan, (rows, cols)
        valid = scan.valid[place]
        height, width = self.shape
        row, col = (index.astype(np.int32) for index in np.nonzero(valid))
        row += rows.start
        points = scan.points[place][valid]
        values = {name: np.asarray(grid[place][valid], self.value_types[name]) for name, grid in self._values.items()}
        values |= {"range": np.sqrt(_squares(points)).astype(np.float32), "grid_row": row, "grid_col": col}
        uv = np.stack([(col + (cols_to_the_right + 0.5)) / width, (row + 0.5) / height], axis=1).astype(np.float32)
        return VertexBlock(points=points, rgb=self._rgb[place][valid], values=values, uv=uv)

    def _vertices(self, rows):
        """(h, W) int32 index of each pixel's vertex; anything where there is none."""
        counted = np.cumsum(self.scan.valid[rows], dtype=np.int32) + np.int32(self._first[rows.start] - 1)
        return counted.reshape(-1, self.scan.shape[1])

    def _closed_vertices(self, rows):
        """The same, with those of the seam at the right where the scan is a full turn."""
        vertices, first = self._vertices(rows), self.scan.valid[: rows.stop, 0]
        if not self.scan.full_turn:
            return vertices
        seam = vertices[:, 0]
        if self._split:
            seam = (self._first[-1] - 1 + np.cumsum(first)[rows]).astype(np.int32)
        return np.concatenate([vertices, seam[:, None]], axis=1)

    def _corners(self, mask, top):
        """Four (h, W - 1 or W, 3) float64 arrays: the points at the corners of squares below a row, and right of it."""
        points = self.scan.points[top : top + len(mask) + 1]
        if self.scan.full_turn:
            points = np.concatenate([points, points[:, :1]], axis=1)
        return [points[down : down + len(mask), right : right + mask.shape[1]] for down, right in CORNERS]

    def _in_faces(self, strip):
        """(h, W) bool: which pixels of a strip are a corner of a face."""
        first, mask = self._around(strip)
        found = np.zeros((len(mask) + 1, self.scan.shape[1] + 1), bool)
        for down, right in CORNERS:
            found[down : down + len(mask), right : right + mask.shape[1]] |= mask
        found[:, 0] |= found[:, -1]
        return found[strip.start - first :][: strip.stop - strip.start, :-1]

    def _normals(self, strip):
        """(h, W, 3) float32: at every pixel of a strip the sum of its faces' normals, each as long as its area."""
        first, mask = self._around(strip)
        a, b, c, d = self._corners(mask, first)
        normals = _cross((c - a).astype(np.float32), (d - b).astype(np.float32))
        normals[~mask] = 0
        sums = np.zeros((len(mask) + 1, self.scan.shape[1] + 1, 3), np.float32)
        for down, right in CORNERS:
            sums[down : down + len(mask), right : right + mask.shape[1]] += normals
        sums[:, 0] += sums[:, -1]
        return sums[strip.start - first :][: strip.stop - strip.start, :-1]

    def _around(self, strip):
        """The first row of faces that a strip of pixels is in, and their mask."""
        first = max(strip.start - 1, 0)
        return first, self._mask[first : strip.stop]


def _squares(vectors):
    return np.einsum("...i,...i->...", vectors, vectors)


def _cross(a, b):
    result = np.empty_like(a)
    for axis in range(3):
        y, z = (axis + 1) % 3, (axis + 2) % 3
        result[..., axis] = a[..., y] * b[..., z] - a[..., z] * b[..., y]
    return result
