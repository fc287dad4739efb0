"""The scan as an image of square pixels: what features and tiles are computed on."""

from functools import cached_property

import numpy as np

from ..scan.normalization import normalize
from .edges import filled, scan_features

TONES = ("ranks", "percentiles")
RANGE_WEIGHT = 0.35
_SMALL = 400
# Pixels, and share of the image, of holes that may be panes of glass; how much farther a rim may be in one place.
_SMALLEST_PANE, _LARGEST_PANE, _FLAT_RIM = 9, 0.05, 1.25


def toned(scan, tone):
    """Return the reflectance as an (H, W) float32 image of 0..255.

    Parameters
    ----------
    scan : Scan
    tone : {"ranks", "percentiles"}
        "ranks": every gray value occurs equally often, so that neither the unit (linear, logarithmic) nor a few
        bright things matter; "percentiles": as the colorization has it, which keeps noise in flat parts low.
    """
    if tone == "percentiles":
        return normalize(scan.reflectance, scan.valid)[0]
    values, inverse, counts = np.unique(scan.reflectance[scan.valid], return_inverse=True, return_counts=True)
    image = np.zeros(scan.shape, np.float32)
    if values.size > 1:
        rank = np.cumsum(counts) - (counts + 1) / 2
        image[scan.valid] = ((rank - rank[0]) * (255 / (rank[-1] - rank[0])))[inverse]
    return image


def pixel_steps(scan):
    """Return the (vertical, horizontal) step in degrees, made up where the points do not tell."""
    vertical, horizontal = (step if np.isfinite(step) and step > 0 else None for step in scan.step_deg)
    known = vertical or horizontal or 0.1
    vertical, horizontal = vertical or known, horizontal or known
    # A ratio beyond any scanner comes from points that are no panorama: take the pixels as square.
    if not 1 / 20 < vertical / horizontal < 20:
        return known, known
    return vertical, horizontal


class ScanImage:
    """A scan resampled to square pixels of ``step_deg``.

    Parameters
    ----------
    scan : Scan
    tone_image : (H, W) float32
        The reflectance, see `toned`.
    step_deg : float
        Size of a pixel; never finer than the grid, or than half of it where the grid is small: there a tile would
        else be a large part of the scan, and a few tiles prove little.
    range_weight : float
        See `edges.scan_features`.

    Attributes
    ----------
    shape : (h, w)
    pixels_per_measurement : float
        1 where the image is no finer than the grid.
    rows, cols : (h,) and (w,) int
        Row and column of the scan's grid that a pixel shows.
    reflectance : (h, w) float32
    points : (h, w, 3) float64
    range : (h, w) float64
    valid : (h, w) bool
    grid_xy : (h, w, 2) float64
        Position in the scan's grid, in its pixels from the top left corner.
    features : (h, w, 5) float32
    """

    def __init__(self, scan, tone_image, step_deg, range_weight=RANGE_WEIGHT):
        height, width = scan.shape
        vertical, horizontal = pixel_steps(scan)
        finest = min(vertical, horizontal)
        if max(height * vertical, width * horizontal) / finest < _SMALL:
            finest /= 2
        self.step_deg = max(step_deg, finest)
        h = max(1, round(height * vertical / self.step_deg))
        w = max(1, round(width * horizontal / self.step_deg))
        self.shape = (h, w)
        self.pixels_per_measurement = max(1.0, vertical / self.step_deg) * max(1.0, horizontal / self.step_deg)
        self.rows = np.minimum(((np.arange(h) + 0.5) * height / h).astype(int), height - 1)
        self.cols = np.minimum(((np.arange(w) + 0.5) * width / w).astype(int), width - 1)
        chosen = np.ix_(self.rows, self.cols)
        self.valid = scan.valid[chosen]
        self.points = scan.points[chosen]
        self.range = scan.range[chosen]
        weight = _resampled(scan.valid.astype(np.float32), h, w)
        value = _resampled(np.where(scan.valid, tone_image, 0).astype(np.float32), h, w)
        self.reflectance = np.where(weight > 0.02, value / np.maximum(weight, 0.02), 0).astype(np.float32)
        x, y = np.meshgrid((np.arange(w) + 0.5) * width / w, (np.arange(h) + 0.5) * height / h)
        self.grid_xy = np.stack([x, y], axis=-1)
        self._range_weight = range_weight
        self._scan = scan

    @cached_property
    def features(self):
        return scan_features(self.reflectance, self.range, self.valid, range_weight=self._range_weight)

    @cached_property
    def directions(self):
        """(h, w, 3) float64: unit vectors from the scanner; zero where not valid."""
        return self.points / np.maximum(self.range, 1e-9)[..., None]

    @cached_property
    def panes(self):
        """(K, 3) float64, metres: the surface in holes that it surrounds.

        Glass gives no return, but it is no opening: a photo shows the glass, not what lies behind it.
        """
        import cv2

        _, label, stats, _ = cv2.connectedComponentsWithStats((~self.valid).astype(np.uint8), connectivity=4)
        height, width = self.shape
        left, top, across, down, size = stats.T
        inner = (np.arange(len(stats)) > 0) & (left > 0) & (top > 0) & (left + across < width) & (top + down < height)
        inside = np.zeros(self.shape, bool)
        for hole in np.flatnonzero(inner & (size >= _SMALLEST_PANE) & (size <= _LARGEST_PANE * self.valid.size)):
            window = np.s_[top[hole] - 1 : top[hole] + down[hole] + 1, left[hole] - 1 : left[hole] + across[hole] + 1]
            own = label[window] == hole
            rim = (cv2.dilate(own.astype(np.uint8), np.ones((3, 3))) > 0) & ~own & self.valid[window]
            near, far = np.quantile(self.range[window][rim], (0.05, 0.95))
            # A hole between things at different distances is no pane of one of them.
            if far <= near * _FLAT_RIM:
                inside[window] |= own
        return np.stack([filled(axis, self.valid)[inside] for axis in np.moveaxis(self.points, -1, 0)], axis=-1)

    @cached_property
    def normals(self):
        """(h, w, 3) float64: normals of the surface, of any sign; zero where a neighbor is missing."""
        points, valid = self._scan.points, self._scan.valid
        right, down = np.zeros((2, *points.shape))
        right[:, 1:-1] = (points[:, 2:] - points[:, :-2]) * (valid[:, 2:] & valid[:, :-2])[..., None]
        down[1:-1] = (points[2:] - points[:-2]) * (valid[2:] & valid[:-2])[..., None]
        normal = np.cross(right, down)
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 1e-15)
        return normal[np.ix_(self.rows, self.cols)]


def _resampled(image, height, width):
    import cv2

    # Averaging where it gets coarser, per axis; interpolating where it gets finer.
    if height < image.shape[0]:
        image = cv2.resize(image, (image.shape[1], height), interpolation=cv2.INTER_AREA)
    if width < image.shape[1]:
        image = cv2.resize(image, (width, image.shape[0]), interpolation=cv2.INTER_AREA)
    return cv2.resize(image, (width, height), interpolation=cv2.INTER_LINEAR)
