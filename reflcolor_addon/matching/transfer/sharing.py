"""What photos show of one scan, on the others of the site where those have the same surface.

A photo that shows too little of a scan to be recognized there, or that was recognized on one scan only, still tells the
colors of all that scans see twice. A scan with its observed colors is like a photo taken from its place, with the
distance of everything in it.
"""

from dataclasses import replace

import numpy as np

from ...color.observed import Observed

# How far a point may be from another scan's surface: of the distance, and in that scan's pixels.
_OFF_SHARE, _OFF_PIXELS = 0.01, 1.5
# Cosine between the normals of what is one surface.
_LEAST_COSINE = 0.5
_CHUNK_PIXELS = 1 << 18


def shared(surfaces, observed):
    """Return for every scan its `Observed` colors and, where it has none, those of other scans.

    Parameters
    ----------
    surfaces : sequence of GridSurface
        Their scans' poses place them in one world. Scans of the same pose are not known to be placed at all, and share
        nothing.
    observed : sequence of Observed or None
        Of each.

    Returns
    -------
    list of Observed or None
    """
    directions = {}
    result = []
    for number, (surface, own) in enumerate(zip(surfaces, observed, strict=True)):
        for other, colors in enumerate(observed):
            apart = not np.allclose(surface.scan.pose, surfaces[other].scan.pose)
            if other != number and colors is not None and apart:
                if other not in directions:
                    directions[other] = _Panorama(surfaces[other], colors)
                own = directions[other].added_to(own, surface)
        result.append(own)
    return result


class _Panorama:
    """A scan with its observed colors, looked at from its scanner's place."""

    def __init__(self, surface, observed):
        scan = surface.scan
        self._surface, self._observed = surface, observed
        steps = [step for step in scan.step_deg if np.isfinite(step) and step > 0]
        # Cells no finer than the coarser way of the grid, so that hardly one is empty.
        self._cell = np.radians(max(steps, default=0.1))
        self._columns = int(2 * np.pi / self._cell) + 1
        pixels = np.flatnonzero(observed.seen)
        self._pixel = np.full((int(np.pi / self._cell) + 2) * self._columns, -1, np.int64)
        points = scan.points.reshape(-1, 3)[pixels]
        # Of several in a cell the nearest one hides the others.
        order = np.argsort(-np.einsum("ij,ij->i", points, points), kind="stable")
        self._pixel[self._cells(points[order])] = pixels[order]

    def added_to(self, own, surface):
        """Return the `Observed` of another scan with what it has not seen itself."""
        scan, ours = surface.scan, self._surface.scan
        change = np.linalg.inv(ours.pose) @ scan.pose
        wanted = scan.valid if own is None else scan.valid & ~own.seen
        wanted = np.flatnonzero(wanted)
        found, source = [], []
        for start in range(0, len(wanted), _CHUNK_PIXELS):
            part = wanted[start : start + _CHUNK_PIXELS]
            points = scan.points.reshape(-1, 3)[part] @ change[:3, :3].T + change[:3, 3]
            pixel = self._pixel[self._cells(points)]
            there = pixel >= 0
            # The distance from the other scan's tangent plane: points of one surface lie between each other.
            off = ours.points.reshape(-1, 3)[pixel] - points
            normal = self._surface.normals.reshape(-1, 3)[pixel]
            distance = np.sqrt(np.einsum("ij,ij->i", points, points))
            near = distance * (_OFF_SHARE + _OFF_PIXELS * self._cell)
            own_normal = surface.normals.reshape(-1, 3)[part] @ change[:3, :3].T
            there &= np.abs(np.einsum("ij,ij->i", off, normal)) <= _OFF_SHARE * distance
            there &= np.einsum("ij,ij->i", off, off) <= near**2
            there &= np.abs(np.einsum("ij,ij->i", normal, own_normal)) >= _LEAST_COSINE
            found.append(part[there])
            source.append(pixel[there])
        found, source = np.concatenate([*found, [0][:0]]).astype(int), np.concatenate([*source, [0][:0]]).astype(int)
        if not len(found):
            return own
        if own is None:
            own = Observed(
                np.zeros((*scan.shape, 3), np.uint8),
                np.zeros(scan.shape, np.float32),
                np.full(scan.shape, -1, np.int16),
            )
        rgb, weight, photo = own.rgb.copy(), own.weight.copy(), own.photo.copy()
        rgb.reshape(-1, 3)[found] = self._observed.rgb.reshape(-1, 3)[source]
        weight.reshape(-1)[found] = self._observed.weight.reshape(-1)[source]
        photo.reshape(-1)[found] = self._observed.photo.reshape(-1)[source]
        return replace(own, rgb=rgb, weight=weight, photo=photo)

    def _cells(self, points):
        azimuth = np.arctan2(points[:, 0], points[:, 1]) % (2 * np.pi)
        elevation = np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])) + np.pi / 2
        column = np.minimum(azimuth / self._cell, self._columns - 1).astype(np.int64)
        return (elevation / self._cell).astype(np.int64) * self._columns + column
