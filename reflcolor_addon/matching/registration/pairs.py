"""The camera from a few pairs picked by hand: pixels of the scan and points of a photo."""

import numpy as np

from ..models import Camera

LEAST_PAIRS = 4
FOCALS = (0.5, 0.65, 0.85, 1.1, 1.45, 1.9, 2.5)
"""Focal lengths that are tried, in lengths of the photo's longer side."""
_USUAL_FOCAL = 0.85
_FOCAL_DOUBT = 2.0
# A person clicks to about a hundredth of the photo; a pair that is off by more than three of these is a slip.
_CLICK_SHARE = 0.01
_ACCEPTED_SHARE = 0.02
# Four pairs often fit a camera on either side of what was picked. One that looks at the backs of it is the wrong one.
_BACK_DOUBT = 2.0


def camera_from_pairs(points, xy, photo):
    """Estimate a camera of unknown focal length from pairs, one of which may be wrong if there are at least six.

    Parameters
    ----------
    points : (N, 3) float64
        Meters, scanner frame.
    xy : (N, 2) float64
        Pixels from the photo's top left corner.
    photo : PhotoImage

    Returns
    -------
    camera : Camera or None
        None where there are fewer than four pairs, or no camera sees them so.
    error : float
        The root mean square distance in the photo, as a share of its longer side.
    left_out : (K,) int
        Pairs that were left out as wrong.
    """
    count = len(points)
    if count < LEAST_PAIRS:
        return None, np.inf, np.zeros(0, int)
    camera, error = _fitted(points, xy, photo)
    left_out = np.zeros(0, int)
    if count >= 6 and error > _CLICK_SHARE:
        without = [_fitted(np.delete(points, k, 0), np.delete(xy, k, 0), photo) for k in range(count)]
        best = int(np.argmin([error for _, error in without]))
        # With one pair fewer any fit is better; a slip makes it very much better.
        if without[best][1] < 0.35 * error:
            (camera, error), left_out = without[best], np.array([best])
    if camera is None or error > _ACCEPTED_SHARE:
        return None, error, left_out
    return camera, error, left_out


def _fitted(points, xy, photo):
    """The best camera over starts from all focal lengths and both kinds of minimal pose."""
    import cv2

    longer = max(photo.width, photo.height)
    best, best_cost, best_error = None, np.inf, np.inf
    for focal in FOCALS:
        matrix = np.array([[focal * longer, 0, photo.width / 2], [0, focal * longer, photo.height / 2], [0, 0, 1.0]])
        for method in (cv2.SOLVEPNP_SQPNP, cv2.SOLVEPNP_EPNP):
            try:
                _, turns, shifts, _ = cv2.solvePnPGeneric(points, xy, matrix, None, flags=method)
            except cv2.error:
                continue
            for turn, shift in zip(turns, shifts, strict=True):
                rotation = cv2.Rodrigues(turn)[0]
                start = Camera(rotation, -rotation.T @ shift[:, 0], focal * longer, 0.0, photo.width, photo.height)
                camera, cost, error = polished(start, points, xy)
                cost += _BACK_DOUBT * _backs(camera, points)
                if cost < best_cost:
                    best, best_cost, best_error = camera, cost, error
    return best, best_error


def _backs(camera, points):
    """How far a camera looks at the backs of what the scanner saw: 0 from its side, 1 from the opposite one."""
    way = camera.center - points
    lengths = np.linalg.norm(way, axis=1) * np.linalg.norm(points, axis=1)
    return float(np.maximum((way * points).sum(axis=1) / np.maximum(lengths, 1e-12), 0).mean())


def polished(camera, points, xy):
    from scipy.optimize import least_squares

    longer = max(camera.width, camera.height)
    scale = float(np.median(np.linalg.norm(points - camera.center, axis=1)))
    free = list(camera.POSE)

    def moved(values):
        candidate = np.zeros(8)
        candidate[free] = values
        return camera.moved(candidate, scale)

    def residuals(values):
        current = moved(values)
        seen, _ = current.project(points)
        off = np.nan_to_num((seen - xy) / longer, nan=1.0) / _CLICK_SHARE
        # Few pairs hardly tell the focal length: then it stays with what photos usually have.
        return np.append(off.ravel(), _FOCAL_DOUBT * np.log(current.focal_px / longer / _USUAL_FOCAL))

    start = np.zeros(len(free))
    if not np.isfinite(residuals(start)).all():
        return camera, np.inf, np.inf
    solved = least_squares(residuals, start, method="trf", loss="soft_l1", f_scale=3.0, max_nfev=200)
    camera = moved(solved.x)
    seen, _ = camera.project(points)
    if not np.isfinite(seen).all():
        return camera, np.inf, np.inf
    error = float(np.sqrt(((seen - xy) ** 2).sum(axis=1).mean()) / longer)
    return camera, float(solved.cost), error
