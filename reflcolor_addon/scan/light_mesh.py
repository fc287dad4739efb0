"""A mesh of few triangles in place of a scan's own."""

from dataclasses import dataclass

import numpy as np

from .georeference import local_center, pose_at
from .mesh_surface import MeshSurface
from .normalization import normalize
from .object_arrays import ObjectArrays
from .scan import Scan


@dataclass(frozen=True, eq=False, kw_only=True)
class LightMesh:
    """N vertices and T triangles. Vertices at the right end of a full turn repeat others, and come last.

    Parameters
    ----------
    scan : Scan
    points : (N, 3) float64
        Meters, in the scanner's frame.
    places : (N, 2) float64
        Row and column in the scan's grid; columns of repeated vertices are beyond it.
    pixel : (N,) int64
        The return that is nearest to each vertex: its pixel's index in reading order.
    same : (N,) int32
        Each vertex itself, or the one that it repeats.
    triangles : (T, 3) int32
        Counterclockwise as seen from the scanner.
    whole : int
        How many triangles there were.
    """

    scan: Scan
    points: np.ndarray
    places: np.ndarray
    pixel: np.ndarray
    same: np.ndarray
    triangles: np.ndarray
    whole: int

    @property
    def uv(self):
        """(N, 2) float32, the place of every vertex in an image of the scan's grid, 0..1 from its top left corner."""
        height, width = self.scan.shape
        return ((self.places[:, ::-1] + 0.5) / [width, height]).astype(np.float32)

    @property
    def own(self):
        """How many vertices repeat no other."""
        return int(np.count_nonzero(self.same == np.arange(len(self.same))))

    def at_vertices(self, grid):
        """Return (N, ...), what the nearest return of each vertex has in an (H, W, ...) grid."""
        return grid.reshape(-1, *grid.shape[2:])[self.pixel]

    def values(self, grids):
        """Return what is known of every vertex, as `ScanSurface` has it: numbers of the nearest return.

        Parameters
        ----------
        grids : dict of (H, W) float or int
            By the name.

        Returns
        -------
        dict of (N,) float32 or int32
        """
        rows, cols = np.divmod(self.pixel, self.scan.shape[1])
        found = {"reflectance": self.at_vertices(self.scan.reflectance)}
        found |= {name: self.at_vertices(np.asarray(grid)) for name, grid in grids.items()}
        # A vertex that was moved has a range of its own.
        found |= {"range": np.linalg.norm(self.points, axis=1), "grid_row": rows, "grid_col": cols}
        whole = {name: values.dtype.kind in "iub" for name, values in found.items()}
        return {name: values.astype(np.int32 if whole[name] else np.float32) for name, values in found.items()}

    def surface(self, rgb, grids, *, split_seam):
        """Return the MeshSurface to be written.

        Parameters
        ----------
        rgb : (H, W, 3) uint8
        grids : dict of (H, W) float or int
            As `values` takes them.
        split_seam : bool
            Keep repeated vertices, which an image on the surface needs.
        """
        end = len(self.points) if split_seam else self.own
        triangles = self.triangles if split_seam else self.same[self.triangles]
        return MeshSurface(
            name=self.scan.name,
            shape=self.scan.shape,
            pose=self.scan.pose,
            center=local_center(self.scan),
            points=self.points[:end],
            rgb=self.at_vertices(rgb)[:end],
            values={name: values[:end] for name, values in self.values(grids).items()},
            faces=[triangles],
            triangles=triangles,
            uv=self.uv[:end],
            same=self.same[:end],
        )

    def object_arrays(self, *, units_per_meter=1.0, max_incidence_deg):
        """Return the ObjectArrays, without images of the scan's grid.

        Parameters
        ----------
        units_per_meter, max_incidence_deg : float
            As `object_arrays` takes them.
        """
        scan, own, center = self.scan, self.own, local_center(self.scan)
        corners = self.same[self.triangles]
        # From every corner to the next one of its triangle.
        ends = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        edges, corner_edges = np.unique(ends, axis=0, return_inverse=True)
        gray = np.rint(self.at_vertices(normalize(scan.reflectance, scan.valid)[0])[:own]).astype(np.uint8)
        return ObjectArrays(
            name=scan.name,
            source=scan.source,
            shape=scan.shape,
            pixel_aspect=scan.pixel_aspect,
            units_per_meter=units_per_meter,
            max_incidence_deg=max_incidence_deg,
            center=center,
            pose=pose_at(scan, center),
            coordinates=((self.points[:own] - center) * units_per_meter).astype(np.float32).ravel(),
            corners=corners.ravel(),
            edges=edges.astype(np.int32).ravel(),
            corner_edges=corner_edges.astype(np.int32).ravel(),
            sides=3,
            # Blender counts from the bottom.
            uv=(self.uv * np.float32([1, -1]) + np.float32([0, 1]))[self.triangles].ravel(),
            values={name: values[:own] for name, values in self.values({}).items()},
            gray=np.repeat(gray[:, None], 3, axis=1),
            scanned=None if scan.color is None else self.at_vertices(scan.color)[:own],
            reflectance_image=None,
            range_image=None,
        )
