"""The surface of a scan: its grid of pixels as quads."""

from dataclasses import dataclass

import numpy as np

MAX_INCIDENCE_DEG = 88.0


@dataclass(frozen=True, eq=False, kw_only=True)
class GridMesh:
    """Vertices and faces of a scan's grid.

    Parameters
    ----------
    rows, cols : (N,) int32
        Pixel of every vertex, in reading order: one vertex per pixel with a return.
    quads : (F, 4) int32
        Vertex indices, counterclockwise as seen from the scanner.
    uv : (F, 4, 2) float32
        Place of every corner in the scan's image, 0..1 from its bottom left corner. A face across the seam of a full
        turn goes on beyond 1.
    """

    rows: np.ndarray
    cols: np.ndarray
    quads: np.ndarray
    uv: np.ndarray


def grid_mesh(scan, max_incidence_deg=MAX_INCIDENCE_DEG):
    """Join neighboring pixels of a scan to faces.

    A face is left out where one of its four corners has no return, or where one of its edges is a jump from one
    surface to another: steeper against the viewing ray than a surface seen at ``max_incidence_deg``. A full-turn scan
    closes its seam.

    Parameters
    ----------
    scan : Scan
    max_incidence_deg : float
        Largest angle in degrees, 0 to 90, between the viewing ray and the normal of a surface that is kept.

    Returns
    -------
    GridMesh
    """
    height, width = scan.shape
    # A full turn gets its first column once more at the right.
    columns = np.arange(width + 1) % width if scan.full_turn else np.arange(width)
    valid, points = scan.valid[:, columns], scan.points[:, columns]
    across = valid[:, :-1] & valid[:, 1:] & ~_is_jump(points[:, :-1], points[:, 1:], max_incidence_deg)
    down = valid[:-1] & valid[1:] & ~_is_jump(points[:-1], points[1:], max_incidence_deg)
    row, col = np.nonzero(across[:-1] & across[1:] & down[:, :-1] & down[:, 1:])

    vertex = np.full(scan.shape, -1, np.int32)
    rows, cols = np.nonzero(scan.valid)
    vertex[rows, cols] = np.arange(rows.size)
    corner_rows = np.stack([row, row + 1, row + 1, row], axis=1)
    corner_cols = np.stack([col, col, col + 1, col + 1], axis=1)
    uv = np.stack([(corner_cols + 0.5) / width, 1 - (corner_rows + 0.5) / height], axis=-1)
    return GridMesh(
        rows=rows.astype(np.int32),
        cols=cols.astype(np.int32),
        quads=vertex[corner_rows, columns[corner_cols]].reshape(-1, 4),
        uv=uv.astype(np.float32),
    )


def _is_jump(p, q, max_incidence_deg):
    """Whether the edge between two (..., 3) points is nearly parallel to the viewing ray to its middle."""
    edge, ray = q - p, q + p
    along = np.abs(np.einsum("ijk,ijk->ij", edge, ray))
    lengths = np.sqrt(np.einsum("ijk,ijk->ij", edge, edge) * np.einsum("ijk,ijk->ij", ray, ray))
    return along > np.sin(np.radians(max_incidence_deg)) * lengths
