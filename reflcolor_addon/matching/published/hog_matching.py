"""Method 2 as published: superpixels of both images, HOG of the Canny edges around each, the nearest wins."""

from dataclasses import dataclass

import numpy as np

from ..scan_image import ScanImage, pixel_steps
from ..superpixels import LONGEST_SIDE, Superpixels, sized, superpixels

_CANNY = (60, 140)


@dataclass(frozen=True, eq=False)
class Described:
    """The superpixels of one image, a descriptor (count, D) for each, and the image's colors (h, w, 3) or None."""

    superpixels: Superpixels
    descriptors: np.ndarray
    rgb: np.ndarray | None
    shape: tuple[int, int]

    @property
    def centers_xy(self):
        """(count, 2): the centers as shares of width and height."""
        return (self.superpixels.centers[:, ::-1] + 0.5) / np.array(self.shape[::-1])


@dataclass(frozen=True, eq=False)
class HogMatches:
    """For each superpixel of the scan the most similar one among those of all photos.

    photo : (S,) int, segment : (S,) int, similarity : (S,) float in 0..1, rgb : (S, 3) uint8, xy : (S, 2) shares of the
    photo's width and height.
    """

    photo: np.ndarray
    segment: np.ndarray
    similarity: np.ndarray
    rgb: np.ndarray
    xy: np.ndarray


def square_image(scan, tone_image, angles=None):
    """Return the scan as a `ScanImage` of its finest square pixels, at most `superpixels.LONGEST_SIDE` a side."""
    vertical, horizontal = pixel_steps(scan)
    extent = max(scan.shape[0] * vertical, scan.shape[1] * horizontal)
    return ScanImage(scan, tone_image, max(extent / LONGEST_SIDE, min(vertical, horizontal)), angles=angles)


def scan_superpixels(scan, image, settings):
    """Return the `Superpixels` of a scan's square image."""
    return superpixels(image.reflectance, image.valid, **_slic(settings), full_turn=scan.full_turn)


def described_scan(scan, image, found, settings):
    """Return the `Described` superpixels of a scan's square image; the window goes around on a full turn."""
    descriptors = _descriptors(image.reflectance, found.centers, settings, wrap=scan.full_turn)
    return Described(found, descriptors, None, image.shape)


def described_photo(rgb, longest, settings):
    """Return the `Described` superpixels of a photo (H, W, 3), at ``longest`` pixels a side, as the scan has."""
    import cv2

    small = sized(rgb, longest)
    found = superpixels(small.astype(np.float32), np.ones(small.shape[:2], bool), **_slic(settings))
    gray = cv2.cvtColor(small, cv2.COLOR_RGB2GRAY).astype(np.float32)
    return Described(found, _descriptors(gray, found.centers, settings, wrap=False), small, small.shape[:2])


def hog_matches(scan, photos):
    """Return the `HogMatches` of a `Described` scan with `Described` photos."""
    stacked = np.concatenate([photo.descriptors for photo in photos])
    owner = np.repeat(np.arange(len(photos)), [len(photo.superpixels) for photo in photos])
    segment = np.concatenate([np.arange(len(photo.superpixels)) for photo in photos])
    best = np.empty(len(scan.superpixels), int)
    distance = np.empty(len(best))
    squares = (stacked**2).sum(axis=1)
    for start in range(0, len(best), 256):
        own = scan.descriptors[start : start + 256]
        squared = (own**2).sum(axis=1)[:, None] + squares - 2 * own @ stacked.T
        best[start : start + 256] = squared.argmin(axis=1)
        distance[start : start + 256] = np.sqrt(np.maximum(squared.min(axis=1), 0))
    rgb = np.array(
        [
            photos[p].rgb[tuple(photos[p].superpixels.centers[s])]
            for p, s in zip(owner[best], segment[best], strict=True)
        ]
    )
    xy = np.array([photos[p].centers_xy[s] for p, s in zip(owner[best], segment[best], strict=True)])
    length = np.linalg.norm(scan.descriptors, axis=1) + np.sqrt(squares[best])
    similarity = np.clip(1 - distance / np.maximum(length, 1e-6), 0, 1)
    return HogMatches(owner[best], segment[best], similarity, rgb.reshape(-1, 3).astype(np.uint8), xy.reshape(-1, 2))


def _slic(settings):
    return {
        "segments": settings.slic_segments,
        "compactness": settings.slic_compactness,
        "sigma": settings.slic_sigma,
    }


def _descriptors(gray, centers, settings, *, wrap):
    """(count, D) float64: HOG (Dalal and Triggs 2005) of the Canny edges in the window around each center."""
    import cv2
    from skimage.feature import hog

    window = settings.hog_window
    canny = cv2.Canny(np.clip(gray, 0, 255).astype(np.uint8), *_CANNY)
    half = window // 2
    edges = np.pad(canny, ((half, window - half), (0, 0)))
    edges = np.pad(edges, ((0, 0), (half, window - half)), mode="wrap" if wrap else "constant")
    return np.array(
        [
            hog(
                edges[row : row + window, col : col + window],
                orientations=settings.hog_orientations,
                pixels_per_cell=(settings.hog_cell, settings.hog_cell),
                cells_per_block=(settings.hog_block, settings.hog_block),
            )
            for row, col in centers
        ]
    )
