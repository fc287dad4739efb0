"""Whether a photo would fit elsewhere as well: on surfaces that repeat, such as tiles, bricks and windows in a row.

The edges of one tiled wall fit those of another one, so that a photo of another room may have most of the scan's tiles
in place. Two things tell them apart. A tile that is sought in a window three times as wide has several best places if
its surroundings repeat, so that it is in place by luck. And where everything repeats, the photo's edges fit nearly as
well when they are moved to another place, or mirrored.
"""

from dataclasses import replace

import numpy as np

from .tiles import Sighting, Tiles, surfaces
from .verification import RADIUS, TILE, in_place, judged, strength_of

# How much wider a window is; the share of the tiles in place that must still be in place there, so that nothing else is
# asked. Wrong photos have 0.1 to 0.5, right ones of real scans 0.6 and more.
_WIDER, _HELD = 3, 0.55
# Places that are tried for each way of turning the photo's edges, from the highest sum of products on; and how far from
# where the model puts them they begin, in pixels.
_PLACES, _ELSEWHERE = 3, 8
# Of the scan's part that the photo shows, how far the edges are moved at most.
_REACH = 0.3
# Pixels within which there is but one place.
_PEAK = 7


def alone(proof, scan_image, photo, model):
    """Return the `Evidence` with what a search in wider windows finds, and how well the photo would fit elsewhere."""
    sighting = Sighting.of(scan_image, photo, model)
    tiles = Tiles.of(scan_image, TILE)
    found = None if sighting is None else surfaces(scan_image, tiles, photo, model, _WIDER * RADIUS, sighting)
    if found is None:
        return proof
    held = _held(found.scores)
    if held >= _HELD:
        return replace(proof, held=held)
    here = judged(surfaces(scan_image, tiles, photo, model, RADIUS, sighting)).strength
    return replace(
        proof, held=held, elsewhere=max(_elsewhere(scan_image, sighting, model), default=0.0) / max(here, 1e-6)
    )


def _held(scores):
    """The share of the tiles in place that are still in place in a window of the size of ``scores`` (N, h, h)."""
    margin = scores.shape[1] // 2 - RADIUS
    near = in_place(scores[:, margin:-margin, margin:-margin])
    return float((near & in_place(scores)).sum() / max(near.sum(), 1))


def _elsewhere(scan_image, sighting, model):
    """Yield the strengths that a model has, once fitted, where the photo's edges are turned or moved to fit elsewhere.

    They are moved to where the sum of the products with the scan's edges is highest.
    """
    rng = np.random.default_rng(0)
    for flipped in (False, True):
        for mirrored in (False, True):
            features = _turned(sighting.features, flipped, mirrored)
            nearest = 0 if flipped or mirrored else _ELSEWHERE
            for down, right in _best_shifts(sighting.own, features, nearest):
                yield strength_of(scan_image, sighting, model, _moved(features, down, right), rng) or 0.0


def _turned(features, flipped, mirrored):
    """Edge features (h, w, 3) of a photo that is upside-down, or mirrored, or both."""
    if flipped:
        features = features[::-1]
    if mirrored:
        features = features[:, ::-1]
    return features * np.float32([1, 1, -1 if flipped != mirrored else 1])


def _moved(features, down, right):
    """What lies ``down`` and ``right`` pixels away, brought here; zero beyond the image."""
    import cv2

    height, width = features.shape[:2]
    return cv2.warpAffine(
        features, np.float32([[1, 0, -right], [0, 1, -down]]), (width, height), flags=cv2.INTER_NEAREST
    )


def _best_shifts(own, features, nearest):
    """The shifts (K, 2), down and right, of at least ``nearest`` pixels where features agree best with the scan's."""
    from scipy import fft, ndimage

    height, width = own.shape[:2]
    size = [fft.next_fast_len(2 * length, real=True) for length in (height, width)]
    own_spectra, spectra = (fft.rfft2(image, size, axes=(0, 1)) for image in (own, features))
    spectra *= np.conj(own_spectra)
    sums = fft.irfft2(spectra.sum(axis=2), size)
    down, right = int(_REACH * height), int(_REACH * width)
    sums = np.roll(sums, (down, right), (0, 1))[: 2 * down + 1, : 2 * right + 1]
    shifts = np.argwhere(sums == ndimage.maximum_filter(sums, _PEAK))
    worth = sums[tuple(shifts.T)]
    shifts -= [down, right]
    far = np.hypot(*shifts.T) >= nearest
    return shifts[far][np.argsort(-worth[far], kind="stable")[:_PLACES]]
