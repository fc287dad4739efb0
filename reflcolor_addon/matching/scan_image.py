"""The scan as an image of square pixels: what features and tiles are computed on."""

from functools import cached_property

import numpy as np

from ..scan.normalization import normalize
from .edges import filled, scan_features
from .grid_angles import GridAngles

RANGE_WEIGHT = 0.35
_SMALL = 400
# Pixels between two rows of the grid at most; what lies between rows farther apart is not measured.
_WIDEST_GAP = 6
# The logarithm of the range on one surface changes by less from the pixel to half way to the next.
_SMOOTH = 0.2
# Pixels, and share of the image, of holes that may be panes of glass; how much farther a rim may be in one place.
_SMALLEST_PANE, _LARGEST_PANE, _FLAT_RIM = 9, 0.05, 1.25


def reflectance_image(scan, tone):
    """Return the reflectance as an (H, W) float32 image of 0..255.

    Parameters
    ----------
    scan : Scan
    tone : {"ranks", "percentiles"}
        "ranks": every gray value occurs equally often, so that neither the unit (linear, logarithmic) nor a few
        bright things matter; "percentiles": as the colorization uses it, which keeps noise in flat parts low.
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
    """Return the (vertical, horizontal) step in degrees, assumed where the points do not show it."""
    vertical, horizontal = (step if np.isfinite(step) and step > 0 else None for step in scan.step_deg)
    known = vertical or horizontal or 0.1
    vertical, horizontal = vertical or known, horizontal or known
    # A ratio that no scanner has comes from points that are no panorama: take the pixels as square.
    if not 1 / 20 < vertical / horizontal < 20:
        return known, known
    return vertical, horizontal


class ScanImage:
    """A scan resampled to square pixels of ``step_deg``.

    Parameters
    ----------
    scan : Scan
    tone_image : (H, W) float32
        The reflectance, see `reflectance_image`.
    step_deg : float
        Size of a pixel; never finer than the grid, or than half of it where the grid is small: there a tile would
        else be a large part of the scan, and a few tiles prove little.
    range_weight : float
        See `edges.scan_features`.
    angles : GridAngles, optional
        Of the scan, where they are known already.

    Attributes
    ----------
    shape : (h, w)
    pixels_per_measurement : float
        1 where the image is no finer than the grid.
    stretch : float
        How much longer one way than the other the part of the image is that one measurement fills; 1 where it is square
        or not larger than a pixel.
    rows, cols : (h,) and (w,) int
        Row and column of the scan's grid that a pixel shows.
    reflectance : (h, w) float32
    points : (h, w, 3) float64
    range : (h, w) float64
    valid : (h, w) bool
    grid_xy : (h, w, 2) float64
        Position in the scan's grid, in its pixels from the top left corner.
    features : (h, w, 3) float32
    """

    def __init__(self, scan, tone_image, step_deg, range_weight=RANGE_WEIGHT, angles=None):
        height, width = scan.shape
        vertical, horizontal = pixel_steps(scan)
        self._angles = angles or GridAngles.of(scan)
        tall = height * vertical
        if self._angles.uneven:
            tall = abs(self._angles.elevation_deg[0] - self._angles.elevation_deg[-1]) + vertical
        # A grid of few rows of many pixels is drawn out at most so far that a pixel stands for four.
        finest = max(min(vertical, horizontal), np.sqrt(vertical * horizontal) / 2)
        if max(tall, width * horizontal) / finest < _SMALL:
            finest /= 2
        self.step_deg = max(step_deg, finest)
        h, w = max(1, round(tall / self.step_deg)), max(1, round(width * horizontal / self.step_deg))
        self.shape = (h, w)
        finer = max(1.0, h / height), max(1.0, w / width)
        self.pixels_per_measurement, self.stretch = finer[0] * finer[1], max(finer) / min(finer)
        # Where a pixel lies in the grid, counted from the middle of the first one.
        self._at_row, measured = self._row_places(h)
        self._at_col = (np.arange(w) + 0.5) * width / w - 0.5
        self.rows = np.clip(np.rint(self._at_row).astype(int), 0, height - 1)
        self.cols = np.clip(np.rint(self._at_col).astype(int), 0, width - 1)
        chosen = np.ix_(self.rows, self.cols)
        self.valid = scan.valid[chosen] & measured[:, None]
        self.points = scan.points[chosen]
        self.range = scan.range[chosen]
        if self.pixels_per_measurement > 1:
            self.range = self._between(scan)
        weight = self._resampled(scan.valid.astype(np.float32))
        value = self._resampled(np.where(scan.valid, tone_image, 0).astype(np.float32))
        self.reflectance = np.where(weight > 0.02, value / np.maximum(weight, 0.02), 0).astype(np.float32)
        x, y = np.meshgrid(self._at_col + 0.5, self._at_row + 0.5)
        self.grid_xy = np.stack([x, y], axis=-1)
        self._range_weight = range_weight
        self._scan = scan
        self._made = {}

    def once(self, key, make):
        """Return what ``make()`` returned the first time for this key."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def _row_places(self, h):
        """The place in the grid of each of ``h`` rows, and whether it is near enough to a row that was measured."""
        height = self._angles.shape[0]
        if not self._angles.uneven:
            return (np.arange(h) + 0.5) * height / h - 0.5, np.ones(h, bool)
        elevation = self._angles.elevation_deg
        sense = np.sign(elevation[-1] - elevation[0])
        ordered = np.maximum.accumulate(sense * elevation)
        wanted = ordered[0] + (np.arange(h) + 0.5) * (ordered[-1] - ordered[0] + self.step_deg) / h - self.step_deg / 2
        place = np.interp(wanted, ordered, np.arange(height))
        gap = np.append(np.diff(ordered), 0)[place.astype(int)]
        near = np.abs(np.interp(np.rint(place), np.arange(height), ordered) - wanted) <= self.step_deg
        return place, (gap <= _WIDEST_GAP * self.step_deg) | near

    def _between(self, scan):
        """(h, w) float64: the range, interpolated on surfaces; the nearest pixel's at jumps."""
        weight = self._resampled(scan.valid.astype(np.float32))
        logarithm = np.log(np.maximum(scan.range, 1e-6))
        between = self._resampled(np.where(scan.valid, logarithm, 0).astype(np.float32)) / np.maximum(weight, 1e-6)
        nearest = np.log(np.maximum(self.range, 1e-6))
        smooth = self.valid & (np.abs(between - nearest) < _SMOOTH)
        return np.where(smooth, np.exp(np.where(smooth, between, 0).astype(np.float64)), self.range)

    def _resampled(self, image):
        """(h, w) float32: averaged where it gets coarser, per axis; interpolated where it gets finer."""
        import cv2

        height, width = image.shape
        h, w = self.shape
        if w < width:
            image = cv2.resize(image, (w, height), interpolation=cv2.INTER_AREA)
        if self._angles.uneven:
            fine = np.interp((np.arange(4 * h) + 0.5) / 4 - 0.5, np.arange(h), self._at_row).astype(np.float32)
            x, y = np.meshgrid(np.arange(image.shape[1], dtype=np.float32), fine)
            image = cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        if h < image.shape[0]:
            image = cv2.resize(image, (image.shape[1], h), interpolation=cv2.INTER_AREA)
        return cv2.resize(image, (w, h), interpolation=cv2.INTER_LINEAR)

    @cached_property
    def _grid_directions(self):
        return self._angles.at(self._at_row, self._at_col)

    @cached_property
    def features(self):
        return scan_features(self.reflectance, self.range, self.valid, range_weight=self._range_weight)

    @cached_property
    def directions(self):
        """(h, w, 3) float64: unit vectors from the scanner; without a return, too."""
        import cv2

        if self.pixels_per_measurement > 1:
            scan = self._scan
            grid = self._angles.at(np.arange(scan.shape[0]), np.arange(scan.shape[1]))
            grid = np.where(scan.valid[..., None], scan.points / np.maximum(scan.range, 1e-12)[..., None], grid)
            x, y = (axis.astype(np.float32) for axis in np.meshgrid(self._at_col, self._at_row))
            between = cv2.remap(grid, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            return between / np.maximum(np.linalg.norm(between, axis=-1, keepdims=True), 1e-12)
        measured = self.points / np.maximum(self.range, 1e-12)[..., None]
        return np.where(self.valid[..., None], measured, self._grid_directions)

    @cached_property
    def surface(self):
        """(h, w, 3) float64, meters: where each pixel's surface is; without a return as far as what is around it."""
        logarithm = filled(np.log(np.maximum(self.range, 1e-6)), self.valid)
        distance = np.where(self.valid, self.range, np.exp(logarithm))
        surface = self.directions * distance[..., None]
        return surface if self.pixels_per_measurement > 1 else np.where(self.valid[..., None], self.points, surface)

    @cached_property
    def turns(self):
        """(2, h, w, 3) float64, meters: what the next pixel to the right, and down, adds to a surface seen squarely.

        Of the grid as a whole: neither a hole nor a jump of the range shows in it, but for the distance.
        """
        return np.stack(_differences(self._grid_directions)) * np.linalg.norm(self.surface, axis=-1)[..., None]

    @cached_property
    def grid_turns(self):
        """(2, h, w, 2) float64: the same in pixels of the grid."""
        return np.stack(_differences(self.grid_xy))

    @cached_property
    def panes(self):
        """(K, 3) float64, meters: the surface in holes that it surrounds.

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


def _differences(image):
    """From pixel to pixel to the right, and down, (h, w, D) each; zero along a side of one pixel."""
    return [np.gradient(image, axis=axis) if image.shape[axis] > 1 else np.zeros_like(image) for axis in (1, 0)]
