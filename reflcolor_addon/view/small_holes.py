"""Small holes of a scan, where single pixels gave no return, as the surface around them goes on."""

import numpy as np

_LARGEST_PIXELS = 8
_NEIGHBORS = ((0, 1), (1, 0), (0, -1), (-1, 0))


def small_holes(kept, largest_pixels=_LARGEST_PIXELS):
    """Return which pixels lie in holes that are no wider and no higher than some pixels, with surface all around.

    Parameters
    ----------
    kept : (H, W) bool
        Pixels of the surface.
    largest_pixels : int

    Returns
    -------
    (H, W) bool
    """
    import cv2

    count, labels, sizes, _ = cv2.connectedComponentsWithStats((~kept).astype(np.uint8), connectivity=4)
    left, top, width, height = sizes[:count, :4].T
    inside = (left > 0) & (top > 0) & (left + width < kept.shape[1]) & (top + height < kept.shape[0])
    small = inside & (np.maximum(width, height) <= largest_pixels)
    small[0] = False
    return small[labels]


def nearest_kept(kept):
    """Return, for every pixel, the flat index of the nearest pixel that is kept: (H, W) int."""
    import cv2

    _, labels = cv2.distanceTransformWithLabels(
        (~kept).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    places = np.zeros(labels.max() + 1, np.int64)
    places[labels[kept]] = np.flatnonzero(kept)
    return places[labels]


def spread_into(holes, values, surface):
    """Fill holes so that each pixel is the mean of its neighbors of the same surface: planes go on as planes.

    Parameters
    ----------
    holes : (H, W) bool
    values : (H, W) float64
        What is to be filled, with a first guess in the holes.
    surface : (H, W) int
        Which surface a pixel is on; negative where on none.

    Returns
    -------
    (H, W) float64
    """
    height, width = holes.shape
    values = values.ravel().copy()
    places = np.flatnonzero(holes)
    if not places.size:
        return values.reshape(height, width)
    rows, cols = places // width, places % width
    beside = np.stack([(rows + down) * width + cols + right for down, right in _NEIGHBORS], axis=1)
    inside = np.stack(
        [
            (rows + down >= 0) & (rows + down < height) & (cols + right >= 0) & (cols + right < width)
            for down, right in _NEIGHBORS
        ],
        axis=1,
    )
    beside = np.where(inside, beside, places[:, None])
    surface = surface.ravel()
    alike = inside & (surface[beside] == surface[places][:, None])
    count = alike.sum(axis=1)
    settled = count == 0
    for _ in range(4 * _LARGEST_PIXELS**2):
        mean = np.where(alike, values[beside], 0).sum(axis=1) / np.maximum(count, 1)
        values[places] = np.where(settled, values[places], mean)
    return values.reshape(height, width)
