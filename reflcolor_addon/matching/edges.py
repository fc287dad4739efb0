"""Edge features that look alike in a reflectance image and in a photo, whatever the sign and the gain of an edge.

Infrared reflectance is not the gray of a photo: a red letter on white may vanish, a dark leaf shines. What both have is
where the edges run. A gradient's angle is doubled, so that a change of sign changes nothing; then each neighborhood is
brought to the same contrast.
"""

import numpy as np

_NEIGHBORHOOD, _REDUCED = 16.0, 4
# Contrast below this share of the image's own is left weak instead of being raised to full strength: it is noise.
_NOISE_SHARE = 0.3
_FARTHER_THAN_ALL = 0.5


def gradient(image, sigma=1.0):
    """Return what a gray image (H, W) float32 grows by to the right, and down, smoothed by ``sigma`` pixels before."""
    import cv2

    smooth = cv2.GaussianBlur(image, (0, 0), sigma)
    return cv2.Sobel(smooth, cv2.CV_32F, 1, 0), cv2.Sobel(smooth, cv2.CV_32F, 0, 1)


def gradient_features(right, down, seen, *, spread=1.0):
    """Return the (H, W, 3) float32 edge features of gradients (H, W) float32 each; zero where not ``seen``.

    ``spread`` is the pixels by which they are smoothed.
    """
    import cv2

    return _normalized(cv2.GaussianBlur(_harmonics(right, down), (0, 0), spread), seen)


def scan_features(reflectance, range_m, valid, *, range_weight, sigma=1.0, spread=1.0):
    """Return the features of a scan's edges, of reflectance and of range together.

    Parameters
    ----------
    reflectance : (H, W) float32
    range_m : (H, W) float64
        Meters.
    valid : (H, W) bool
    range_weight : float
        How much a range edge counts beside a reflectance edge.
    sigma, spread : float
        Pixels: smoothing before the gradient, and of the features.

    Returns
    -------
    (H, W, 3) float32
    """
    import cv2

    near = cv2.GaussianBlur(valid.astype(np.float32), (0, 0), 2 * sigma + 1) > 0.05
    inside = cv2.erode(valid.astype(np.uint8), np.ones((3, 3)), borderValue=1).astype(np.float32)
    right, down = gradient(filled(reflectance, valid, reach=4 * sigma), sigma)
    features = gradient_features(right * inside, down * inside, near, spread=spread)
    if range_weight > 0 and valid.any():
        # Without a return is most often sky: farther than anything, so that the skyline is an edge.
        logarithm = np.log(np.maximum(range_m, 1e-6))
        farthest = np.quantile(logarithm[valid].astype(np.float64), 0.98) + _FARTHER_THAN_ALL
        jumps = gradient(np.where(valid, logarithm, farthest).astype(np.float32), sigma)
        features += range_weight * gradient_features(*jumps, near, spread=spread)
    return features


def filled(image, seen, *, reach=None):
    """Return the (H, W) float32 image with what is not seen filled smoothly from around, within ``reach`` pixels."""
    import cv2

    result = np.where(seen, image, 0).astype(np.float32)
    known, weight, sigma = seen.copy(), seen.astype(np.float32), 2.0
    source = result.copy()
    farthest = 4 * max(image.shape) if reach is None else reach
    while known.any() and not known.all() and sigma < farthest:
        # A wide blur of a large image is as good at a coarse one.
        step = max(1, int(sigma / 4))
        size = (max(1, image.shape[1] // step), max(1, image.shape[0] // step))
        blurred = [
            cv2.resize(
                cv2.GaussianBlur(cv2.resize(a, size, interpolation=cv2.INTER_AREA), (0, 0), sigma / step),
                image.shape[::-1],
                interpolation=cv2.INTER_LINEAR,
            )
            for a in (source, weight)
        ]
        reached = ~known & (blurred[1] > 1e-3)
        result[reached] = blurred[0][reached] / blurred[1][reached]
        known |= reached
        sigma *= 2
    return result


def _harmonics(x, y):
    """(H, W, 3): strength, and strength times cosine and sine of twice the gradient's angle."""
    import cv2

    strength = np.sqrt(x * x + y * y) + 1e-9
    return cv2.merge([strength, (x * x - y * y) / strength, 2 * x * y / strength])


def _normalized(features, seen):
    import cv2

    if not seen.any():
        return np.zeros_like(features)
    weight = seen.astype(np.float32)
    strength = features[..., 0] * weight
    squared = strength * strength
    # So wide a blur of a reduced image is as good, for a fraction of the time.
    height, width = seen.shape
    size = (max(1, width // _REDUCED), max(1, height // _REDUCED))
    small = cv2.resize(cv2.merge([weight, strength, squared]), size, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), _NEIGHBORHOOD / _REDUCED)
    share, mean, power = cv2.split(cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR))
    share += 1e-3
    # All in single precision: NumPy 1 would take one number and a constant in double precision, NumPy 2 does not.
    usual = np.float32(squared.sum(dtype=np.float64) / weight.sum(dtype=np.float64))
    noise = np.float32(_NOISE_SHARE) * np.sqrt(usual) + np.float32(1e-9)
    contrast = np.sqrt(power / share) + noise
    gain = (weight / contrast)[..., None]
    # Strength counts only where it differs from its neighborhood; the harmonics average to nothing by themselves.
    features[..., 0] -= mean / share
    features *= gain
    return features
