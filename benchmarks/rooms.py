"""Simulated archives: rooms of random size and furniture, painted at random, scanned and photographed exactly."""

from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from reflcolor_addon.matching.models import Camera, camera_axes
from reflcolor_addon.scan.scan import Scan

PAINTS = ("squares", "patches", "stones")
_HEIGHT_M = 1.5
_NEAREST_M, _USUAL_M = 0.3, 1.2


class Room:
    """A room; the same number always gives the same one.

    Parameters
    ----------
    number : int
    paint : str
        Of `PAINTS`: "squares" of one size on each surface, as tiles are; "patches", rectangles of many sizes; or
        "stones", patches with edges in all directions. Squares on the walls of different rooms have the same edges.
    """

    def __init__(self, number, paint="squares"):
        rng = np.random.default_rng((number, 1))
        self._number = number
        self._size = width, depth, height = rng.uniform(4, 9), rng.uniform(4, 9), rng.uniform(2.6, 4)
        faces = _box((0, 0, height / 2), self._size)
        for _ in range(rng.integers(4, 10)):
            size = rng.uniform((0.3, 0.3, 0.4), (1.8, 1.2, 2.2))
            x, y = (rng.uniform(-free, free) for free in ((width - size[0]) / 2, (depth - size[1]) / 2))
            # The scanner and the cameras stand in the middle.
            if abs(x) > size[0] / 2 + 0.7 or abs(y) > size[1] / 2 + 0.7:
                faces += _box((x, y, size[2] / 2), size)
        for _ in range(rng.integers(12, 20)):
            faces.append(self._on_a_wall(rng))
        self._faces = [(*face, *_painted(rng, face, paint)) for face in faces]

    @property
    def depth_m(self):
        """How far it is from the front wall to the back wall."""
        return self._size[1]

    @property
    def cells_m(self):
        """The size of the squares that its walls, its floor and its ceiling are painted in, where these are squares."""
        return [round(float(np.median(np.diff(pattern.cuts[0]))), 2) for *_, pattern, _, _ in self._faces[:6]]

    def _on_a_wall(self, rng):
        """A door, a window or a painting."""
        width, depth, height = self._size
        own, tall, wall = rng.uniform(0.4, 1.6), rng.uniform(0.4, 1.8), rng.integers(4)
        low, side = rng.uniform(0.2, max(0.3, height - tall - 0.2)), 1 if wall % 2 else -1
        if wall < 2:
            corner, along = (rng.uniform(-width / 2, width / 2 - own), side * (depth / 2 - 0.02), low), (own, 0, 0)
        else:
            corner, along = (side * (width / 2 - 0.02), rng.uniform(-depth / 2, depth / 2 - own), low), (0, own, 0)
        return np.array(corner, float), np.array(along, float), np.array((0, 0, tall), float)

    def hits(self, origin, rays):
        """Where rays meet the room.

        Parameters
        ----------
        origin : (3,) array
            Meters.
        rays : (..., 3) array
            Of length 1.

        Returns
        -------
        distance : (...) array
            Meters; infinite where a ray meets nothing.
        light : (..., 3) array
            0..1, linear.
        reflectance : (...) array
        """
        nearest, light = np.full(rays.shape[:-1], np.inf), np.zeros(rays.shape)
        reflectance = np.zeros(rays.shape[:-1])
        for corner, first, second, pattern, paint, infrared in self._faces:
            normal = np.cross(first, second)
            normal /= np.linalg.norm(normal)
            with np.errstate(divide="ignore", invalid="ignore"):
                distance = ((corner - origin) @ normal) / (rays @ normal)
                place = origin + distance[..., None] * rays - corner
                along = [place @ side / np.linalg.norm(side) for side in (first, second)]
            met = (distance > 1e-6) & (distance < nearest)
            for length, side in zip(along, (first, second), strict=True):
                met &= (length >= 0) & (length <= np.linalg.norm(side))
            patch = pattern.at(*(length[met] for length in along))
            # Floors and ceilings are lit otherwise than walls.
            shade = 0.55 + 0.27 * abs(normal[0]) + 0.2 * abs(normal[2])
            light[met], reflectance[met] = paint[patch] * shade, infrared[patch]
            nearest[met] = distance[met]
        return nearest, light, reflectance

    def scan(self, rows=80, columns=130, step_deg=0.6, place=(0.0, 0.0), name="room"):
        """The room as a scanner sees it that stands 1.5 m above the floor and looks ahead."""
        azimuth = np.radians((np.arange(columns) - (columns - 1) / 2) * step_deg)
        azimuth, elevation = np.meshgrid(azimuth, np.radians(((rows - 1) / 2 - np.arange(rows)) * step_deg - 4))
        level = np.cos(elevation)
        rays = np.stack([np.sin(azimuth) * level, np.cos(azimuth) * level, np.sin(elevation)], axis=-1)
        distance, light, reflectance = self.hits(np.array([*place, _HEIGHT_M]), rays)
        valid = np.isfinite(distance)
        grain = np.random.default_rng((self._number, 2)).normal(0, 0.015, valid.shape)
        return Scan(
            name=name,
            points=rays * np.where(valid, distance, 0)[..., None],
            reflectance=np.where(valid, reflectance + grain, 0),
            valid=valid,
            color=np.uint8(255 * np.clip(light, 0, 1)),
        )

    def photo(self, number, width=240, height=180):
        """A photo of the room, taken up to 0.6 m from the middle, about straight ahead: (height, width, 3) uint8."""
        rng = np.random.default_rng((self._number, 3, number))
        _, light = self._taken(rng, width, height)
        light = np.clip(light * rng.uniform(0.7, 1.2) * rng.uniform(0.9, 1.1, 3), 0, 1)
        return np.uint8(255 * np.clip(light ** (1 / 2.2) + rng.normal(0, 0.01, light.shape), 0, 1))

    def camera(self, number, width=240, height=180, place=(0.0, 0.0)):
        """The camera of that `photo`, as a scanner at this place sees it."""
        taken, _ = self._taken(np.random.default_rng((self._number, 3, number)), width, height)
        return replace(taken, center=taken.center - [*place, _HEIGHT_M])

    def _taken(self, rng, width, height):
        """A camera in the room, and the light (height, width, 3) that it sees."""
        while True:
            turn, away = rng.uniform(0, 2 * np.pi), rng.uniform(0.1, 0.6)
            place = np.array([away * np.cos(turn), away * np.sin(turn), rng.uniform(1.3, 1.75)])
            axes = camera_axes(rng.uniform(-20, 20), rng.uniform(-10, 2), rng.uniform(-2, 2))
            focal = rng.uniform(0.55, 0.85) * max(width, height)
            x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
            rays = np.stack([x, y, np.full(x.shape, focal)], axis=-1) @ axes
            distance, light, _ = self.hits(place, rays / np.linalg.norm(rays, axis=-1, keepdims=True))
            # Nobody photographs a wall right before the lens.
            if distance.min() > _NEAREST_M and np.median(distance) > _USUAL_M:
                return Camera(axes, place, focal, 0.0, width, height), light


