"""Where a photo was taken, from others that show partly the same and whose models are known (resection).

What two photos show has places on the scan, by the known model. So many pairs of a place and a point of the photo give
its camera, as pairs do that a person picks. It has to pass the same test as a camera that was searched for: it is no
better than the model it comes from.
"""

import numpy as np

from ...messages import Message
from ..models import Camera, within
from .features import matches, of_photo
from .overlaps import LEAST_AGREEMENT, Described, agreement
from .pairs import FOCALS, polished
from .registration import derived

LEAST_PLACES = 16
"""So many places must agree about a camera."""
_RATIO = 0.85
# How far off a place may be, as a share of the photo's longer side.
_NEAR_SHARE = 0.01
# How often a homography and a pose are sought, how many points must agree about the one, and how often a camera is
# fitted to what agrees about it.
_MOST_TRIES, _MOST_POSES, _LEAST_FLAT, _ROUNDS = 5000, 100, 8, 3
# A point of the photo has the place of the scan's pixels that are seen around it, if these are about as far away.
_AROUND, _SAME_DEPTH, _REACH = 4, 0.05, 2.0
_MOST_PIXELS = 300_000
# With so many other photos it is tried, with those first that agree best.
_MOST_OTHERS = 3


def overlapping(photo, others, step=lambda text: None):
    """Return which of other photos overlap a photo, as their indices, those first that agree best.

    Parameters
    ----------
    photo : PhotoImage
    others : sequence of PhotoImage
    step : callable
        Called with a text before each comparison; may raise to end the work.
    """
    own, agreed = _described(photo), []
    for index, other in enumerate(others):
        step(Message("{photo}: comparing with {other}", photo=photo.name, other=other.name))
        agreed.append((-agreement(_described(other), own), index))
    return [index for disagreed, index in sorted(agreed) if -disagreed >= LEAST_AGREEMENT]


def placed_by(views, photo, others, step=lambda text: None):
    """Return the `Registration` of a photo by what it has in common with others.

    Parameters
    ----------
    views : ScanViews
    photo : PhotoImage
    others : sequence of (PhotoImage, Camera or GridHomography)
        That overlap it, the best first, with their models on the scan.
    step : callable
        Called with a text before each stage; may raise to end the work.

    Returns
    -------
    Registration or None
        Of the first camera that passes the test; None where there is none.
    """
    for other, model in others[:_MOST_OTHERS]:
        step(Message("{photo}: comparing with {other}", photo=photo.name, other=other.name))
        camera, _ = resected(views.scan, photo, other, model)
        if camera is not None:
            step(Message("{photo}: trying its place by {other}", photo=photo.name, other=other.name))
            found = derived(views, photo, camera, other.name)
            if found.accepted:
                return found
    return None


def resected(scan, photo, other, model):
    """Return the camera of a photo from what it has in common with another one.

    Parameters
    ----------
    scan : Scan
    photo : PhotoImage
        Whose camera is sought.
    other : PhotoImage
    model : Camera or GridHomography
        Of ``other``, on the scan.

    Returns
    -------
    camera : Camera or None
        None where they have too little in common.
    count : int
        How many places agree about it.

    References
    ----------
    .. [1] G. Terzakis, M. Lourakis, "A Consistently Fast and Globally Optimal Solution to the Perspective-n-Point
       Problem", ECCV 2020: the pose for each focal length.
    """
    nothing = None, 0
    points = _in_common(photo, other)
    if points is None:
        return nothing
    xy, other_xy, flat = points
    places, known = _places_at(scan, model, other_xy)
    places, xy, flat = places[known], xy[known], flat[known]
    if flat.sum() < _LEAST_FLAT:
        return nothing
    longer, best, count = max(photo.width, photo.height), None, 0
    for focal in FOCALS:
        start = _camera(places[flat], xy[flat], focal * longer, photo)
        for _ in range(_ROUNDS):
            agree = _agree(start, places, xy)
            if agree.sum() < LEAST_PLACES:
                break
            start = polished(start, places[agree], xy[agree])[0]
        agree = _agree(start, places, xy)
        if agree.sum() > count:
            best, count = start, int(agree.sum())
    return (best, count) if count >= LEAST_PLACES else nothing


