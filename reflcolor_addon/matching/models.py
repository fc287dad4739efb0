"""How a pixel of the scan falls into a photo: a camera for the scan's points, or a homography of the scan's grid.

Both have the same methods: ``project`` for many sites, ``projections`` of many candidates at once, ``moved`` to one.
A candidate is a row of unitless numbers, scaled so that 1 moves the picture by about a fiftieth of its size.
"""

from dataclasses import dataclass

import numpy as np

# Beyond this radius (in focal lengths, squared) the distortion polynomial is not used.
_WIDEST_SQUARED = 4.0


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera with its principal point in the middle and one radial distortion.

    Parameters
    ----------
    rotation : (3, 3) float64
        Scanner frame to camera frame (x right, y down, z forward).
    center : (3,) float64
        Meters, scanner frame.
    focal_px : float
    distortion : float
        A point at radius r (in focal lengths) is seen at r (1 + distortion r^2).
    width, height : int
        Of the photo.
    """

    rotation: np.ndarray
    center: np.ndarray
    focal_px: float
    distortion: float
    width: int
    height: int

    kind = "pose"
    ROTATION = (0, 1, 2, 6)
    """Which numbers of a candidate turn and zoom."""
    TURNED = (0, 1, 2, 6, 7)
    """The same and the lens."""
    POSE = (0, 1, 2, 3, 4, 5, 6)
    ALL = (0, 1, 2, 3, 4, 5, 6, 7)
    UNITS = np.array([0.02, 0.02, 0.02, 0.05, 0.05, 0.05, 0.05, 0.03])

    def sites(self, scan_image):
        """(h, w, 3): what `project` takes for the pixels of a `ScanImage`."""
        return scan_image.surface

    def sites_of(self, scan, rows, cols):
        """(..., 3): the same for pixels of a `Scan`."""
        return scan.points[rows, cols]

    def turns(self, scan_image):
        """(2, h, w, 3): what the next pixel to the right, and down, adds to a site."""
        return scan_image.turns

    def project(self, points):
        """Return (..., 2) pixels from the photo's top left corner, NaN behind the camera, and (...) depth in meters."""
        x, y, _, depth = self._flat(points)
        return self._bent(x, y), depth

    def seen(self, points, turns):
        """Return what `project` does and (..., 2, 2), [x or y, step]: what two steps, (2, ..., 3) meters, move a point
        in the photo."""
        x, y, ahead, depth = self._flat(points)
        moved = np.empty((*depth.shape, 2, 2))
        for step, turn in enumerate(turns):
            across, along, away = np.moveaxis(turn @ self.rotation.T, -1, 0)
            moved[..., 0, step] = (across - x * away) / ahead
            moved[..., 1, step] = (along - y * away) / ahead
        if self.distortion:
            squared = x * x + y * y
            gain = 1 + self.distortion * np.minimum(squared, _WIDEST_SQUARED)
            bent = 2 * self.distortion * (squared < _WIDEST_SQUARED)
            radial = bent[..., None] * (x[..., None] * moved[..., 0, :] + y[..., None] * moved[..., 1, :])
            moved *= gain[..., None, None]
            moved[..., 0, :] += x[..., None] * radial
            moved[..., 1, :] += y[..., None] * radial
        moved *= self.focal_px
        return self._bent(x, y), depth, moved

    def _flat(self, points):
        """Where points are seen in focal lengths from the middle, NaN behind the camera; depth, NaN there; depth."""
        right, down, depth = np.moveaxis((points - self.center) @ self.rotation.T, -1, 0)
        ahead = np.where(depth > 1e-6, depth, np.nan)
        return right / ahead, down / ahead, ahead, depth

    def _bent(self, x, y):
        """Places in focal lengths as (..., 2) pixels of the photo."""
        gain = self.focal_px * (1 + self.distortion * np.minimum(x * x + y * y, _WIDEST_SQUARED))
        return np.stack([x * gain + self.width / 2, y * gain + self.height / 2], axis=-1)

    def projections(self, candidates, points, scale):
        """Return (K, N, 2): where K candidates see N points; ``scale`` is the meters of a unit shift."""
        change = self._change(candidates, scale)
        rotation = _rotations(change[:, :3]) @ self.rotation
        shift = rotation @ (self.center + change[:, 3:6])[..., None]
        right, down, depth = np.moveaxis(rotation @ points.T - shift, 1, 0)
        ahead = np.where(depth > 1e-3, depth, np.nan)
        x, y = right / ahead, down / ahead
        bent = (self.distortion + change[:, 7])[:, None] * np.minimum(x * x + y * y, _WIDEST_SQUARED)
        gain = (self.focal_px * np.exp(change[:, 6]))[:, None] * (1 + bent)
        return np.moveaxis(np.stack([x * gain + self.width / 2, y * gain + self.height / 2]), 0, -1)

    def moved(self, candidate, scale):
        """Return the camera of one candidate."""
        change = self._change(candidate[None], scale)[0]
        return Camera(
            _rotations(change[None, :3])[0] @ self.rotation,
            self.center + change[3:6],
            self.focal_px * np.exp(change[6]),
            self.distortion + change[7],
            self.width,
            self.height,
        )

    def _change(self, candidates, scale):
        change = candidates * self.UNITS
        change[:, 3:6] *= scale
        return change


