"""Smoothing of an image that has holes."""

import numpy as np

# Radius of the Gaussian, in standard deviations.
_REACH = 4.0


def smooth(image, valid, sigma, *, wrap=False):
    """Smooth the valid pixels of an image by a Gaussian that sees only valid pixels.

    Parameters
    ----------
    image : (H, W) float32
    valid : (H, W) bool
    sigma : float
        Standard deviation in pixels; 0 leaves the image as it is.
    wrap : bool
        Whether the left and the right edge are neighbors.

    Returns
    -------
    (H, W) float32
        0 where not valid.
    """
    import cv2

    image = np.where(valid, image, 0).astype(np.float32)
    if sigma == 0:
        return image
    radius = int(np.ceil(_REACH * sigma))
    sides = ((0, 0), (radius, radius))
    sums = []
    for values in (image, valid.astype(np.float32)):
        padded = np.pad(values, sides, mode="wrap") if wrap else np.pad(values, sides)
        size = (2 * radius + 1, 2 * radius + 1)
        blurred = cv2.GaussianBlur(padded, size, sigma, borderType=cv2.BORDER_CONSTANT)
        sums.append(blurred[:, radius : radius + image.shape[1]])
    return np.divide(sums[0], sums[1], out=np.zeros_like(image), where=valid)
