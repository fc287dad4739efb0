"""Scan and photo as maps over azimuth and elevation, and their correlation over all shifts.

Seen from one place, the scan is such a map, and so is a photo of a known focal length; turning the photo left and
right shifts its map. So one correlation by FFT tries every direction, on edge features (`edges`), normalized by what
overlaps.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..edges import scan_features
from ..models import Camera, camera_axes, within

# A skyline or an edge of a thing is seen from afar, so range counts for more here than in the tiles.
_RANGE_WEIGHT = 0.7
_CUT_MARGIN_DEG = 100
_LEAST_OVERLAP = 0.2
_MOST_MAPS, _MOST_SPECTRA = 200, 8
# Sides of transforms are rounded up to these, so that maps of like size share what is transformed once.
_ROUND_TO = 32


@dataclass(frozen=True)
class Guess:
    """A camera that may be right, and how far its correlation stands out (in deviations of chance)."""

    score: float
    focal: float
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    center: tuple[float, float, float]

    def camera(self, photo):
        """Return it as a `Camera` for a `PhotoImage`."""
        rotation = camera_axes(self.yaw_deg, self.pitch_deg, self.roll_deg)
        focal_px = self.focal * max(photo.width, photo.height)
        return Camera(rotation, np.array(self.center), focal_px, 0.0, photo.width, photo.height)


class SphereMap:
    """The scan over azimuth and elevation, seen from a place.

    Parameters
    ----------
    points : (N, 3) float64
        Meters, scanner frame.
    tone : (N,) float32
        Their reflectance, see `scan_image.reflectance_image`.
    center : (3,) float
        The place.
    step_deg : float
        Size of a pixel.
    window : (left, right, bottom, top) of float, optional
        Only what lies between these azimuths and elevations, in degrees.
    """

    def __init__(self, points, tone, center, step_deg, window=None):
        self.center = tuple(float(value) for value in center)
        self.step_deg = step_deg
        from_center = points - np.asarray(center)
        across = np.hypot(from_center[:, 0], from_center[:, 1])
        azimuth = np.degrees(np.arctan2(from_center[:, 0], from_center[:, 1]))
        elevation = np.degrees(np.arctan2(from_center[:, 2], across))
        distance = np.maximum(np.hypot(across, from_center[:, 2]), 1e-9)
        around = False
        if window is None:
            self.left, around = _cut(azimuth)
            azimuth = (azimuth - self.left) % 360
            self.top = elevation.max()
            cols, rows = (azimuth / step_deg).astype(int), ((self.top - elevation) / step_deg).astype(int)
            shape = (rows.max() + 1, cols.max() + 1)
        else:
            self.left, right, bottom, self.top = window
            shape = (int((self.top - bottom) / step_deg) + 1, int((right - self.left) / step_deg) + 1)
            cols = (((azimuth - self.left) % 360) / step_deg).astype(int)
            rows = np.floor((self.top - elevation) / step_deg).astype(int)
            inside = (cols < shape[1]) & (rows >= 0) & (rows < shape[0])
            rows, cols, distance, tone = rows[inside], cols[inside], distance[inside], tone[inside]
        reflectance, range_m, valid = drawn(rows, cols, shape, distance, tone)
        if around:
            # The photo may lie across the cut.
            margin = min(shape[1], int(_CUT_MARGIN_DEG / step_deg))
            reflectance, range_m, valid = (np.hstack([a, a[:, :margin]]) for a in (reflectance, range_m, valid))
        features = scan_features(reflectance, range_m, valid, range_weight=_RANGE_WEIGHT)
        seen = features.any(axis=-1)
        self._layers = _layers(features, (features**2).sum(axis=-1), seen)
        self._seen = seen.sum()
        self.shape = valid.shape
        self._spectra = None, None

    def peaks(self, photo_maps, key, count, reach_deg=None):
        """Return the best `Guess`es for one map of a photo.

        Parameters
        ----------
        photo_maps : PhotoMaps
        key : (focal, pitch_deg, roll_deg)
        count : int
        reach_deg : float, optional
            How far around the middle of this map the map of the photo is tried; everywhere without.
        """
        patch = photo_maps.at(*key)
        if patch is None:
            return []
        rows, cols = (
            self._shifts(own, other, reach_deg) for own, other in zip(self.shape, patch.seen.shape, strict=True)
        )
        if not (len(rows) and len(cols)):
            return []
        # scores[row, col]: for the photo's corner at rows[row], cols[col].
        scores = self._correlation(photo_maps, key, patch, rows, cols)
        apart = max(2, round(1.6 / self.step_deg))
        found = []
        for _ in range(count):
            row, col = np.unravel_index(scores.argmax(), scores.shape)
            if scores[row, col] <= 0:
                break
            yaw = self.left + cols[col] * self.step_deg - patch.left
            rise = self.top - rows[row] * self.step_deg - patch.top
            score = float(scores[row, col])
            found.append(Guess(score, key[0], float(yaw), float(key[1] + rise), float(key[2]), self.center))
            scores[max(0, row - apart) : row + apart + 1, max(0, col - apart) : col + apart + 1] = -1
        return found

    def _shifts(self, own, other, reach_deg):
        """By how many pixels a map of ``other`` pixels is moved along one of ``own``."""
        shifts = np.arange(-other, own)
        if reach_deg is None:
            return shifts
        return shifts[np.abs(shifts + other / 2 - own / 2) * self.step_deg <= reach_deg]

    def _correlation(self, photo_maps, key, patch, rows, cols):
        """Correlation times the root of the overlap, for each of these shifts, which are without a gap."""
        from scipy import fft

        # As far as these shifts bring the map of the photo around, beyond either end, is left free.
        shape = tuple(
            fft.next_fast_len(-(-max(own, own - shifts[0], shifts[-1] + other) // _ROUND_TO) * _ROUND_TO, real=True)
            for own, other, shifts in zip(self.shape, patch.seen.shape, (rows, cols), strict=True)
        )
        # Several threads may be here.
        known_shape, own = self._spectra
        if known_shape != shape:
            own = _spectra(self._layers, shape)
            self._spectra = shape, own
        other = photo_maps.spectra(key, shape)
        # Products, the scan's energy within the photo, and what overlaps; a photo's energy is the same everywhere.
        spectra = np.empty((3, *own.shape[1:]), np.complex64)
        np.einsum("cij,cij->ij", own[:-2], other[:-1], out=spectra[0])
        np.multiply(own[-2:], other[-1], out=spectra[1:])
        lines = fft.ifft(spectra, axis=-2, overwrite_x=True)[:, rows % shape[0]]
        product, energy, overlap = fft.irfft(lines, shape[1], overwrite_x=True)[..., cols % shape[1]]
        enough = overlap > _LEAST_OVERLAP * min(patch.pixels, self._seen)
        # An array of one number: by a number alone NumPy 1 would multiply in single precision.
        return np.where(enough, product / np.sqrt(np.maximum(energy, 1.0) * np.array([[patch.usual]])), -1)


@dataclass(frozen=True, eq=False)
class _PhotoMap:
    """Features (h, w, 3) of a photo over azimuth and elevation, where it is seen, its left and its top in degrees."""

    features: np.ndarray
    seen: np.ndarray
    left: float
    top: float

    @cached_property
    def pixels(self):
        """How many are seen."""
        return self.seen.sum()

    @cached_property
    def usual(self):
        """The energy of the features of a pixel that is seen."""
        return max((self.features**2).sum(dtype=np.float64) / self.pixels, 1e-6)


class PhotoMaps:
    """The maps of a photo for focal lengths (in lengths of its longer side), pitches and rolls, made once each."""

    def __init__(self, photo, step_deg):
        self.photo, self.step_deg = photo, step_deg
        self._maps, self._transformed = {}, {}

    def at(self, focal, pitch_deg, roll_deg):
        """Return the map, or None where it would go around too far or shows too little."""
        key = (focal, pitch_deg, roll_deg)
        return _kept(self._maps, _MOST_MAPS, key, lambda: _photo_map(self.photo, *key, self.step_deg))

    def spectra(self, key, shape):
        """Return the conjugate transforms of a map's layers."""

        def transformed():
            patch = self.at(*key)
            return np.conj(_spectra(_layers(patch.features, patch.seen), shape))

        return _kept(self._transformed, _MOST_SPECTRA, (key, shape), transformed)


