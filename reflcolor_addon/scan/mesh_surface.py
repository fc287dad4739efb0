"""A colored mesh of any vertices and faces, edited or made lighter, to be written as a `ScanSurface` is."""

from dataclasses import dataclass

import numpy as np

from .surface import VertexBlock

_BLOCK = 1 << 18


@dataclass(frozen=True, eq=False, kw_only=True)
class SplitMesh:
    """A mesh with one place on an image for each of N vertices.

    Parameters
    ----------
    vertex : (N,) int
        The vertex of the mesh that each is.
    same : (N,) int
        The first of those that are the same vertex.
    uv : (N, 2) float32
        Place in the image, 0..1 from its top left corner.
    triangles : (T, 3) int32
    """

    vertex: np.ndarray
    same: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


def split_at_seams(count, triangles, uv):
    """Return the SplitMesh of a mesh of so many vertices.

    Parameters
    ----------
    count : int
    triangles : (T, 3) int
    uv : (T, 3, 2) float32
        Of the corners, 0..1 from the image's bottom left corner, as Blender counts.
    """
    corners, places = triangles.ravel(), uv.reshape(-1, 2) * np.float32([1, -1]) + np.float32([0, 1])
    own = np.zeros((count, 2), np.float32)
    # Backwards, so that the first corner of a vertex decides.
    own[corners[::-1]] = places[::-1]
    other = np.flatnonzero((places != own[corners]).any(axis=1))
    keys = np.column_stack([corners[other], places[other].view(np.int32)])
    added, place = np.unique(keys, axis=0, return_inverse=True)
    numbers = corners.astype(np.int32)
    numbers[other] = count + place.ravel()
    vertex = np.concatenate([np.arange(count), added[:, 0]])
    return SplitMesh(
        vertex=vertex,
        same=vertex,
        uv=np.concatenate([own, np.ascontiguousarray(added[:, 1:], np.int32).view(np.float32)]),
        triangles=numbers.reshape(-1, 3),
    )


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
    same : (N,) int, optional
        Each vertex itself, or one at the same place that it shares its normal with.
    """

    has_colors = True

    def __init__(self, *, name, shape, pose, center, points, rgb, values, faces, triangles, uv=None, same=None):
        self.name, self.shape, self.pose, self.center = name, shape, pose, center
        self._points, self._rgb, self._values, self._uv = points, rgb, values, uv
        self._faces, self._triangles, self._same = faces, np.asarray(triangles, np.int32), same
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
        corners = (self._triangles if self._same is None else self._same[self._triangles]).ravel()
        sums = np.stack(
            [np.bincount(corners, np.repeat(normals[:, axis], 3), self.vertex_count) for axis in range(3)], axis=1
        )
        if self._same is not None:
            sums = sums[self._same]
        length = np.sqrt(np.einsum("ij,ij->i", sums, sums))
        loose = ~(length > 0)
        sums[loose] = -self._points[loose]
        sums[(sums == 0).all(axis=1)] = 0, 0, 1
        normals = (sums / np.sqrt(np.einsum("ij,ij->i", sums, sums))[:, None]).astype(np.float32)
        for part in self._parts():
            yield normals[part]

    def _parts(self):
        return [slice(start, start + _BLOCK) for start in range(0, self.vertex_count, _BLOCK)]
