"""Tiles of the scan, each sought in a photo near where a model puts it: scores over all shifts."""

from dataclasses import dataclass

import numpy as np

from ..photo_image import spacing, visible

_LEAST_TILES = 8
_LEAST_COVER = 0.5


@dataclass(frozen=True, eq=False)
class Tiles:
    """Square tiles of a `ScanImage`, half overlapping, where enough is valid.

    ``corners`` (N, 2) row and column of each tile's first pixel; ``middles`` (N, 2) row and column of the valid pixel
    next to its middle; ``along`` (N, 2, D): what one pixel to the right, and down, adds to the site at the middle.
    """

    size: int
    corners: np.ndarray
    middles: np.ndarray

    @classmethod
    def of(cls, scan_image, size):
        """Lay tiles of ``size`` pixels."""
        height, width = scan_image.shape
        step = size // 2
        corners, middles = [], []
        y, x = np.mgrid[:size, :size] - (size - 1) / 2
        off_middle = y * y + x * x
        for row in range(0, height - size + 1, step):
            for col in range(0, width - size + 1, step):
                valid = scan_image.valid[row : row + size, col : col + size]
                if valid.mean() >= 0.4:
                    nearest = np.argmin(np.where(valid, off_middle, np.inf))
                    corners.append((row, col))
                    middles.append((row + nearest // size, col + nearest % size))
        return cls(size, np.array(corners).reshape(-1, 2), np.array(middles).reshape(-1, 2))


@dataclass(frozen=True, eq=False)
class Surfaces:
    """What the tiles say about a model.

    scores : (N, 2 r + 1, 2 r + 1) float32
        In deviations from each tile's own mean, over shifts in pixels of the scan's image (row, column).
    sites : (N, D)
        Where the tiles are, as the model takes it.
    places : (N, 2)
        Where the model puts them in the photo.
    inverse : (N, 2, 2)
        From pixels of the photo to shifts in pixels of the scan's image.
    middles : (N, 2)
        Rows and columns of the tiles in the scan's image.
    scale : float
        Metres of a unit shift of a camera: the median distance of the tiles.
    """

    scores: np.ndarray
    sites: np.ndarray
    places: np.ndarray
    inverse: np.ndarray
    middles: np.ndarray
    scale: float

    @property
    def radius(self):
        return self.scores.shape[1] // 2


@dataclass(frozen=True, eq=False)
class Sighting:
    """What a photo shows of a `ScanImage` under a model: its features there (h, w, 5), where it is seen, the sites."""

    features: np.ndarray
    seen: np.ndarray
    sites: np.ndarray

    @classmethod
    def of(cls, scan_image, photo, model):
        """Look; None where the photo shows too little of the scan."""
        sites = model.sites(scan_image)
        xy, depth = model.project(sites)
        seen = visible(model, scan_image, xy, depth)
        if np.count_nonzero(seen) < 64:
            return None
        features, seen = photo.features(xy, seen, spacing(xy, seen))
        return cls(features, seen, sites)


def surfaces(scan_image, tiles, photo, model, radius, sighting=None):
    """Return the `Surfaces` of a model, or None where the photo shows too little of the scan.

    Parameters
    ----------
    scan_image : ScanImage
    tiles : Tiles
        Of that image.
    photo : PhotoImage
    model : Camera or GridHomography
    radius : int
        Pixels of the scan's image that a tile is sought in.
    sighting : Sighting, optional
        Where it is known already.
    """
    sighting = sighting or Sighting.of(scan_image, photo, model)
    if sighting is None or len(tiles.corners) < _LEAST_TILES:
        return None
    features, seen, sites = sighting.features, sighting.seen, sighting.sites
    shares = _tile_sums(seen.astype(np.float32), tiles.size)[tuple(tiles.corners.T)] / tiles.size**2
    chosen = np.flatnonzero(shares >= _LEAST_COVER)
    if len(chosen) < _LEAST_TILES:
        return None
    middles = tiles.middles[chosen]
    at = sites[middles[:, 0], middles[:, 1]]
    places, inverse = _local_maps(scan_image, model, sites, middles, at)
    scores, lively = _correlations(scan_image.features, features, tiles.corners[chosen], tiles.size, radius)
    good = lively & np.isfinite(places).all(axis=1) & np.isfinite(inverse).all(axis=(1, 2))
    if np.count_nonzero(good) < _LEAST_TILES:
        return None
    ranges = scan_image.range[middles[:, 0], middles[:, 1]]
    return Surfaces(scores[good], at[good], places[good], inverse[good], middles[good], float(np.median(ranges[good])))


def _tile_sums(image, size):
    """(H, W): the sum over the square of ``size`` pixels that begins at each pixel."""
    import cv2

    return cv2.boxFilter(
        image, cv2.CV_32F, (size, size), normalize=False, anchor=(0, 0), borderType=cv2.BORDER_CONSTANT
    )


def _correlations(own, other, corners, size, radius):
    """Normalized cross-correlation of every tile of ``own`` with ``other`` over all shifts, as deviations; and which
    tiles have anything to say."""
    import cv2

    padded = np.pad(other, ((radius, radius), (radius, radius), (0, 0)))
    energy = _tile_sums((padded**2).sum(axis=-1), size)
    usual = float(np.median(energy[energy > 0])) if (energy > 0).any() else 1.0
    energy = np.maximum(energy, 0.25 * usual)
    strength = _tile_sums((own**2).sum(axis=-1), size)[tuple(corners.T)]
    padded, own = _in_threes(padded), _in_threes(own)
    window, reach = 2 * radius + 1, size + 2 * radius
    scores = np.zeros((len(corners), window, window), np.float32)
    for index in np.flatnonzero(strength > 1e-3):
        row, col = corners[index]
        product = sum(
            cv2.matchTemplate(
                other_half[row : row + reach, col : col + reach],
                own_half[row : row + size, col : col + size],
                cv2.TM_CCORR,
            )
            for other_half, own_half in zip(padded, own, strict=True)
        )
        scores[index] = product / np.sqrt(energy[row : row + window, col : col + window] * strength[index])
    deviation = scores.std(axis=(1, 2), keepdims=True)
    return (scores - scores.mean(axis=(1, 2), keepdims=True)) / (deviation + 1e-3), deviation[:, 0, 0] > 1e-4


def _in_threes(features):
    """The five channels as two images of three, the last one empty: matchTemplate takes one channel or three."""
    import cv2

    channels = [*cv2.split(features), np.zeros(features.shape[:2], np.float32)]
    return cv2.merge(channels[:3]), cv2.merge(channels[3:])


def _local_maps(scan_image, model, sites, middles, at):
    """Where the tiles' middles fall, and what a shift in the photo is in pixels of the scan's image.

    For a camera the neighboring pixel is taken at the same distance: across a jump edge the photo does not follow.
    """
    steps = np.empty((len(middles), 2, at.shape[1]))
    source = scan_image.directions if model.kind == "pose" else sites
    valid = scan_image.valid if model.kind == "pose" else np.ones(scan_image.shape, bool)
    for axis in (0, 1):
        steps[:, axis] = _steps(source, valid, middles, axis)
    if model.kind == "pose":
        steps *= scan_image.range[middles[:, 0], middles[:, 1]][:, None, None]
    places, _ = model.project(at)
    jacobian = np.stack([model.project(at + steps[:, axis])[0] - places for axis in (0, 1)], axis=-1)
    (a, b), (c, d) = np.moveaxis(jacobian, 0, -1)
    determinant = a * d - b * c
    usable = np.isfinite(jacobian).all(axis=(1, 2)) & (np.abs(determinant) > 1e-9)
    inverse = np.stack([np.stack([d, -b], -1), np.stack([-c, a], -1)], axis=1)
    inverse = inverse / np.where(usable, determinant, np.nan)[:, None, None]
    return places, inverse


def _steps(values, valid, middles, axis, reach=4):
    """What one pixel to the right (axis 0) or down (axis 1) adds to ``values`` around each middle."""
    height, width = valid.shape
    total = np.zeros((len(middles), values.shape[-1]))
    count = np.zeros(len(middles))
    rows, cols = middles.T
    for first in range(-reach, 1):
        second = first + reach
        r0, c0 = (rows, cols + first) if axis == 0 else (rows + first, cols)
        r1, c1 = (rows, cols + second) if axis == 0 else (rows + second, cols)
        inside = (r0 >= 0) & (c0 >= 0) & (r1 < height) & (c1 < width)
        r0, c0, r1, c1 = (np.where(inside, index, 0) for index in (r0, c0, r1, c1))
        usable = inside & valid[r0, c0] & valid[r1, c1]
        total += np.where(usable[:, None], values[r1, c1] - values[r0, c0], 0) / reach
        count += usable
    steps = total / np.maximum(count, 1)[:, None]
    if (count > 0).any():
        steps[count == 0] = np.median(steps[count > 0], axis=0)
    return steps
