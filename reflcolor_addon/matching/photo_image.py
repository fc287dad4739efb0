"""A photo at several sizes, seen through a model as the scan's pixels see it."""

from functools import cached_property

import numpy as np

from .edges import edge_features, filled

_LARGEST_SIDE = 2048
_LARGEST_COLOR_SIDE = 6000


class PhotoImage:
    """A photo for matching.

    Parameters
    ----------
    name : str
    rgb : (H, W, 3) uint8
        sRGB.

    Attributes
    ----------
    height, width : int
        Of the photo as given: its places are counted in these pixels.
    rgb : (h, w, 3) uint8
        The photo, or where a side is longer than 6000 pixels what is left of it at that size.
    """

    def __init__(self, name, rgb):
        import cv2

        self.name = name
        self.height, self.width = rgb.shape[:2]
        scale = max(self.width, self.height) / _LARGEST_COLOR_SIDE
        if scale > 1:
            size = (max(1, round(self.width / scale)), max(1, round(self.height / scale)))
            rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
        self.rgb = rgb

    @cached_property
    def levels(self):
        """Gray images, float32, each half the size of the one before, and how many pixels of the photo theirs are.

        The first is the photo itself, or where it is larger than 2048 pixels what is left of it at that size: no scan
        has more detail, and time goes with the pixels.
        """
        import cv2

        rgb, scale = self.rgb, max(1.0, max(self.width, self.height) / _LARGEST_SIDE)
        if scale > 1:
            size = (max(1, round(self.width / scale)), max(1, round(self.height / scale)))
            rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
        levels = [(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY).astype(np.float32), scale)]
        while min(levels[-1][0].shape) >= 32:
            levels.append((cv2.pyrDown(levels[-1][0]), levels[-1][1] * 2))
        return levels

    def level(self, pixels):
        """Return the gray image, and its scale, whose pixels are about as large as ``pixels`` pixels of the photo."""
        return min(self.levels, key=lambda level: abs(np.log(level[1] / max(pixels, 1e-3))))

    def sampled(self, xy, seen, pixels):
        """Return the (h, w) float32 gray at places of the photo, and (h, w) bool where that is inside it.

        Parameters
        ----------
        xy : (h, w, 2) float64
            Pixels from the photo's top left corner.
        seen : (h, w) bool
        pixels : float
            How many pixels of the photo lie between neighboring places.
        """
        import cv2

        image, scale = self.level(pixels)
        x, y = (np.where(seen, xy[..., axis] / scale - 0.5, -2).astype(np.float32) for axis in (0, 1))
        seen = seen & (x >= 0) & (y >= 0) & (x <= image.shape[1] - 1) & (y <= image.shape[0] - 1)
        return cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), seen

    def features(self, xy, seen, pixels):
        """Return the (h, w, 5) edge features of the photo as `sampled`, and where it is seen."""
        image, seen = self.sampled(xy, seen, pixels)
        return edge_features(filled(image, seen), seen), seen


def visible(model, image, xy, depth, tolerance=0.04, panes=None):
    """Return (h, w) bool: which pixels of a `ScanImage` the photo really sees.

    By a depth buffer of the scan's own points. What is hidden by something that the scanner did not see is not found.

    Parameters
    ----------
    model : Camera or GridHomography
    image : ScanImage
    xy, depth : (h, w, 2), (h, w)
        As ``model.project`` gave them for the pixels.
    tolerance : float
        What lies farther than the nearest in the same place by more than this share is hidden.
    panes : (K, 3) float64, optional
        Points that hide what is behind them, too, metres, scanner frame.
    """
    inside = image.valid & np.isfinite(xy).all(axis=-1) & (depth > 0)
    inside &= (xy >= 0).all(axis=-1) & (np.nan_to_num(xy) <= [model.width, model.height]).all(axis=-1)
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
        there = np.isfinite(xy_more).all(axis=-1) & (xy_more >= 0).all(axis=-1)
        there &= (np.nan_to_num(xy_more) <= [model.width, model.height]).all(axis=-1)
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
    distance = np.linalg.norm((xy[:, reach:] - xy[:, : seen.shape[1] - reach])[both], axis=-1)
    return float(max(np.median(distance) / reach, 0.01))
