"""Which photos overlap, that is, show partly the same thing: where one was found, the others belong, too.

Local features that match give a homography from one photo to the other, right for whatever is flat in them. Where
things repeat, as tiles and windows do, features match between photos of different places as well; but then what lies
between them is not bright and dark in the same places.
"""

from dataclasses import dataclass

import numpy as np

from .features import described, is_sane, matches, sized

_SIDE, _MOST_POINTS = 480, 500
_RATIO, _NEAR_PX, _MOST_TRIES = 0.85, 4.0, 5000
# What photos of different rooms have is printed by ``python -m benchmarks.looks``.
_LEAST_POINTS = 12
LEAST_AGREEMENT = 0.7
"""Photos overlap if they agree by so much; see `agreement`."""
_LEAST_PIXELS = 200
# What is finer than this, in pixels, differs between two photos because of noise and sharpness.
_BLUR_PX = 2.0


@dataclass(frozen=True, eq=False)
class Described:
    """A photo that can be compared with others.

    Parameters
    ----------
    image : (h, w) uint8
        Blurred.
    features : tuple or None
        See `features.described`.
    """

    image: np.ndarray
    features: tuple | None

    @classmethod
    def of(cls, photo):
        """Return a `PhotoImage` as one that can be compared."""
        import cv2

        image = sized(photo.gray, _SIDE)
        smooth = cv2.GaussianBlur(np.clip(image, 0, 255), (0, 0), _BLUR_PX)
        return cls(smooth.astype(np.uint8), described(image, "contrast", _MOST_POINTS))


def agreement(one, other):
    """Return how well two photos agree in what they have in common.

    Parameters
    ----------
    one, other : Described

    Returns
    -------
    float
        The correlation of their brightness there, -1..1; 0 where they have nothing in common for certain.
    """
    import cv2

    points = matches(one.features, other.features, _RATIO)
    if points is None:
        return 0.0
    cv2.setRNGSeed(0)
    limits = {"maxIters": _MOST_TRIES, "confidence": 0.999}
    matrix, fit = cv2.findHomography(*points[:2], cv2.USAC_MAGSAC, _NEAR_PX, **limits)
    if matrix is None or fit.sum() < _LEAST_POINTS or not is_sane(matrix, one.image.shape):
        return 0.0
    common = np.zeros(other.image.shape, np.uint8)
    cv2.fillConvexPoly(common, cv2.convexHull(points[1][fit.ravel() > 0]).astype(np.int32), 1)
    moved = cv2.warpPerspective(one.image.astype(np.float32), matrix, common.shape[::-1], borderValue=-1)
    common = (common > 0) & (moved >= 0)
    if common.sum() < _LEAST_PIXELS or np.ptp(moved[common]) == 0 or np.ptp(other.image[common]) == 0:
        return 0.0
    return float(np.corrcoef(moved[common], other.image[common])[0, 1])
