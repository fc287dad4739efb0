"""A colored mesh of any vertices and faces, edited or made lighter, to be written as a `ScanSurface` is."""

import numpy as np

from .surface import VertexBlock

_BLOCK = 1 << 18


class MeshSurface:
    """A colored mesh.

    Parameters
    ----------
    name : str
    shape : (H, W)
        Of the scan's grid that it was made of.
    pose : (4, 4) float64
        Scanner's frame to world, meters.
    center : (3,) float64
        What single-precision coordinates are best measured from, in the scanner's frame.
    points : (N, 3) float64
        Meters, in the scanner's frame.
    rgb : (N, 3) uint8
        sRGB.
    values : dict of (N,) float32 or int32
        By the attribute's name.
    faces : list of (F, K) int
        Faces of K corners, counterclockwise as seen from outside; one array for each number of corners.
    triangles : (T, 3) int
        The same faces, cut.
    uv : (N, 2) float32, optional
        Place in an image, 0..1 from its top left corner.
    """

    has_colors = True

    def __init__(self, *, name, shape, pose, center, points, rgb, values, faces, triangles, uv=None):
        self.name, self.shape, self.pose, self.center = name, shape, pose, center
        self._points, self._rgb, self._values, self._uv = points, rgb, values, uv
        self._faces, self._triangles = faces, np.asarray(triangles, np.int32)
        self.value_types = {name: array.dtype for name, array in values.items()}
        self.vertex_count = len(points)
        self.face_count = sum(map(len, faces))
        self.triangle_count = len(triangles)

    def vertex_blocks(self):
        """Yield a VertexBlock after the other."""
        for part in self._parts():
            yield VertexBlock(
                points=self._points[part],
                rgb=self._rgb[part],
                values={name: array[part] for name, array in self._values.items()},
                uv=np.zeros((len(self._points[part]), 2), np.float32) if self._uv is None else self._uv[part],
            )

    def face_blocks(self):
        """Yield (F, K) int32 faces."""
        for faces in self._faces:
            for start in range(0, len(faces), _BLOCK):
                yield np.asarray(faces[start : start + _BLOCK], np.int32)

    def triangle_blocks(self):
        """Yield (T, 3) int32 triangles."""
        for start in range(0, len(self._triangles), _BLOCK):
            yield self._triangles[start : start + _BLOCK]

    def loose_blocks(self):
        """Yield (N,) int32, the vertices that are in no face."""
        used = np.zeros(self.vertex_count, bool)
        used[self._triangles.ravel()] = True
        yield np.flatnonzero(~used).astype(np.int32)

    def normal_blocks(self):
        """Yield (N, 3) float32 unit normals, the means of the adjoining triangles' weighted by area.

        A vertex in no face looks at the scanner.
        """
        a, b, c = (self._points[self._triangles[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        corners = self._triangles.ravel()
        sums = np.stack(
            [np.bincount(corners, np.repeat(normals[:, axis], 3), self.vertex_count) for axis in range(3)], axis=1
        )
        length = np.sqrt(np.einsum("ij,ij->i", sums, sums))
        loose = ~(length > 0)
        sums[loose] = -self._points[loose]
        sums[(sums == 0).all(axis=1)] = 0, 0, 1
        normals = (sums / np.sqrt(np.einsum("ij,ij->i", sums, sums))[:, None]).astype(np.float32)
        for part in self._parts():
            yield normals[part]

    def _parts(self):
        return [slice(start, start + _BLOCK) for start in range(0, self.vertex_count, _BLOCK)]
