"""Local features of images, tentative matches between them, and the homographies that they support."""

import numpy as np

from ..models import GridHomography

_RATIO = 0.9
_SIDE = 640
# Photos are mostly held upright: then most matches that turn further are wrong.
_UPRIGHT_DEG = 30
_LEAST_MATCHES = 12
_MOST_POINTS = 2000
VARIANTS = ("gradient", "contrast", "inverted")
"""Which image of the reflectance is tried in turn; the photo's is the same, but never inverted."""


class ScanPoints:
    """The local features of a scan's image, computed once, on first use: they are the same for all photos.

    Parameters
    ----------
    grid_image : (H, W) float32
        The scan's reflectance as an image of 0..255 that covers its whole grid, whatever its pixels' size.
    scan_shape : (rows, columns)
        Of the scan's grid.
    """

    def __init__(self, grid_image, scan_shape):
        self._image, self._scan_shape = sized(grid_image), scan_shape
        self._found = {}

    def homographies(self, photo, step=lambda: None):
        """Yield `GridHomography` candidates from matches between the scan's image and a photo, variant by variant.

        Parameters
        ----------
        photo : PhotoImage
        step : callable
            Called before each variant; may raise to end the work.
        """
        import cv2

        shape, rows_columns = self._image.shape, self._scan_shape
        for variant in VARIANTS:
            step()
            if variant not in self._found:
                self._found[variant] = described(self._image, variant)
            own, (other, other_shape) = self._found[variant], of_photo(photo, variant)
            to_grid = np.diag([rows_columns[1] / shape[1], rows_columns[0] / shape[0], 1.0])
            to_photo = np.diag([photo.width / other_shape[1], photo.height / other_shape[0], 1.0])
            points = matches(own, other)
            if points is None:
                continue
            own_at, other_at, turn = points
            for chosen in (turn <= _UPRIGHT_DEG, np.ones(len(turn), bool)):
                if chosen.sum() < _LEAST_MATCHES:
                    continue
                cv2.setRNGSeed(0)
                found, _ = cv2.findHomography(
                    own_at[chosen], other_at[chosen], cv2.USAC_MAGSAC, 4.0, maxIters=20_000, confidence=0.999
                )
                if found is not None and is_sane(found, shape):
                    matrix = to_photo @ found @ np.linalg.inv(to_grid)
                    yield GridHomography(matrix / matrix[2, 2], rows_columns, photo.width, photo.height)


def of_photo(photo, variant="contrast"):
    """Return a photo's features of a variant (see `described`), and the shape of the image that they are counted in."""
    variant = "contrast" if variant == "inverted" else variant

    def its_own():
        image = sized(photo.gray)
        return described(image, variant), image.shape

    return photo.once(("features", variant), its_own)


def straight(scan_shape, photo):
    """Return the homography of a photo that shows just what the scan shows."""
    matrix = np.diag([photo.width / scan_shape[1], photo.height / scan_shape[0], 1.0])
    return GridHomography(matrix, scan_shape, photo.width, photo.height)


def sized(image, side=_SIDE):
    """Return an image whose longer side has so many pixels."""
    import cv2

    scale = side / max(image.shape)
    size = tuple(max(16, round(length * scale)) for length in image.shape[::-1])
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC)


def _variant(image, name):
    import cv2

    image = np.clip(image, 0, 255)
    if name == "gradient":
        x, y = cv2.Sobel(image, cv2.CV_32F, 1, 0), cv2.Sobel(image, cv2.CV_32F, 0, 1)
        image = np.sqrt(np.sqrt(x * x + y * y))
    elif name in ("contrast", "inverted"):
        image = cv2.createCLAHE(3.0, (8, 8)).apply(image.astype(np.uint8)).astype(np.float32)
    low, high = np.percentile(image, (0.5, 99.5))
    # In double precision with NumPy 1, too.
    image = np.clip((image.astype(np.float64) - low) / max(high - low, 1e-6) * 255, 0, 255).astype(np.uint8)
    return 255 - image if name == "inverted" else image


def described(image, variant, most=_MOST_POINTS):
    """Return the local features of an image.

    Parameters
    ----------
    image : (h, w) float32
        0..255.
    variant : str
        One of `VARIANTS`.
    most : int
        How many are sought.

    Returns
    -------
    tuple or None
        Where they are, (N, 2) float32 (x, y), what they look like, (N, 128) float32, and how they are turned, (N,)
        float64 degrees, in a fixed order; None where there are too few.
    """
    import cv2

    detector = cv2.SIFT_create(most, contrastThreshold=0.02)
    points, descriptors = detector.detectAndCompute(_variant(image, variant), None)
    if descriptors is None or len(points) < _LEAST_MATCHES:
        return None
    at = np.array([point.pt for point in points], np.float32)
    # The detector's threads leave the points in no fixed order.
    order = np.lexsort((*descriptors.T[:4], at[:, 0], at[:, 1]))
    angle = np.array([point.angle for point in points])[order]
    return at[order] + 0.5, descriptors[order], angle


def matches(own, other, ratio=_RATIO):
    """Return which features of two images may show the same.

    Parameters
    ----------
    own, other : tuple or None
        From `described`.
    ratio : float
        At most so many times as different as the second best must the best one be.

    Returns
    -------
    tuple or None
        Where they are in each image, (N, 2) float32, and by how many degrees one is turned against the other, (N,)
        float64, in a fixed order; None where they are too few.
    """
    import cv2

    if own is None or other is None:
        return None
    (own_at, own_described, own_angle), (other_at, other_described, other_angle) = own, other
    pairs = cv2.BFMatcher(cv2.NORM_L2).knnMatch(own_described, other_described, k=2)
    pairs = [pair[0] for pair in pairs if len(pair) == 2 and pair[0].distance < ratio * pair[1].distance]
    if len(pairs) < _LEAST_MATCHES:
        return None
    # MAGSAC weighs the first ones first.
    pairs.sort(key=lambda pair: (pair.distance, pair.queryIdx))
    first, second = [pair.queryIdx for pair in pairs], [pair.trainIdx for pair in pairs]
    turn = np.abs((own_angle[first] - other_angle[second] + 180) % 360 - 180)
    return own_at[first], other_at[second], turn


def is_sane(matrix, shape):
    """Return whether a homography maps a whole image to a convex quadrangle of the same sense, on one side of the
    horizon.

    Parameters
    ----------
    matrix : (3, 3) float64
    shape : (height, width)
        Of the image.
    """
    height, width = shape
    corners = np.array([[0, 0, 1], [width, 0, 1], [width, height, 1], [0, height, 1]], float) @ matrix.T
    if (corners[:, 2] * corners[0, 2] <= 0).any():
        return False
    corners = corners[:, :2] / corners[:, 2:]
    sides = np.roll(corners, -1, axis=0) - corners
    turns = sides[:, 0] * np.roll(sides, -1, axis=0)[:, 1] - sides[:, 1] * np.roll(sides, -1, axis=0)[:, 0]
    area = 0.5 * abs(np.sum(corners[:, 0] * np.roll(corners[:, 1], -1) - corners[:, 1] * np.roll(corners[:, 0], -1)))
    return bool((turns > 0).all() and area > 1e-3 * width * height)