def _described(photo):
    return photo.once("overlap", lambda: Described.of(photo))


def _places_at(scan, model, xy):
    """Places (N, 3), meters in the scanner frame, of what a photo shows at points (N, 2) of it, and (N,) bool: where
    that is known."""
    from scipy.spatial import cKDTree

    # Of a large scan every n-th row and column is enough: a photo's features are no finer.
    step = max(1, round(np.sqrt(scan.valid.size / _MOST_PIXELS)))
    rows, cols = (step * index for index in np.nonzero(scan.valid[::step, ::step]))
    seen, depth = model.project(model.sites_of(scan, rows, cols))
    inside = (depth > 0) & within(model, seen)
    points, seen = scan.points[rows, cols][inside], seen[inside]
    if len(points) < _AROUND:
        return np.zeros((len(xy), 3)), np.zeros(len(xy), bool)
    tree = cKDTree(seen)
    away, around = tree.query(xy, _AROUND)
    # About how far apart neighboring pixels of the scan are in the photo.
    usual = float(np.median(tree.query(seen[:: max(1, len(seen) // 1000)], 2)[0][:, 1]))
    distance = np.linalg.norm(points[around] - (model.center if model.kind == "pose" else 0.0), axis=2)
    known = (away[:, -1] <= _REACH * usual + 1) & (np.ptp(distance, axis=1) <= _SAME_DEPTH * distance.min(axis=1))
    weight = 1 / np.maximum(away, 1e-3)
    return (points[around] * weight[..., None]).sum(axis=1) / weight.sum(axis=1)[:, None], known


def _in_common(photo, other):
    """Points (N, 2) of a photo and of another one that may show the same, and (N,) bool: which of them agree about a
    homography, as what is flat does; None where there are too few.

    Where things are not flat, or repeat, most points do not agree about it. But those that do are nearly all right.
    """
    import cv2

    (own_features, own_shape), (other_features, other_shape) = of_photo(photo), of_photo(other)
    points = matches(own_features, other_features, _RATIO)
    if points is None:
        return None
    cv2.setRNGSeed(0)
    limits = {"maxIters": _MOST_TRIES, "confidence": 0.999}
    near = _NEAR_SHARE * max(own_shape)
    _, flat = cv2.findHomography(points[1], points[0], cv2.USAC_MAGSAC, near, **limits)
    if flat is None:
        return None
    xy, other_xy = (
        at * [whole.width / shape[1], whole.height / shape[0]]
        for at, whole, shape in zip(points[:2], (photo, other), (own_shape, other_shape), strict=True)
    )
    return xy, other_xy, flat.ravel() > 0


def _camera(places, xy, focal_px, photo):
    """The camera of a focal length that most pairs of a place and a point agree about; None where there is none."""
    import cv2

    matrix = np.array([[focal_px, 0, photo.width / 2], [0, focal_px, photo.height / 2], [0, 0, 1.0]])
    limits = {"iterationsCount": _MOST_POSES, "reprojectionError": _NEAR_SHARE * max(photo.width, photo.height)}
    cv2.setRNGSeed(0)
    try:
        found, turn, shift, _ = cv2.solvePnPRansac(places, xy, matrix, None, flags=cv2.SOLVEPNP_SQPNP, **limits)
    except cv2.error:
        return None  # the places lie nearly in a line
    if not found:
        return None
    turn = cv2.Rodrigues(turn)[0]
    return Camera(turn, -turn.T @ shift[:, 0], focal_px, 0.0, photo.width, photo.height)


def _agree(camera, places, xy):
    """(N,) bool: which pairs agree about a camera."""
    if camera is None:
        return np.zeros(len(xy), bool)
    seen, _ = camera.project(places)
    return np.hypot(*(seen - xy).T) <= _NEAR_SHARE * max(camera.width, camera.height)
