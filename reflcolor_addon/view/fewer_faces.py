"""Makes a scan's mesh light: few faces that show what its many show.

Faces are made fewer in the space of the scan's grid: column, row, and the logarithm of the range, in units of a
pixel's width. There an error counts by how large it looks from the scanner, and wherever a vertex is moved, its place
on an image of the grid is known exactly. So an image lies on the light mesh as it does on the scan's own. That space is
bent so that a plane is nearly flat in it, and a circle around the scanner, such as the edge of its floor, is not
straight.
"""

import numpy as np

from ..errors import Cancelled
from ..messages import Message
from ..scan.grid_mesh import MAX_INCIDENCE_DEG, face_mask, grid_mesh
from ..scan.light_mesh import LightMesh
from .pixel_directions import pixel_directions
from .shown_surface import shown_surface
from .small_holes import nearest_kept
from .thinned_scan import on_whole_scan, thinned_scan, thinning_step

FEWEST_FACES, MOST_FACES = 100, 100_000_000
# Shares of the progress.
_FOUND, _MADE = 0.2, 0.9
# The space is bent anew for each part of about this angle around the scanner.
_BENT_RAD = np.pi / 2
_AROUND = ((0, 0), (0, 1), (1, 0), (1, 1))


def light_mesh(
    scan,
    faces,
    decimate,
    *,
    filled=True,
    drop_mixed=True,
    max_incidence_deg=MAX_INCIDENCE_DEG,
    progress=None,
    cancelled=None,
):
    """Return the LightMesh of a scan.

    Surfaces that are apart stay apart: only vertices that an edge joins are merged. Returns in no face are left out;
    so are specks that are smaller than the faces. Of a very large scan only every n-th row and column is looked at, as
    `thinning_step` says; an image of its whole grid lies on the mesh all the same.

    Parameters
    ----------
    scan : Scan
    faces : int
        How many triangles it is to have at most.
    decimate : callable
        Called as ``decimate(coordinates, corners, sizes, fixed, faces, progress=..., cancelled=...)`` with vertices
        (V, 3) float32, faces as in `ShownSurface`, and (V,) bool which vertices must stay; returns (N, 3) float32 and
        (T, 3) int32, the vertices and triangles of a lighter mesh.
    filled, drop_mixed : bool
        As in `Picture`.
    max_incidence_deg : float
        As in `grid_mesh`.
    progress, cancelled : callable, optional

    Raises
    ------
    Cancelled
        If ``cancelled()`` returned True.
    """
    options = {"filled": filled, "drop_mixed": drop_mixed, "max_incidence_deg": max_incidence_deg}
    options |= {"progress": progress, "cancelled": cancelled}
    step = thinning_step(scan.shape, faces)
    if step == 1:
        return _of_all_faces(scan, faces, decimate, **options)
    light = _of_all_faces(thinned_scan(scan, step), faces, decimate, **options)
    return on_whole_scan(light, scan, step, 2 * int(np.count_nonzero(face_mask(scan, max_incidence_deg))))


def _of_all_faces(scan, faces, decimate, *, filled, drop_mixed, max_incidence_deg, progress, cancelled):
    """The LightMesh of every row and column."""

    def within(start, end):
        return None if progress is None else lambda done, text: progress(start + (end - start) * done, text)

    shown = None
    if filled:
        options = {"drop_mixed": drop_mixed, "max_incidence_deg": max_incidence_deg}
        shown = shown_surface(scan, **options, progress=within(0, _FOUND), cancelled=cancelled)
    surface = _Surface(scan, shown, max_incidence_deg)
    whole = int((surface.sizes - 2).sum())
    if whole > faces:
        arrays = surface.coordinates(), surface.corners, surface.sizes, surface.fixed
        coordinates, triangles = decimate(*arrays, faces, progress=within(_FOUND, _MADE), cancelled=cancelled)
    else:
        coordinates, triangles = surface.coordinates(), _fans(surface.corners, surface.sizes)
    if cancelled is not None and cancelled():
        raise Cancelled
    if progress is not None:
        progress(_MADE, Message("Making the mesh lighter"))
    return surface.lightened(coordinates, triangles, whole)