@dataclass(frozen=True, eq=False)
class GridHomography:
    """A homography from the scan's grid (pixels from its top left corner) to the photo.

    For a photo of something flat, for a photo that shows what the scanner's own camera saw, and for a view that was
    turned on the spot where the grid is a perspective view itself.
    """

    matrix: np.ndarray
    grid_shape: tuple[int, int]
    width: int
    height: int

    kind = "homography"
    ALL = tuple(range(8))

    def sites(self, scan_image):
        """(h, w, 2): what `project` takes for the pixels of a `ScanImage`."""
        return scan_image.grid_xy

    def sites_of(self, scan, rows, cols):
        """(..., 2): the same for pixels of a `Scan`."""
        y, x = np.broadcast_arrays(np.asarray(rows) + 0.5, np.asarray(cols) + 0.5)
        return np.stack([x, y], axis=-1)

    def turns(self, scan_image):
        """(2, h, w, 2): what the next pixel to the right, and down, adds to a site."""
        return scan_image.grid_turns

    def project(self, grid_xy):
        """Return (..., 2) pixels from the photo's top left corner, NaN beyond the horizon, and a depth of ones."""
        mapped = np.concatenate([grid_xy, np.ones((*grid_xy.shape[:-1], 1))], axis=-1) @ self.matrix.T
        weight = mapped[..., 2]
        weight = np.where(weight * np.sign(self.matrix[2, 2] or 1) > 1e-9, weight, np.nan)
        return mapped[..., :2] / weight[..., None], np.ones(weight.shape)

    def seen(self, grid_xy, turns):
        """Return what `project` does and (..., 2, 2): what each of two steps, (2, ..., 2) pixels of the grid, moves a
        place in the photo."""
        here, depth = self.project(grid_xy)
        moved = np.empty((*here.shape, 2))
        for step, turn in enumerate(turns):
            np.subtract(self.project(grid_xy + turn)[0], here, out=moved[..., step])
        return here, depth, moved

    def projections(self, candidates, grid_xy, scale):
        """Return (K, N, 2): where K candidates (shifts of the grid's corners) put N places of the grid."""
        matrices = self.matrix @ self._changes(candidates)
        sites = np.column_stack([grid_xy, np.ones(len(grid_xy))])
        x, y, weight = np.moveaxis(matrices @ sites.T, 1, 0)
        sense = np.where(matrices[:, 2, 2] < 0, -1, 1)[:, None]
        weight = np.where(weight * sense > 1e-9, weight, np.nan)
        return np.moveaxis(np.stack([x / weight, y / weight]), 0, -1)

    def moved(self, candidate, scale):
        """Return the homography whose images of the grid's corners are shifted by hundredths of the grid's size."""
        matrix = self.matrix @ self._changes(candidate[None])[0]
        return GridHomography(matrix, self.grid_shape, self.width, self.height)

    def _changes(self, candidates):
        """(K, 3, 3): the homographies of the grid that shift its corners as candidates do."""
        height, width = self.grid_shape
        moved = candidates.reshape(-1, 4, 2) * (0.01 * max(height, width))
        moved += [[0, 0], [width, 0], [width, height], [0, height]]
        (x0, x1, x2, x3), (y0, y1, y2, y3) = np.moveaxis(moved, 0, -1).swapaxes(0, 1)
        # A square's homography to a quadrangle (Heckbert 1989), in closed form: the same bits everywhere.
        bent_x, bent_y = x0 - x1 + x2 - x3, y0 - y1 + y2 - y3
        area = (x1 - x2) * (y3 - y2) - (x3 - x2) * (y1 - y2)
        g = (bent_x * (y3 - y2) - (x3 - x2) * bent_y) / area
        h = ((x1 - x2) * bent_y - bent_x * (y1 - y2)) / area
        rows = [[x1 - x0 + g * x1, x3 - x0 + h * x3, x0], [y1 - y0 + g * y1, y3 - y0 + h * y3, y0], [g, h, 1 + 0 * g]]
        return np.moveaxis(np.array(rows), -1, 0) / [width, height, 1]


def within(model, xy):
    """Return (...) bool: which places (..., 2) lie in the photo of a model; NaN does not."""
    x, y = xy[..., 0], xy[..., 1]
    return (x >= 0) & (y >= 0) & (x <= model.width) & (y <= model.height)


def camera_axes(yaw_deg, pitch_deg, roll_deg):
    """Return the (3, 3) rotation from the scanner frame (Z up) to a camera that looks along +Y turned right by the yaw,
    up by the pitch, and rolled clockwise."""
    yaw, pitch, roll = np.radians([yaw_deg, pitch_deg, roll_deg])
    level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    rolled = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
    pitched = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
    turned = np.array([[np.cos(yaw), np.sin(yaw), 0], [-np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    return (turned @ level @ pitched @ rolled).T


def _rotations(vectors):
    """(K, 3, 3) rotation matrices of (K, 3) rotation vectors (Rodrigues' formula)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = (vectors / np.maximum(angle[:, 0], 1e-12)).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
