"""Tiles of the scan, each sought in a photo near where a model puts it: scores over all shifts."""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..models import within
from ..photo_image import visible

_LEAST_TILES = 8
_LEAST_VALID = 0.4
_LEAST_COVER = 0.5
_LEAST_SEEN = 64
# Blocks that are transformed at once: so many stay in a processor's cache.
_BLOCKS = 64
# Pixels that are projected at once: few enough for a processor's cache.
_STRIP_PIXELS = 1 << 15
# Every sixth pixel is looked at to find which part of the scan a photo shows; and what is taken around that.
_GLANCE, _MARGIN = 6, 18


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
        return scan_image.once(("tiles", size), lambda: cls(size, *_laid(scan_image.valid, size)))


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
        Meters of a unit shift of a camera: the median distance of the tiles.
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

    def shifts(self, places):
        """Return the shifts (..., N, 2), right and down, of tiles that lie at ``places`` (..., N, 2) in the photo."""
        x, y = np.moveaxis(places - self.places, -1, 0)
        (right_x, right_y), (down_x, down_y) = np.moveaxis(self.inverse, 0, -1)
        return np.moveaxis(np.stack([right_x * x + right_y * y, down_x * x + down_y * y]), 0, -1)


@dataclass(frozen=True, eq=False)
class Sighting:
    """What a photo shows of a `ScanImage` under a model, in the part of the image that it can show.

    corner : (2,) int
        Row and column of that part's first pixel.
    own, features : (h, w, 3) float32
        The scan's edge features; the photo's, zero where it does not show what the scanner saw, but not where the
        scanner saw nothing.
    seen : (h, w) bool
    range : (h, w) float64
    sites, places : (h, w, D) and (h, w, 2) float64
        What the model projects, and where to.
    jacobian : (h, w, 2, 2) float64
        What a pixel to the right, and down, moves a place: [x or y, step].
    """

    corner: np.ndarray
    own: np.ndarray
    features: np.ndarray
    seen: np.ndarray
    range: np.ndarray
    sites: np.ndarray
    places: np.ndarray
    jacobian: np.ndarray

    @classmethod
    def of(cls, scan_image, photo, model):
        """Look; None where the photo shows too little of the scan."""
        part = _part(scan_image, model)
        if part is None:
            return None
        sites, valid = model.sites(scan_image)[part], scan_image.valid[part]
        xy, depth, jacobian = _seen(model, sites, model.turns(scan_image)[:, *part])
        seen = visible(model, valid, xy, depth)
        if np.count_nonzero(seen) < _LEAST_SEEN:
            return None
        own, distance = scan_image.features[part], scan_image.range[part]
        inside = (depth > 0) & within(model, xy)
        features = photo.features(xy, jacobian, inside)
        features *= (inside & (seen | ~valid))[..., None]
        corner = np.array([part[0].start, part[1].start])
        return cls(corner, own, features, seen, distance, sites, xy, jacobian)


def _seen(model, sites, turns):
    """Where a model sees (h, w, D) sites, in what depth, and what steps to the next ones move there."""
    xy, depth, jacobian = (np.empty((*sites.shape[:2], *further)) for further in ((2,), (), (2, 2)))
    for rows in _strips(sites):
        xy[rows], depth[rows], jacobian[rows] = model.seen(sites[rows], turns[:, rows])
    return xy, depth, jacobian