def few_faces_missed(name, light, faces):
    """Return the warning for a scan whose LightMesh has more faces than were asked for."""
    return Message(
        "{scan}: has {found} faces instead of {faces}: what is left joins no more without a change of outlines",
        scan=name,
        found=len(light.triangles),
        faces=faces,
    )


class _Surface:
    """The faces of a scan in the space of its grid."""

    def __init__(self, scan, shown, max_incidence_deg):
        self._scan, (self._height, self._width) = scan, scan.shape
        self._kept = scan.valid if shown is None else scan.valid & ~shown.mixed
        mesh = grid_mesh(scan, max_incidence_deg)
        keeps = self._kept[mesh.rows, mesh.cols][mesh.quads].all(axis=1)
        places = np.stack([mesh.rows, mesh.cols], axis=1).astype(np.float64)
        ranges, corners = scan.range[scan.valid], mesh.quads[keeps].ravel()
        sizes, beyond = np.full(np.count_nonzero(keeps), 4, np.int32), (mesh.uv[keeps, :, 0] > 1).ravel()
        if shown is not None:
            # Returns are vertices already.
            vertex = np.empty(len(shown.points), np.int32)
            number = (np.cumsum(scan.valid) - 1).astype(np.int32)
            vertex[shown.measured] = number[(shown.places[shown.measured] @ [self._width, 1]).astype(np.int64)]
            added = ~shown.measured
            vertex[added] = len(places) + np.arange(np.count_nonzero(added), dtype=np.int32)
            column = shown.uv[:, 0] * self._width - 0.5
            beyond = np.concatenate([beyond, column > shown.places[shown.corners, 1] + 0.5])
            places = np.concatenate([places, shown.places[added]])
            ranges = np.concatenate([ranges, np.linalg.norm(shown.points[added], axis=1)])
            corners, sizes = np.concatenate([corners, vertex[shown.corners]]), np.concatenate([sizes, shown.sizes])
        self.sizes = sizes
        self._take(places, np.log(ranges), corners, beyond)
        steps = np.radians(scan.step_deg)
        self._steps = steps = np.where(steps > 0, steps, 1.0)
        # Pixels, or the logarithm, in the space's unit.
        self._scale = np.array([steps[1], steps[0], 1.0]) / steps[1]
        self._middle = np.median(self._logarithms) if len(self._logarithms) else 0.0
        # Whole parts of a full turn, so that both sides of its seam are bent alike.
        self._part = self._width / max(1, round(self._width * steps[1] / _BENT_RAD))

    def _take(self, places, logarithms, corners, beyond):
        """Keep the vertices that are used; those on both sides of a full turn's seam once for each side."""
        count = len(places)
        used = np.zeros(2 * count, bool)
        used[corners + count * beyond] = True
        self.corners = (np.cumsum(used) - 1).astype(np.int32)[corners + count * beyond]
        twice = used[:count] & used[count:]
        self.fixed = np.concatenate([twice[used[:count]], twice[used[count:]]])
        first, again = np.flatnonzero(used[:count]), np.flatnonzero(used[count:])
        self._places = np.concatenate([places[first], places[again] + [0, self._width]])
        self._logarithms = np.concatenate([logarithms[first], logarithms[again]])

    def coordinates(self):
        """(V, 3) float32, as the scanner sees them: to the right, up, and nearer."""
        rows, cols = self._places.T
        nearer = self._middle - self._logarithms + self._bend(self._places)
        return (np.stack([cols, -rows, nearer], axis=1) * self._scale).astype(np.float32)

    def _bend(self, places):
        """(N,) by how much nearer, as a logarithm, places (N, 2) lie in this space: a plane whose normal is an angle of
        a away has a range that is larger by -log(cos a), which is about a^2 / 2."""
        rows, cols = places.T
        across = ((cols + 0.5) % self._part - self._part / 2) * self._steps[1]
        down = (rows - (self._height - 1) / 2) * self._steps[0]
        return (across * across + down * down) / 2

    def lightened(self, coordinates, triangles, whole):
        """The LightMesh of vertices and triangles in this space."""
        # Where a speck was, a vertex is left.
        used, triangles = np.unique(triangles, return_inverse=True)
        order, same = self._repeated(coordinates[used])
        coordinates = coordinates[used][order]
        renumbered = np.empty(len(order), np.int32)
        renumbered[order] = np.arange(len(order), dtype=np.int32)
        cols, up, nearer = (coordinates.astype(np.float64) / self._scale).T
        places = np.stack([np.clip(-up, 0, self._height - 1), cols], axis=1)
        return LightMesh(
            scan=self._scan,
            points=self._rays(places) * np.exp(self._middle - nearer + self._bend(places))[:, None],
            places=places,
            pixel=self._nearest(coordinates.astype(np.float64), places),
            same=same,
            triangles=renumbered[triangles.reshape(-1, 3)],
            whole=whole,
        )

    def _repeated(self, coordinates):
        """An order with the vertices last that stand for others beyond the seam, and which ones they stand for."""
        count, given = len(coordinates), self.coordinates()[self.fixed]
        # The fixed ones are in pairs, by halves, in the same order.
        left, right = given[: len(given) // 2], given[len(given) // 2 :]
        place = {vertex.tobytes(): number for number, vertex in enumerate(coordinates)} if len(given) else {}
        pairs = [(place.get(a.tobytes()), place.get(b.tobytes())) for a, b in zip(left, right, strict=True)]
        pairs = np.array([pair for pair in pairs if None not in pair], np.int64).reshape(-1, 2)
        last = np.zeros(count, bool)
        last[pairs[:, 1]] = True
        order = np.concatenate([np.flatnonzero(~last), np.flatnonzero(last)])
        same = np.arange(count)
        same[pairs[:, 1]] = pairs[:, 0]
        renumbered = np.empty(count, np.int32)
        renumbered[order] = np.arange(count, dtype=np.int32)
        return order, renumbered[same[order]]

    def _around(self, places):
        """Rows, columns (N,) of the four pixels around each place, and their shares."""
        rows, cols = np.floor(places).astype(np.int64).T
        down, right = (places - np.floor(places)).T
        for below, beside in _AROUND:
            col = cols + beside
            col = col % self._width if self._scan.full_turn else np.clip(col, 0, self._width - 1)
            share = (down if below else 1 - down) * (right if beside else 1 - right)
            yield np.clip(rows + below, 0, self._height - 1), col, share

    def _rays(self, places):
        """(N, 3) unit vectors, between those of the pixels."""
        directions = pixel_directions(self._scan)
        rays = sum(directions[row, col] * share[:, None] for row, col, share in self._around(places))
        return rays / np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-12)

    def _nearest(self, coordinates, places):
        """(N,) the return nearest to each vertex, of the four around it; if there is none, the nearest in the image."""
        kept, scan = self._kept, self._scan
        with np.errstate(divide="ignore"):
            logarithms = np.log(np.where(kept, scan.range, 1.0))
        best, found = np.full(len(places), np.inf), np.zeros(len(places), np.int64)
        own = coordinates[:, 2] / self._scale[2] - self._bend(places)
        for row, col, _ in self._around(places):
            offset = (places[:, 1] - col + self._width / 2) % self._width - self._width / 2
            depth = self._middle - logarithms[row, col] - own
            away = np.stack([offset, places[:, 0] - row, depth], axis=1) * self._scale
            distance = np.where(kept[row, col], np.einsum("ij,ij->i", away, away), np.inf)
            nearer = distance < best
            best[nearer], found[nearer] = distance[nearer], (row * self._width + col)[nearer]
        lost = np.isinf(best)
        if lost.any():
            nearest = nearest_kept(kept).reshape(-1)
            rows, cols = np.rint(places[lost]).astype(np.int64).T
            found[lost] = nearest[np.clip(rows, 0, self._height - 1) * self._width + cols % self._width]
        return found


def _fans(corners, sizes):
    """(T, 3) int32: faces cut into triangles."""
    starts, cut = np.cumsum(sizes) - sizes, []
    for size in np.unique(sizes).tolist():
        faces = corners[starts[sizes == size][:, None] + np.arange(size)]
        cut += [faces[:, [0, corner, corner + 1]] for corner in range(1, size - 1)]
    return np.concatenate(cut).astype(np.int32) if cut else np.zeros((0, 3), np.int32)
