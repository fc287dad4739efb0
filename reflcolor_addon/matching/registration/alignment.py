"""Fits an accepted model once more, at the scan's full resolution.

A model is found and judged on images much coarser than a large scan, and is off by about one of their pixels. Colors at
every pixel of the scan show that as ghosts beside every edge.
"""

from dataclasses import replace

import numpy as np

from ..scan_image import ScanImage, pixel_steps, reflectance_image
from .refinement import fitted, tightened
from .tiles import Tiles, surfaces

# Pixels of the longer side of the images that are fitted on, one after the other; of a tile, and of the way that a tile
# is sought.
_LONGEST, _TILE, _RADIUS = (400, 1500), 64, 6
# A homography, of more numbers than a camera and looser from the search, is sought first in a wider circle: tile, way,
# and see `fitted`.
_WIDE_TILE, _WIDE_RADIUS, _BLUR, _SPREAD = 32, 12, 2.0, 5.0
_MOST_TILES = 600
_ROUNDS = 3
# A round that moves no tile by more than so many pixels is the last one.
_STILL = 0.1


def aligned(scan, photo, model):
    """Return the model that fits best near ``model``; the same one where the tiles do not say that another is better.

    Parameters
    ----------
    scan : Scan
    photo : PhotoImage
    model : Camera or GridHomography
    """
    vertical, horizontal = pixel_steps(scan)
    extent = max(scan.shape[0] * vertical, scan.shape[1] * horizontal)
    images = [ScanImage(scan, reflectance_image(scan, "ranks"), extent / longest) for longest in _LONGEST]
    if model.kind == "homography":
        model = _sought(images[0], photo, model)
    for image in images:
        model = _tightened(image, photo, model)
    return model


def _sought(image, photo, model):
    """The best model around on one image, if it fits better."""
    tiles = _some(Tiles.of(image, _WIDE_TILE))
    found = surfaces(image, tiles, photo, model, _WIDE_RADIUS)
    if found is None:
        return model
    rng = np.random.default_rng(0)
    moved, _ = fitted(found, model, model.ALL, blur=_BLUR, spread=_SPREAD, rng=rng)
    after = surfaces(image, tiles, photo, moved, _WIDE_RADIUS)
    return model if after is None or _fit(after) <= _fit(found) else moved


def _tightened(image, photo, model):
    """The model after some rounds on one image, as long as they fit better."""
    tiles = _some(Tiles.of(image, _TILE))
    found = surfaces(image, tiles, photo, model, _RADIUS)
    for _ in range(_ROUNDS):
        if found is None:
            return model
        moved = tightened(found, model, model.ALL)
        shift = np.median(np.linalg.norm(moved.project(found.sites)[0] - found.places, axis=1))
        after = surfaces(image, tiles, photo, moved, _RADIUS)
        if after is None or _fit(after) <= _fit(found):
            return model
        model, found = moved, after
        if shift < _STILL:
            return model
    return model


def _some(tiles):
    step = -(-len(tiles.corners) // _MOST_TILES)
    return replace(tiles, corners=tiles.corners[::step], middles=tiles.middles[::step])


def _fit(found):
    """Mean score of all tiles where the model puts them."""
    return float(found.scores[:, found.radius, found.radius].mean())
