"""The surface of a scan: its grid of pixels as quads."""

from dataclasses import dataclass

import numpy as np

MAX_INCIDENCE_DEG = 88.0
_STRIP_PIXELS = 1 << 18


def row_strips(height, width):
    """Return slices of the rows of a grid, to be processed one after the other, so that a large scan needs no further
    array of doubles."""
    step = max(1, _STRIP_PIXELS // max(1, width))
    return [slice(top, min(top + step, height)) for top in range(0, height, step)]


@dataclass(frozen=True, eq=False, kw_only=True)
class GridMesh:
    """Vertices and faces of a scan's grid.

    Parameters
    ----------
    rows, cols : (N,) int32
        Pixel of every vertex, in reading order: one vertex per pixel with a return.
    quads : (F, 4) int32
        Vertex indices, counterclockwise as seen from the scanner.
    edges : (E, 2) int32
        Vertex indices; every edge of a face once.
    face_edges : (F, 4) int32
        Index of the edge from every corner of a face to its next one.
    uv : (F, 4, 2) float32
        Place of every corner in the scan's image, 0..1 from its bottom left corner. A face across the seam of a full
        turn goes on beyond 1.
    """

    rows: np.ndarray
    cols: np.ndarray
    quads: np.ndarray
    edges: np.ndarray
    face_edges: np.ndarray
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
    mask = face_mask(scan, max_incidence_deg)
    rows, cols = (index.astype(np.int32) for index in np.nonzero(scan.valid))
    vertex = np.empty((height, mask.shape[1] + 1), np.int32)
    vertex[:, :width][scan.valid] = np.arange(rows.size, dtype=np.int32)
    if scan.full_turn:
        vertex[:, width] = vertex[:, 0]
    row, col = (index.astype(np.int32) for index in np.nonzero(mask))
    uv = np.empty((row.size, 4, 2), np.float32)
    for corner, (down, right) in enumerate(CORNERS):
        uv[:, corner, 0] = (col + (right + 0.5)) / width
        uv[:, corner, 1] = 1 - (row + (down + 0.5)) / height
    edges, face_edges = _edges_of(mask, vertex, closed=scan.full_turn)
    quads = quads_of(mask, vertex)
    return GridMesh(rows=rows, cols=cols, quads=quads, edges=edges, face_edges=face_edges, uv=uv)


CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Rows down and columns to the right of each corner of a face, counterclockwise as seen from the scanner."""


def face_mask(scan, max_incidence_deg=MAX_INCIDENCE_DEG):
    """Return which squares of four neighboring pixels are a face; see `grid_mesh`.

    Returns
    -------
    (H - 1, W - 1) bool, or (H - 1, W) for a full turn
        At the square's upper left pixel.
    """
    height, width = scan.shape
    # A full turn gets its first column once more at the right.
    columns = np.arange(width + 1) % width if scan.full_turn else slice(None)
    mask = np.zeros((max(height - 1, 0), width - (not scan.full_turn)), bool)
    for rows in row_strips(height - 1, width):
        strip = slice(rows.start, rows.stop + 1)
        valid, points = scan.valid[strip, columns], scan.points[strip, columns]
        across = valid[:, :-1] & valid[:, 1:] & ~is_jump(points[:, :-1], points[:, 1:], max_incidence_deg)
        down = valid[:-1] & valid[1:] & ~is_jump(points[:-1], points[1:], max_incidence_deg)
        mask[rows] = across[:-1] & across[1:] & down[:, :-1] & down[:, 1:]
    return mask


def quads_of(mask, vertex):
    """Return the (F, 4) int32 vertices of the faces of a grid, or of a strip of it.

    Parameters
    ----------
    mask : (H - 1, W - 1) or (H - 1, W) bool
        From `face_mask`.
    vertex : (H, W) or (H, W + 1) int32
        Index of each pixel's vertex, anything where there is none; the first column once more at the right for a full
        turn.
    """
    height, width = mask.shape
    quads = np.empty((np.count_nonzero(mask), 4), np.int32)
    for corner, (down, right) in enumerate(CORNERS):
        quads[:, corner] = vertex[down : down + height, right : right + width][mask]
    return quads


def _edges_of(mask, vertex, *, closed):
    """``edges`` and ``face_edges`` of `GridMesh`: edges along rows first, then those along columns."""
    height, width = mask.shape
    across, down = np.zeros((height + 1, width), bool), np.zeros((height, width + 1), bool)
    across[:-1] |= mask
    across[1:] |= mask
    down[:, :-1] |= mask
    down[:, 1:] |= mask
    if closed:
        down[:, 0] |= down[:, -1]
        down[:, -1] = False
    numbers = np.cumsum(np.concatenate([across.ravel(), down.ravel()]), dtype=np.int32) - 1
    of_across, of_down = numbers[: across.size].reshape(across.shape), numbers[across.size :].reshape(down.shape)
    if closed:
        of_down[:, -1] = of_down[:, 0]
    edges = np.empty((np.count_nonzero(across) + np.count_nonzero(down), 2), np.int32)
    for end in (0, 1):
        edges[:, end] = np.concatenate([vertex[:, end : end + width][across], vertex[end : end + height][down]])
    face_edges = np.empty((np.count_nonzero(mask), 4), np.int32)
    for corner, number in enumerate((of_down[:, :-1], of_across[1:], of_down[:, 1:], of_across[:-1])):
        face_edges[:, corner] = number[mask]
    return edges, face_edges


def is_jump(p, q, max_incidence_deg):
    """Whether the edge between two (..., 3) points is nearly parallel to the viewing ray to its middle."""
    edge, ray = q - p, q + p
    along = np.abs(np.einsum("ijk,ijk->ij", edge, ray))
    lengths = np.sqrt(np.einsum("ijk,ijk->ij", edge, edge) * np.einsum("ijk,ijk->ij", ray, ray))
    return along > np.sin(np.radians(max_incidence_deg)) * lengths