def _kept(known, most, key, make):
    """What ``make`` made for a key, of which at most so many are kept; several threads may ask."""
    try:
        return known[key]
    except KeyError:
        made = make()
    if len(known) >= most:
        known.clear()
    known[key] = made
    return made


def _spectra(layers, shape):
    """The transforms of (K, h, w) layers, filled up with zeros to a shape: not spending time on rows of zeros."""
    from scipy import fft

    return fft.fft(fft.rfft(layers, shape[1]), shape[0], axis=-2, overwrite_x=True)


def _layers(features, *others):
    """(3 + K, h, w) float32: the features, and other images."""
    return np.concatenate([np.moveaxis(features, -1, 0), np.stack(others)]).astype(np.float32)


def _cut(azimuth_deg):
    """The azimuth at the right end of the widest empty sector, and whether there is none."""
    empty = np.histogram(azimuth_deg, 360, (-180, 180))[0] == 0
    if not empty.any():
        return -180.0, True
    starts = np.flatnonzero(np.diff(np.concatenate([[0], np.tile(empty, 2), [0]])) == 1)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], np.tile(empty, 2), [0]])) == -1)
    widest = np.argmax(ends - starts)
    return float(-180 + ends[widest] % 360), bool(ends[widest] - starts[widest] < 3)


