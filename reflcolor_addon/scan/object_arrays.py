"""A scan's mesh and images as the arrays that Blender stores, made outside Blender's main thread."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .georeference import local_center, pose_at
from .grid_mesh import MAX_INCIDENCE_DEG, grid_mesh, row_strips
from .normalization import normalize


@dataclass(eq=False, kw_only=True)
class ObjectArrays:
    """What an object of Blender is made of: N vertices and F faces.

    A scan's own mesh has one vertex per pixel with a return, in reading order. An array that has served is let go, so
    that a large scan is not in memory twice.

    Parameters
    ----------
    name : str
    source : Path or None
        As the scan has them.
    shape : (H, W)
    pixel_aspect : float
        Width of a pixel over its height.
    units_per_meter : float
        Of the coordinates.
    max_incidence_deg : float
        As in `grid_mesh`.
    center : (3,) float64
        What the coordinates are measured from: meters, in the scanner's frame.
    pose : (4, 4) float64
        Coordinates to world, but in meters.
    coordinates : (3 N,) float32
    corners : (K F,) int32
        Vertices of the faces, one face after the other.
    edges : (2 E,) int32
        Vertices of the edges, one edge after the other.
    corner_edges : (K F,) int32
        The edge from every corner to the next one of its face.
    sides : int
        Corners of each face: K.
    uv : (2 K F,) float32
        Of the corners.
    values : dict of (N,) float32 or int32
        By the attribute's name.
    gray, scanned : (N, 3) uint8
        The reflectance and the scan's own color; ``scanned`` is None where it has none.
    reflectance_image, range_image : (H, W) float32 or None
        0..1; None where the object is to have none.
    """

    name: str
    source: Path | None
    shape: tuple[int, int]
    pixel_aspect: float
    units_per_meter: float
    max_incidence_deg: float
    center: np.ndarray
    pose: np.ndarray
    coordinates: np.ndarray
    corners: np.ndarray
    edges: np.ndarray
    corner_edges: np.ndarray
    sides: int
    uv: np.ndarray
    values: dict[str, np.ndarray]
    gray: np.ndarray
    scanned: np.ndarray | None
    reflectance_image: np.ndarray | None
    range_image: np.ndarray | None

    def taken(self, name):
        """Return one of the arrays, which this object holds no longer."""
        array = getattr(self, name)
        setattr(self, name, None)
        return array


def on_grid(values, place, shape, empty=0):
    """Return values of some pixels as an array over the whole grid.

    Parameters
    ----------
    values : (N, ...) array
    place : ((N,) int, (N,) int)
        Rows and columns.
    shape : (H, W)
    empty : number
        The value of all other pixels.

    Returns
    -------
    (H, W, ...) array
        Of the same dtype.
    """
    grid = np.full((*shape, *values.shape[1:]), empty, values.dtype)
    grid[place] = values
    return grid


def at_places(image, place):
    """Return the (N, ...) values of an (H, W, ...) image at some pixels: (N,) int32 rows and (N,) int32 columns."""
    rows, columns = place
    # Far faster than by rows and columns.
    return image.reshape(-1, *image.shape[2:]).take(rows * np.int32(image.shape[1]) + columns, axis=0)


def local_coordinates(scan, center, units_per_meter=1.0):
    """Return (N, 3) float32, where the returns of a scan are, measured from a (3,) center, in reading order."""
    strips = [
        ((scan.points[rows][scan.valid[rows]] - center) * units_per_meter).astype(np.float32)
        for rows in row_strips(*scan.shape)
    ]
    return np.concatenate(strips)


def object_arrays(scan, *, units_per_meter=1.0, max_incidence_deg=MAX_INCIDENCE_DEG):
    """Return the ObjectArrays of a scan.

    Parameters
    ----------
    scan : Scan
    units_per_meter : float
        Blender's units in a meter.
    max_incidence_deg : float
        As in `grid_mesh`.
    """
    mesh, valid = grid_mesh(scan, max_incidence_deg), scan.valid
    center = local_center(scan)
    luminance, _ = normalize(scan.reflectance, valid)
    range_image, _ = normalize(scan.range, valid)
    return ObjectArrays(
        name=scan.name,
        source=scan.source,
        shape=scan.shape,
        pixel_aspect=scan.pixel_aspect,
        units_per_meter=units_per_meter,
        max_incidence_deg=max_incidence_deg,
        center=center,
        pose=pose_at(scan, center),
        coordinates=local_coordinates(scan, center, units_per_meter).ravel(),
        corners=mesh.quads.ravel(),
        edges=mesh.edges.ravel(),
        corner_edges=mesh.face_edges.ravel(),
        sides=4,
        uv=mesh.uv.ravel(),
        values={
            "reflectance": scan.reflectance[valid],
            "range": scan.range[valid].astype(np.float32),
            "grid_row": mesh.rows,
            "grid_col": mesh.cols,
        },
        gray=np.repeat(np.rint(luminance).astype(np.uint8)[valid, None], 3, axis=1),
        scanned=None if scan.color is None else scan.color[valid],
        reflectance_image=luminance / 255,
        range_image=range_image / 255,
    )