def _strips(image):
    """Slices of some rows of an image each."""
    height, width = image.shape[:2]
    rows = max(1, _STRIP_PIXELS // width)
    return [slice(top, top + rows) for top in range(0, height, rows)]


def _laid(valid, size):
    """Corners and middles, see `Tiles`, of squares of an image that is ``valid`` (h, w)."""
    if min(valid.shape) < size:
        return np.zeros((2, 0, 2), int)
    step = size // 2
    squares = sliding_window_view(valid, (size, size))[::step, ::step]
    corners = np.argwhere(squares.mean(axis=(2, 3)) >= _LEAST_VALID)
    y, x = np.mgrid[:size, :size] - (size - 1) / 2
    from_middle_out = np.argsort((y * y + x * x).ravel(), kind="stable")
    nearest = [from_middle_out[squares[row, col].ravel()[from_middle_out].argmax()] for row, col in corners]
    corners = corners * step
    return corners, corners + np.column_stack(np.divmod(np.array(nearest, int), size))


def _part(scan_image, model):
    """The rows and columns that lie in the photo, with a margin, as slices; None where none does."""
    xy, depth = model.project(model.sites(scan_image)[::_GLANCE, ::_GLANCE])
    inside = (depth > 0) & within(model, xy)
    if not inside.any():
        return None
    part = []
    for axis in (0, 1):
        there = np.flatnonzero(inside.any(axis=1 - axis)) * _GLANCE
        part.append(slice(max(0, there[0] - _MARGIN), min(scan_image.shape[axis], there[-1] + _MARGIN)))
    return tuple(part)


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
    corners = tiles.corners - sighting.corner
    inside = ((corners >= 0) & (corners + tiles.size <= sighting.seen.shape)).all(axis=1)
    shares = np.zeros(len(corners))
    shares[inside] = _tile_sums(sighting.seen.astype(np.float32), tiles.size)[tuple(corners[inside].T)] / tiles.size**2
    chosen = np.flatnonzero(shares >= _LEAST_COVER)
    if len(chosen) < _LEAST_TILES:
        return None
    middles = tiles.middles[chosen]
    row, col = (middles - sighting.corner).T
    at, places, inverse = sighting.sites[row, col], sighting.places[row, col], _inverse(sighting.jacobian[row, col])
    scores, lively = _correlations(sighting.own, sighting.features, corners[chosen], tiles.size, radius)
    good = lively & np.isfinite(places).all(axis=1) & np.isfinite(inverse).all(axis=(1, 2))
    if np.count_nonzero(good) < _LEAST_TILES:
        return None
    scale = float(np.median(sighting.range[row, col][good]))
    return Surfaces(scores[good], at[good], places[good], inverse[good], middles[good], scale)


def _tile_sums(image, size):
    """(H, W): the sum over the square of ``size`` pixels that begins at each pixel."""
    import cv2

    return cv2.boxFilter(
        image, cv2.CV_32F, (size, size), normalize=False, anchor=(0, 0), borderType=cv2.BORDER_CONSTANT
    )


def _correlations(own, other, corners, size, radius):
    """Normalized cross-correlation of every tile of ``own`` with ``other`` over all shifts, as deviations; and which
    tiles have anything to say."""
    padded = np.pad(other, ((radius, radius), (radius, radius), (0, 0)))
    energy = _tile_sums((padded**2).sum(axis=-1), size)
    usual = float(np.median(energy[energy > 0])) if (energy > 0).any() else 1.0
    energy = np.maximum(energy, 0.25 * usual)
    strength = _tile_sums((own**2).sum(axis=-1), size)[tuple(corners.T)]
    strong = strength > 1e-3
    scores = np.zeros((len(corners), 2 * radius + 1, 2 * radius + 1), np.float32)
    at, strength = corners[strong], strength[strong][:, None, None]
    energy = sliding_window_view(energy, scores.shape[1:])[tuple(at.T)]
    scores[strong] = _products(own, padded, at, size, radius) / np.sqrt(energy * strength)
    deviation = scores.std(axis=(1, 2), keepdims=True)
    return (scores - scores.mean(axis=(1, 2), keepdims=True)) / (deviation + 1e-3), deviation[:, 0, 0] > 1e-4


def _products(own, padded, corners, size, radius):
    """(N, 2 r + 1, 2 r + 1): sums of the products of each tile of ``own`` and what lies under it, for all shifts.

    Tiles half overlap, so that their quarters, which they share, are correlated instead: by FFT, which is the faster
    the smaller they are.
    """
    from scipy import fft

    half, window = size // 2, 2 * radius + 1
    quarters = corners[:, None] + half * np.array([(0, 0), (0, 1), (1, 0), (1, 1)])
    places, of_quarter = np.unique(quarters @ [own.shape[1], 1], return_inverse=True)
    rows, cols = np.divmod(places, own.shape[1])
    own_blocks = sliding_window_view(own, (half, half), axis=(0, 1))
    other_blocks = sliding_window_view(padded, (half + 2 * radius,) * 2, axis=(0, 1))
    length = fft.next_fast_len(half + 2 * radius, real=True)
    products = np.empty((len(places), window, window), np.float32)
    for begin in range(0, len(places), _BLOCKS):
        some = slice(begin, begin + _BLOCKS)
        own_spectra, spectra = (
            fft.rfft2(blocks[rows[some], cols[some]], (length, length)) for blocks in (own_blocks, other_blocks)
        )
        spectra *= np.conj(own_spectra)
        products[some] = fft.irfft2(spectra.sum(axis=1), (length, length))[:, :window, :window]
    return products[of_quarter.reshape(-1, 4)].sum(axis=1)


def _inverse(jacobian):
    """(N, 2, 2): from what moves in the photo to pixels of the scan; NaN where that cannot be told."""
    (a, b), (c, d) = np.moveaxis(jacobian, 0, -1)
    determinant = a * d - b * c
    usable = np.isfinite(jacobian).all(axis=(1, 2)) & (np.abs(determinant) > 1e-9)
    inverse = np.stack([np.stack([d, -b], -1), np.stack([-c, a], -1)], axis=1)
    return inverse / np.where(usable, determinant, np.nan)[:, None, None]
