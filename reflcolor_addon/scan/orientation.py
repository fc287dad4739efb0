"""Finds which way up a stored grid is from its points, and turns scans by hand where that fails."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

_CLEAR = 0.5
"""Share of agreeing over contradicting pairs of pixels that counts as an answer."""

_SWAPPED = 1.5
"""How much more the height must change along a row than along a column before the two are taken to be swapped."""

_SAMPLES = 256
"""Rows and columns that are sampled; more would not change the answer."""

_CAMERA_TURN_DEG = 45.0
"""A depth camera looks along its Z axis: largest angle between that axis and the middle of the points."""

_CAMERA_EDGE_DEG = 80.0
"""Largest angle between that middle and any point."""

Z_UP = np.array([0.0, 0.0, 1.0])


class Turn(NamedTuple):
    """What brings a stored grid to row 0 up and columns left to right as seen from the scanner, in this order."""

    transposed: bool
    vertical: bool
    horizontal: bool
    certain: bool

    def of(self, grid):
        """Return an (H, W, ...) array turned that way; None for None."""
        if grid is None:
            return None
        return (np.swapaxes(grid, 0, 1) if self.transposed else grid)[turned(self.vertical, self.horizontal)]


AS_STORED = Turn(False, False, False, False)


def infer_turn(points, valid):
    """Read the turn that a stored grid needs from the elevation along its rows and columns and from its handedness.

    Parameters
    ----------
    points : (H, W, 3) float
        In the scanner's frame, Z up.
    valid : (H, W) bool

    Returns
    -------
    Turn
        Up is where the elevation grows; rows and columns are swapped where it grows along a row. Left to right is what
        makes (right x down) point away from the scanner; it is measured by the three together, because it holds even
        where an azimuth means nothing, near the zenith. `certain` is False where the points do not show it: rows then
        stay as stored, unless the grid is mirrored, which is mended by turning the rows, the commoner of the two ways
        in which files differ.
    """
    points, valid = _sampled(points, valid)
    points = np.where(valid[..., None], points, 0.0)
    distance = np.sqrt(np.einsum("ijk,ijk->ij", points, points))
    valid = valid & (distance > 0)
    directions = points / np.where(valid, distance, 1.0)[..., None]

    transposed = _swapped(directions, valid)
    if transposed:
        directions, valid = directions.swapaxes(0, 1), valid.T
    upright = _upright_score(directions, valid)
    proper = _proper_score(directions, valid)
    mirrored = proper is not None and proper < 0
    if valid.shape[0] == 1:
        return Turn(transposed, False, mirrored, proper is not None)
    if upright is None:
        return Turn(transposed, mirrored, False, False)
    if proper is None:
        return Turn(transposed, upright < 0, False, valid.shape[1] == 1)
    return Turn(transposed, upright < 0, mirrored != (upright < 0), True)


def up_of_camera(points, valid):
    """Return which way is up for a camera that looks along its Z axis, or None where the grid is not such a camera's.

    Depth cameras count their axes like images: X to the right, Y down, Z ahead; or, Z behind, Y up.

    Parameters
    ----------
    points : (H, W, 3) float
        In the stored frame, measured from the camera.
    valid : (H, W) bool

    Returns
    -------
    (3,) float64 or None
    """
    points, valid = _sampled(points, valid)
    height, width = valid.shape
    if min(height, width) < 3 or np.count_nonzero(valid) < 9:
        return None
    directions = points[valid]
    directions = directions / np.sqrt(np.einsum("ij,ij->i", directions, directions))[:, None]
    ahead = directions.mean(axis=0)
    length = np.linalg.norm(ahead)
    ahead = ahead / length if length > 0 else Z_UP
    if abs(ahead[2]) < np.cos(np.radians(_CAMERA_TURN_DEG)):
        return None
    radius = np.arccos(np.clip((directions @ ahead).min(), -1, 1))
    if radius > np.radians(_CAMERA_EDGE_DEG):
        return None
    # A turning scanner that looks up sees the zenith at one edge of its grid, a camera sees it in the middle.
    rows, cols = np.nonzero(valid)
    middle = (np.abs(rows - (height - 1) / 2) <= height / 6) & (np.abs(cols - (width - 1) / 2) <= width / 6)
    if not middle.any() or np.arccos(np.clip(directions[middle].mean(axis=0) @ ahead, -1, 1)) > 0.5 * radius:
        return None
    return np.array([0.0, -np.sign(ahead[2]), 0.0])


def frame_with_up(up):
    """Return the (3, 3) rotation by quarter turns that brings a direction as near to +Z as such turns can.

    Parameters
    ----------
    up : (3,) float
    """
    axis = int(np.argmax(np.abs(up)))
    return _FRAMES[axis, bool(up[axis] > 0)]


# By the axis that is up, and whether its positive end is. X stays X, or becomes -X, where it can.
_FRAMES = {
    (2, True): np.eye(3),
    (2, False): np.diag([1.0, -1.0, -1.0]),
    (1, True): np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    (1, False): np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    (0, True): np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]]),
    (0, False): np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
}


def turned(vertical, horizontal):
    """The index that brings an (H, W, ...) array's rows and/or columns into the opposite order."""
    return slice(None, None, -1 if vertical else None), slice(None, None, -1 if horizontal else None)