def drawn(rows, cols, shape, distance, tone):
    """Return points drawn into an image: the mean of the nearest surface in each pixel, small holes closed.

    Parameters
    ----------
    rows, cols : (N,) int
        Pixels of the image.
    shape : (h, w)
    distance, tone : (N,) float
        How far away each point is, in meters, and its reflectance.

    Returns
    -------
    reflectance, range_m : (h, w) float32
        0 where nothing is.
    seen : (h, w) bool
    """
    import cv2

    place = rows * shape[1] + cols
    nearest = np.full(shape[0] * shape[1], np.inf)
    np.minimum.at(nearest, place, distance)
    front = distance < nearest[place] * 1.03
    place, tone, distance = place[front], tone[front], distance[front]
    count = np.bincount(place, minlength=nearest.size)
    sums = [np.bincount(place, values, nearest.size) for values in (tone, distance)]
    reflectance, range_m = ((total / np.maximum(count, 1)).reshape(shape).astype(np.float32) for total in sums)
    valid = (count > 0).reshape(shape)
    closed = cv2.morphologyEx(valid.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3))) > 0
    holes = closed & ~valid
    share = np.maximum(cv2.blur(valid.astype(np.float32), (3, 3)), 1e-6)
    for image in (reflectance, range_m):
        image[holes] = (cv2.blur(image, (3, 3)) / share)[holes]
    return reflectance, range_m, closed


def _field(x, y, z):
    """(h, w, 3): vectors of these, of which ``x`` is (h, w)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def _photo_map(photo, focal, pitch_deg, roll_deg, step_deg):
    width, height = photo.width, photo.height
    focal_px = focal * max(width, height)
    rotation = camera_axes(0.0, pitch_deg, roll_deg)
    x, y = np.meshgrid(np.linspace(-width / 2, width / 2, 9), np.linspace(-height / 2, height / 2, 9))
    rays = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, focal_px)]) @ rotation
    azimuth = np.degrees(np.arctan2(rays[:, 0], rays[:, 1]))
    elevation = np.degrees(np.arctan2(rays[:, 2], np.hypot(rays[:, 0], rays[:, 1])))
    if np.ptp(azimuth) > 170:
        return None
    left, top = np.floor(azimuth.min() / step_deg) * step_deg, np.ceil(elevation.max() / step_deg) * step_deg
    cols, rows = int((azimuth.max() - left) / step_deg) + 1, int((top - elevation.min()) / step_deg) + 1
    azimuth = np.radians(left + (np.arange(cols) + 0.5) * step_deg)
    elevation = np.radians(top - (np.arange(rows) + 0.5) * step_deg)[:, None]
    (sine, cosine), (rise, level) = ((np.sin(angle), np.cos(angle)) for angle in (azimuth, elevation))
    rays = _field(sine * level, cosine * level, rise)
    turns = np.stack([_field(cosine * level, -sine * level, 0.0), _field(sine * rise, cosine * rise, -level)])
    turns *= np.radians(step_deg)
    camera = Camera(rotation, np.zeros(3), focal_px, 0.0, width, height)
    xy, depth, jacobian = camera.seen(rays, turns)
    seen = (depth > 0) & within(camera, xy)
    if np.count_nonzero(seen) < 64:
        return None
    return _PhotoMap(photo.features(xy, jacobian, seen), seen, left, top)
