"""The geometry of the pointer: places in an image as an editor shows it, points near it, inside an outline, along its
path."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ImageView:
    """How an editor shows an image.

    Parameters
    ----------
    size : (width, height)
        Of the image, in its pixels.
    corner : (x, y)
        Where the image's bottom left corner is, in pixels of the editor's region from its bottom left.
    scale : (x, y)
        Pixels of the region for one of the image.
    """

    size: tuple[int, int]
    corner: tuple[float, float]
    scale: tuple[float, float]

    @classmethod
    def through(cls, size, first, second, margin):
        """Return the view in which the image's bottom left corner less ``margin`` images falls on ``first``.

        ``second`` is where its top right corner plus ``margin`` images falls; both in pixels of the region. The larger
        the margin, the less matters that an editor rounds them.
        """
        spans = [(b - a) / (1 + 2 * margin) for a, b in zip(first, second, strict=True)]
        corner = tuple(a + span * margin for a, span in zip(first, spans, strict=True))
        return cls(tuple(size), corner, tuple(span / side for span, side in zip(spans, size, strict=True)))

    @property
    def extent(self):
        """(width, height) of the image in pixels of the region."""
        return tuple(side * scale for side, scale in zip(self.size, self.scale, strict=True))

    def to_region(self, xy):
        """Return where (..., 2) points of the image, in pixels from its top left corner, are in the region."""
        xy = np.asarray(xy, np.float64)
        return np.stack(
            [
                self.corner[0] + xy[..., 0] * self.scale[0],
                self.corner[1] + (self.size[1] - xy[..., 1]) * self.scale[1],
            ],
            axis=-1,
        )

    def to_image(self, place):
        """Return the (x, y) of the image, in pixels from its top left corner, that is at a place of the region."""
        x = (place[0] - self.corner[0]) / self.scale[0]
        return x, self.size[1] - (place[1] - self.corner[1]) / self.scale[1]


def pixel_at(xy, shape):
    """Return the (row, column) of the pixel that contains a point of the image; None outside of it.

    Parameters
    ----------
    xy : (x, y)
        Pixels from the top left corner.
    shape : (H, W)
    """
    row, column = int(np.floor(xy[1])), int(np.floor(xy[0]))
    return (row, column) if 0 <= row < shape[0] and 0 <= column < shape[1] else None


def clamped_pixel(xy, shape):
    """Return the (row, column) of the pixel nearest to a point of the image, or outside of it."""
    return tuple(int(np.clip(np.floor(value), 0, side - 1)) for value, side in zip((xy[1], xy[0]), shape, strict=True))


def clamped_point(xy, size):
    """Return the point of an image of (width, height) pixels that is nearest to a point outside of it."""
    return tuple(float(np.clip(value, 0, side)) for value, side in zip(xy, size, strict=True))


def centers(rows, cols):
    """Return (S, 2) x and y of the centers of pixels, in pixels from the image's top left corner."""
    return np.stack([np.asarray(cols) + 0.5, np.asarray(rows) + 0.5], axis=-1)


def nearest_within(points, place, radius):
    """Return the index of the point nearest to a place and within ``radius`` of it, the last of several; None if none.

    Parameters
    ----------
    points : (S, 2) float
    place : (x, y)
    radius : float
    """
    if not len(points):
        return None
    squared = ((np.asarray(points) - place) ** 2).sum(axis=1)
    least = len(squared) - 1 - int(np.argmin(squared[::-1]))
    return least if squared[least] <= radius**2 else None


def inside_outline(points, outline):
    """Return (S,) bool: which points lie inside a closed outline.

    Parameters
    ----------
    points : (S, 2) float
    outline : (P, 2) float
        Corners in order; fewer than three enclose nothing.
    """
    from skimage.measure import points_in_poly

    if len(outline) < 3 or not len(points):
        return np.zeros(len(points), bool)
    return points_in_poly(np.asarray(points, np.float64), np.asarray(outline, np.float64))


def box_outline(corner, opposite):
    """Return the four corners of the box between two."""
    (left, bottom), (right, top) = corner, opposite
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def beads(start, end, spacing):
    """Return the points that lie ``spacing`` apart on the way from one point to another, without the first.

    Parameters
    ----------
    start, end : (x, y)
    spacing : float
        More than 0.

    Returns
    -------
    (B, 2) float
        Empty where the end is nearer than ``spacing``.
    """
    start, way = np.asarray(start, np.float64), np.subtract(end, start)
    length = float(np.hypot(*way))
    steps = np.arange(1, int(length / spacing) + 1) * spacing
    return start + steps[:, None] * (way / max(length, 1e-12))


def mark_spacing(count, width, height):
    """Return how far apart marks are, in pixels, if so many lie evenly in an area of so many pixels."""
    return float(np.sqrt(max(width * height, 0) / max(count, 1)))


def corner_nearest(corners, place):
    """Return the index of the (C, 3) corner that is nearest to a place."""
    return int(np.argmin(((np.asarray(corners, np.float64) - place) ** 2).sum(axis=1)))
