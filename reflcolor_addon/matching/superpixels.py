"""SLIC superpixels of the scan and of photos, on square pixels."""

from dataclasses import dataclass

import numpy as np

from .edges import filled

LONGEST_SIDE = 1200
"""Images are brought to at most so many pixels a side: SLIC's time goes with them, and they suffice."""


@dataclass(frozen=True, eq=False)
class Superpixels:
    """Segments of an image.

    labels : (h, w) int32
        0 to count - 1; -1 where nothing was measured.
    centers : (count, 2) int
        Row and column of the pixel of each segment that is nearest to its middle.
    """

    labels: np.ndarray
    centers: np.ndarray

    def __len__(self):
        return len(self.centers)


def superpixels(image, valid, *, segments, compactness, sigma, full_turn=False):
    """Divide an image into segments (SLIC of Achanta et al. 2012).

    Parameters
    ----------
    image : (h, w) or (h, w, 3) float32
        Gray or sRGB, 0..255.
    valid : (h, w) bool
        Segments are kept where this is True.
    segments : int
        About how many are wanted on the valid part.
    compactness, sigma : float
        As scikit-image has them, for intensities of 0..1 and CIELAB.
    full_turn : bool
        Whether the right edge joins the left one; segments lie across it then.

    Returns
    -------
    Superpixels
        Not a single one where nothing is valid.
    """
    pixels = int(np.count_nonzero(valid))
    if pixels == 0:
        return Superpixels(np.full(valid.shape, -1, np.int32), np.zeros((0, 2), int))
    if segments >= pixels:
        labels = np.full(valid.shape, -1, np.int32)
        labels[valid] = np.arange(pixels)
        return Superpixels(labels, np.argwhere(valid))
    wanted = int(np.clip(round(segments * valid.size / pixels), 1, valid.size))
    source = filled(image, valid) if image.ndim == 2 else image
    labels, across = _slic(source / 255.0, wanted, compactness, sigma, full_turn)
    kept, inverse = np.unique(labels[valid], return_inverse=True)
    numbered = np.full(valid.shape, -1, np.int32)
    numbered[valid] = inverse.reshape(-1)
    return Superpixels(numbered, nearest_to_middles(numbered, len(kept), np.isin(kept, across)))


def _slic(image, wanted, compactness, sigma, full_turn):
    """(h, w) int labels of about ``wanted`` segments, and which of them lie across the edge of a full turn."""
    from skimage.segmentation import slic

    height, width = image.shape[:2]
    if wanted == 1:
        return np.zeros((height, width), int), []
    # A segment reaches no farther than the sides of two from its center, so this much of the other end is enough.
    margin = min(width // 2, int(4 * np.sqrt(height * width / wanted)) + 1) if full_turn else 0
    padded = np.pad(image, ((0, 0), (margin, margin), *((0, 0),) * (image.ndim - 2)), mode="wrap")
    labels = slic(
        np.clip(padded, 0, 1),
        n_segments=max(1, round(wanted * padded.shape[1] / width)),
        compactness=compactness,
        sigma=sigma,
        start_label=0,
        channel_axis=None if image.ndim == 2 else -1,
    )
    own, beyond = labels[:, margin : margin + width].copy(), labels[:, margin + width :]
    across = np.intersect1d(own, beyond)
    over = np.isin(beyond, across)
    own[:, :margin][over] = beyond[over]
    return own, across


def nearest_to_middles(labels, count, across=None):
    """Return the (count, 2) row and column of the pixel of each label that is nearest to the mean of its pixels.

    ``across`` (count,) bool, optional: labels that lie across the edge of a full turn.
    """
    rows, cols = np.nonzero(labels >= 0)
    label = labels[rows, cols]
    width = labels.shape[1]
    if across is not None:
        cols = np.where(across[label] & (cols < width / 2), cols + width, cols)
    number = np.maximum(np.bincount(label, minlength=count), 1)
    middle = [(np.bincount(label, values, count) / number)[label] for values in (rows, cols)]
    squared = (rows - middle[0]) ** 2 + (cols - middle[1]) ** 2
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, label, squared)
    # Of several that are as near, the first one: the last that is written from behind.
    among = np.flatnonzero(squared == nearest[label])[::-1]
    first = np.zeros(count, int)
    first[label[among]] = among
    return np.column_stack([rows[first], cols[first] % width])


def sized(image, longest):
    """Return an image brought to a longest side of pixels, averaged where it gets smaller."""
    import cv2

    scale = longest / max(image.shape[:2])
    size = tuple(max(1, round(side * scale)) for side in image.shape[1::-1])
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
