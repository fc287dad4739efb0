"""A photo at several sizes, seen through a model as the scan's pixels see it."""

from collections.abc import Sequence
from functools import cached_property
from os import PathLike

import numpy as np

from ..files.photo import Photo
from .edges import gradient, gradient_features
from .models import within

# Longer sides, in pixels, of the images of a photo.
_SIDES = tuple(2048 * 2 ** (-half / 2) for half in range(13))
_LARGEST_COLOR_SIDE = 6000

_Photo = PathLike | str | np.ndarray | tuple[str, np.ndarray] | Photo
Photos = _Photo | Sequence[_Photo]
"""Paths of photos (an E57 stands for those inside), their pixels (H, W, 3) uint8 sRGB, or names and pixels; or only one
of these."""


class PhotoImage:
    """A photo for matching.

    Parameters
    ----------
    name : str
    rgb : (H, W, 3) uint8
        sRGB.
    place : Place, optional
        Where it was taken, as its file says.

    Attributes
    ----------
    height, width : int
        Of the photo as given: its places are counted in these pixels.
    rgb : (h, w, 3) uint8
        The photo, or where a side is longer than 6000 pixels what is left of it at that size.
    """

    def __init__(self, name, rgb, place=None):
        import cv2

        self.name, self.place = name, place
        self.height, self.width = rgb.shape[:2]
        scale = max(self.width, self.height) / _LARGEST_COLOR_SIDE
        if scale > 1:
            size = (max(1, round(self.width / scale)), max(1, round(self.height / scale)))
            rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
        self.rgb = rgb
        self._made = {}

    @cached_property
    def gray(self):
        """(h, w) float32, at most 2048 pixels a side: no scan has more detail, and time grows with pixels."""
        import cv2

        return cv2.cvtColor(_sized(self.rgb, min(1.0, _SIDES[0] / max(self.rgb.shape[:2]))), cv2.COLOR_RGB2GRAY).astype(
            np.float32
        )

    def level(self, pixels):
        """Return the gray image (h, w) float32 whose pixels are about as large as ``pixels`` pixels of the photo, and
        how large they are.

        There are images of the same few sizes of any photo: what is found must not depend on how many pixels a picture
        was stored with. A photo of fewer pixels is enlarged.
        """
        side = min(_SIDES, key=lambda side: abs(np.log(max(self.width, self.height) / side / max(pixels, 1e-3))))
        image = self.once(("level", side), lambda: _sized(self.gray, side / max(self.gray.shape)))
        return image, max(self.width, self.height) / side

    def once(self, key, make):
        """Return what ``make`` returned the first time."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def let_go(self):
        """Drop what was made of the photo; what is needed again is made anew, and is the same."""
        self._made.clear()

    def features(self, xy, jacobian, inside):
        """Return the (h, w, 3) edge features of the photo at places of it.

        The edges are those of the photo itself, turned as the scan's pixels see them. Nothing of the scan makes an edge
        in them: no hole, and no jump of its range, where neighboring pixels look at different parts of the photo.

        Parameters
        ----------
        xy : (h, w, 2) float64
            Pixels from the photo's top left corner.
        jacobian : (h, w, 2, 2) float64
            What a pixel to the right, and down, moves a place: [x or y, step].
        inside : (h, w) bool
            Which places lie in the photo.
        """
        return gradient_features(*self._gradient(xy, jacobian, inside), inside)

    def _gradient(self, xy, jacobian, inside):
        """What the photo grows by with a step to the right, and down, in the scan: (h, w) float32 each."""
        import cv2

        area = np.abs(jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0])[inside]
        pixels = float(np.sqrt(np.median(area)))
        image, scale = self.level(pixels)
        edges = self.once(("gradient", scale), lambda: cv2.merge(gradient(image)))
        x, y = (np.where(inside, xy[..., axis] / scale - 0.5, -2).astype(np.float32) for axis in (0, 1))
        own = cv2.remap(edges, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        own_x, own_y = own[..., 0] * inside, own[..., 1] * inside
        step = np.where(inside[..., None, None], jacobian, 0).astype(np.float32)
        step /= np.float32(scale)
        return [own_x * step[..., 0, axis] + own_y * step[..., 1, axis] for axis in (0, 1)]


def _sized(image, factor):
    import cv2

    if factor == 1:
        return image
    size = tuple(max(1, round(side * factor)) for side in image.shape[1::-1])
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA if factor < 1 else cv2.INTER_CUBIC)


def visible(model, valid, xy, depth, tolerance=0.04, panes=None):
    """Return (h, w) bool: which pixels of a `ScanImage`, or of a part of one, the photo really sees.

    By a depth buffer of the scan's own points. What is hidden by something that the scanner did not see is not found.

    Parameters
    ----------
    model : Camera or GridHomography
    valid : (h, w) bool
        Of that image.
    xy, depth : (h, w, 2), (h, w)
        As ``model.project`` gave them for the pixels.
    tolerance : float
        What lies farther than the nearest in the same place by more than this share is hidden.
    panes : (K, 3) float64, optional
        Points that hide what is behind them, too, meters, scanner frame.
    """
    inside = valid & (depth > 0) & within(model, xy)
    if model.kind == "homography" or not inside.any():
        return inside
    nearest, place = depth_buffer(model, xy, depth, inside, panes)
    seen = inside.copy()
    seen[inside] = depth[inside] <= nearest[place] * (1 + tolerance)
    return seen


def depth_buffer(model, xy, depth, inside, more=None):
    """Return the depth of the nearest surface in each cell of a photo, very large where there is none, and the cells.

    Parameters
    ----------
    model : Camera
    xy, depth : (h, w, 2), (h, w)
        As ``model.project`` gave them for the pixels of a scan.
    inside : (h, w) bool
        Which of them to take, N of them.
    more : (K, 3) float64, optional
        Points of other surfaces.

    Returns
    -------
    nearest : (rows, columns) float64
    place : tuple of two (N,) int
        Row and column of the cell of each.
    """
    import cv2

    cell = max(1.3 * spacing(xy, inside), max(model.width, model.height) / 2000)
    columns, rows = int(model.width / cell) + 2, int(model.height / cell) + 2
    column, row = (xy[inside] / cell).astype(int).T
    nearest = np.full((rows, columns), np.inf)
    np.minimum.at(nearest, (row, column), depth[inside])
    if more is not None and len(more):
        xy_more, depth_more = model.project(more)
        there = within(model, xy_more)
        column_more, row_more = (xy_more[there] / cell).astype(int).T
        np.minimum.at(nearest, (row_more, column_more), depth_more[there])
    # Between its points, too, a surface hides what is behind; closing fills the gaps and leaves the outlines.
    window = np.ones((5, 5))
    return cv2.dilate(cv2.erode(np.minimum(nearest, 1e9), window), window), (row, column)


def spacing(xy, seen):
    """Return the median distance in the photo between horizontal neighbors of the scan, in pixels."""
    # Over several pixels: where the scan's columns are coarse, neighbors show the same point.
    reach = min(8, seen.shape[1] - 1)
    both = seen[:, reach:] & seen[:, : seen.shape[1] - reach]
    if reach == 0 or not both.any():
        return 1.0
    distance = np.hypot(*(xy[:, reach:][both] - xy[:, : seen.shape[1] - reach][both]).T)
    return float(max(np.median(distance) / reach, 0.01))