def flipped(scan, *, vertical=False, horizontal=False, turn_deg=0):
    """The same scan with its grid turned, then its rows and/or its columns in the opposite order.

    Points and pose stay as they are.

    Parameters
    ----------
    scan : Scan
    vertical, horizontal : bool
        Turn the order of the rows; of the columns.
    turn_deg : int
        0, 90, 180 or 270: turn the image clockwise before.

    Returns
    -------
    Scan
    """
    if not (vertical or horizontal or turn_deg):
        return scan
    flips = turned(vertical, horizontal)

    def of(grid):
        return None if grid is None else np.rot90(grid, -turn_deg // 90)[flips]

    return replace(
        scan,
        points=of(scan.points),
        reflectance=of(scan.reflectance),
        valid=of(scan.valid),
        color=of(scan.color),
    )


def thinned(scan, step):
    """The same scan with only those rows and columns whose number is a multiple of a step."""
    if step == 1:
        return scan
    every = slice(None, None, step), slice(None, None, step)
    return replace(
        scan,
        points=scan.points[every],
        reflectance=scan.reflectance[every],
        valid=scan.valid[every],
        color=None if scan.color is None else scan.color[every],
    )


def _sampled(points, valid):
    """Every n-th row and column suffices: it keeps order and direction."""
    steps = tuple(slice(None, None, -(-size // _SAMPLES)) for size in valid.shape)
    return np.asarray(points[steps], np.float64), np.asarray(valid[steps], bool)


def _lag(size):
    """How many pixels apart pairs are: enough to stand above the noise, few enough to stay on one side of a turn."""
    return max(1, min(8, size // 8))


def _swapped(directions, valid):
    """Whether the elevation changes along the rows instead of along the columns."""
    if 1 in valid.shape:
        return False
    along, across = _rise(directions, valid), _rise(directions.swapaxes(0, 1), valid.T)
    return across >= _CLEAR and across > _SWAPPED * along


def _rise(directions, valid):
    """0..1: how much of the way from row to row is up, or down, and how surely."""
    lag = _lag(valid.shape[0])
    both = valid[:-lag] & valid[lag:]
    elevation = np.arcsin(np.clip(directions[..., 2], -1, 1))
    up = (elevation[:-lag] - elevation[lag:])[both]
    way = np.sqrt(((directions[:-lag] - directions[lag:])[both] ** 2).sum(axis=-1))
    moved = way > 0
    sure = _agreement(up)
    return abs(sure) * float(np.median(np.abs(up[moved]) / way[moved])) if sure is not None and moved.any() else 0.0


def _upright_score(directions, valid):
    """-1..1, positive where elevation falls from row to row; None where the points do not agree."""
    lag = _lag(valid.shape[0])
    elevation = np.arcsin(np.clip(directions[..., 2], -1, 1))
    return _agreement((elevation[:-lag] - elevation[lag:])[valid[:-lag] & valid[lag:]])


def _proper_score(directions, valid):
    """-1..1, positive where the grid is not mirrored as seen from the scanner; None where the points do not agree."""
    height, width = valid.shape
    if width == 1:
        return None
    across = _lag(width)
    corner = directions[:, :-across]
    right = directions[:, across:] - corner
    both = valid[:, across:] & valid[:, :-across]
    if height == 1:
        down = np.broadcast_to([0.0, 0.0, -1.0], corner.shape)
    else:
        along = _lag(height)
        down = corner[along:] - corner[:-along]
        both = both[:-along] & both[along:] & valid[along:, :-across]
        corner, right = corner[:-along], right[:-along]
    return _agreement(np.einsum("ijk,ijk->ij", np.cross(right, down), corner)[both])


def _agreement(differences):
    positive, negative = np.count_nonzero(differences > 0), np.count_nonzero(differences < 0)
    if positive + negative == 0:
        return None
    score = (positive - negative) / (positive + negative)
    return score if abs(score) >= _CLEAR else None