def _box(center, size):
    """The faces of a box: a corner and two sides of each."""
    low = np.array(center, float) - np.array(size) / 2
    x, y, z = np.diag(np.array(size, float))
    return [(low, x, z), (low + y, x, z), (low, y, z), (low + x, y, z), (low, x, y), (low + z, x, y)]


class _Grid:
    """Rectangles that end at ``cuts`` along both sides, in meters."""

    def __init__(self, cuts):
        self.cuts = cuts

    def at(self, *along):
        """The number of the rectangle at each place."""
        row, column = (np.searchsorted(cut, length, "right") for cut, length in zip(self.cuts, along, strict=True))
        return row * (len(self.cuts[1]) + 1) + column


class _Stones:
    """Patches around ``centers`` (N, 2), meters: every place belongs to the nearest."""

    def __init__(self, centers):
        self._tree = KDTree(centers)

    def at(self, *along):
        """The number of the patch at each place."""
        return self._tree.query(np.stack(along, axis=-1))[1]


def _painted(rng, face, how):
    """The pattern of a face, the colors of its patches, and their reflectance in infrared, which is its own."""
    cell = rng.choice([0.25, 0.4, 0.6])
    shape = tuple(int(np.linalg.norm(side) / cell) + 1 for side in face[1:])
    base, spread = rng.uniform(0.15, 0.9, 3), rng.uniform(0.1, 0.3)
    paint = base + spread * rng.standard_normal((*shape, 1)) + 0.1 * rng.standard_normal((*shape, 3))
    infrared = rng.uniform(0.2, 0.9) + spread * rng.standard_normal(shape)
    cuts = [cell * np.arange(1, count) for count in shape]
    lengths = [np.linalg.norm(side) for side in face[1:]]
    pattern = _Grid(cuts)
    # As many patches as there are squares.
    if how == "patches":
        sizes = [rng.uniform(0.2, 1.8, count) for count in shape]
        pattern = _Grid([np.cumsum(own)[:-1] * length / own.sum() for own, length in zip(sizes, lengths, strict=True)])
    elif how == "stones":
        pattern = _Stones(rng.uniform(0, lengths, (infrared.size, 2)))
    return pattern, np.clip(paint, 0.03, 1).reshape(-1, 3), np.clip(infrared, 0.02, 1).ravel()
