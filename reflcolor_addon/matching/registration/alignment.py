"""Fits an accepted model once more, at the scan's full resolution.

A model is found and judged on images much coarser than a large scan, and is off by about one of their pixels. Colors at
every pixel of the scan show that as ghosts beside every edge.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from ..grid_angles import GridAngles
from ..models import GridHomography, within
from ..scan_image import ScanImage, pixel_steps, reflectance_image
from .refinement import fitted, tightened
from .tiles import Tiles, surfaces

# Pixels of the longer side of the images that are fitted on, one after the other; of a tile, and of the way that a tile
# is sought.
_LONGEST, _TILE, _RADIUS = (400, 1500), 64, 6
# A homography, of more numbers than a camera and looser from the search, is sought first in a wider circle: tile, way,
# and see `fitted`; again and again while that fits better by more than the last, a share.
_WIDE_TILE, _WIDE_RADIUS, _BLUR, _SPREAD = 32, 12, 2.0, 5.0
_SEEKS, _BETTER = 10, 0.01
# A homography is sought beside a camera unless it fits worse from the first by so many deviations (see `_fit`), and is
# taken if it fits better in the end by so many: chance alone gives less.
_WORSE, _BETTER_BY = 0.2, 0.5
_MOST_TILES = 600
_ROUNDS = 3
# A round that moves no tile by more than so many pixels is the last one.
_STILL = 0.1


class Alignment:
    """What fitting photos on a scan at full resolution needs, computed once, on first use.

    Parameters
    ----------
    scan : Scan
    angles : GridAngles, optional
        Of the scan, where they are known already.
    """

    def __init__(self, scan, angles=None):
        self._scan, self._angles = scan, angles

    @cached_property
    def _images(self):
        scan = self._scan
        vertical, horizontal = pixel_steps(scan)
        extent = max(scan.shape[0] * vertical, scan.shape[1] * horizontal)
        ranks, angles = reflectance_image(scan, "ranks"), self._angles or GridAngles.of(scan)
        return [ScanImage(scan, ranks, extent / longest, angles=angles) for longest in _LONGEST]

    def aligned(self, photo, model, *, camera_only=False):
        """Return the model that fits best near ``model``; the same where the tiles do not say that another is better.

        A picture that was warped in some program is no camera's any more. Where a homography of the scan's grid fits
        clearly better than a camera, it is returned instead.

        Parameters
        ----------
        photo : PhotoImage
        model : Camera or GridHomography
        camera_only : bool
            Whether a camera has to stay one, because a person placed it.
        """
        images = self._images
        if model.kind == "homography":
            return _refitted(images, photo, _sought(images[0], photo, model))[0]
        camera, fit_of_camera = _refitted(images, photo, model)
        flat = None if camera_only else _flat(images[0], camera, self._scan.shape)
        if flat is None or _fit_on(images[0], photo, flat) < _fit_on(images[0], photo, camera) - _WORSE:
            return camera
        flat, fit_of_flat = _refitted(images, photo, _sought(images[0], photo, flat))
        return flat if fit_of_flat > fit_of_camera + _BETTER_BY else camera


def _flat(image, camera, grid_shape):
    """The homography of the grid that is nearest to what a camera sees; None where there is none."""
    import cv2

    places, depth = camera.project(camera.sites(image))
    seen = image.valid & (depth > 0) & within(camera, places)
    if np.count_nonzero(seen) < 4:
        return None
    matrix, _ = cv2.findHomography(image.grid_xy[seen], places[seen])
    return None if matrix is None else GridHomography(matrix, grid_shape, camera.width, camera.height)


def _refitted(images, photo, model):
    """The model fitted on one image after the other, and how well it fits on the last one (see `_fit_on`)."""
    fit = -np.inf
    for image in images:
        model, fit = _tightened(image, photo, model)
    return model, fit


def _sought(image, photo, model):
    """The best homography around on one image, as long as one fits better."""
    tiles = _some(Tiles.of(image, _WIDE_TILE))
    found = surfaces(image, tiles, photo, model, _WIDE_RADIUS)
    for _ in range(_SEEKS):
        if found is None:
            return model
        rng = np.random.default_rng(0)
        moved, _ = fitted(found, model, model.ALL, blur=_BLUR, spread=_SPREAD, rng=rng)
        after = surfaces(image, tiles, photo, moved, _WIDE_RADIUS)
        if after is None or _fit(after) <= _fit(found) + _BETTER * abs(_fit(found)):
            return model
        model, found = moved, after
    return model


def _tightened(image, photo, model):
    """The model after some rounds on one image, as long as they fit better; and how well it fits."""
    tiles = _some(Tiles.of(image, _TILE))
    found = surfaces(image, tiles, photo, model, _RADIUS)
    if found is None:
        return model, -np.inf
    for _ in range(_ROUNDS):
        moved = tightened(found, model, model.ALL)
        shift = np.median(np.linalg.norm(moved.project(found.sites)[0] - found.places, axis=1))
        after = surfaces(image, tiles, photo, moved, _RADIUS)
        if after is None or _fit(after) <= _fit(found):
            break
        model, found = moved, after
        if shift < _STILL:
            break
    return model, _fit(found)


def _some(tiles):
    step = -(-len(tiles.corners) // _MOST_TILES)
    return replace(tiles, corners=tiles.corners[::step], middles=tiles.middles[::step])


def _fit_on(image, photo, model):
    """The same of a model on an image; less than any where the photo shows too little of it."""
    found = surfaces(image, _some(Tiles.of(image, _TILE)), photo, model, _RADIUS)
    return -np.inf if found is None else _fit(found)


def _fit(found):
    """Mean score of all tiles where the model puts them, in deviations from each tile's mean."""
    return float(found.scores[:, found.radius, found.radius].mean())
