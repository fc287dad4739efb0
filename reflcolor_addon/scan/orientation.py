"""Which way up a stored grid is, told by its own points, and how to turn a scan that was told wrongly."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

_CLEAR = 0.5
"""Share of agreeing over contradicting pairs of pixels that counts as an answer."""

_SAMPLES = 256
"""Rows and columns that are looked at; more would only repeat what these say."""


class Flips(NamedTuple):
    """What brings a stored grid to row 0 up and columns left to right as seen from the scanner."""

    vertical: bool
    horizontal: bool
    certain: bool


def infer_flips(points, valid):
    """Read the flips that a stored grid needs from the elevation along its rows and the sense of its columns.

    Parameters
    ----------
    points : (H, W, 3) float
        In the scanner's frame, Z up.
    valid : (H, W) bool

    Returns
    -------
    Flips
        Up is where the elevation grows. Left to right is what makes (right x down) point away from the scanner; it
        is measured by the three together, because it holds even where an azimuth means nothing, near the zenith.
        `certain` is False where the points do not show it: rows then stay as stored, unless the grid is mirrored,
        which is mended by turning the rows, the commoner of the two ways in which files differ.
    """
    points, valid = _sampled(points, valid)
    points = np.where(valid[..., None], points, 0.0)
    distance = np.sqrt(np.einsum("ijk,ijk->ij", points, points))
    valid = valid & (distance > 0)
    directions = points / np.where(valid, distance, 1.0)[..., None]

    upright = _upright_score(directions, valid)
    proper = _proper_score(directions, valid)
    mirrored = proper is not None and proper < 0
    if valid.shape[0] == 1:
        return Flips(False, mirrored, proper is not None)
    if upright is None:
        return Flips(mirrored, False, False)
    if proper is None:
        return Flips(upright < 0, False, valid.shape[1] == 1)
    return Flips(upright < 0, mirrored != (upright < 0), True)


def turned(vertical, horizontal):
    """The index that brings an (H, W, ...) array's rows and/or columns into the opposite order."""
    return slice(None, None, -1 if vertical else None), slice(None, None, -1 if horizontal else None)


def flipped(scan, *, vertical=False, horizontal=False):
    """The same scan with its rows and/or its columns in the opposite order; points and pose stay as they are.

    Parameters
    ----------
    scan : Scan
    vertical, horizontal : bool
        Turn the order of the rows; of the columns.

    Returns
    -------
    Scan
    """
    if not (vertical or horizontal):
        return scan
    turn = turned(vertical, horizontal)
    return replace(
        scan,
        points=scan.points[turn],
        reflectance=scan.reflectance[turn],
        valid=scan.valid[turn],
        color=None if scan.color is None else scan.color[turn],
    )


def _sampled(points, valid):
    """Whole blocks of neighbors are not needed: every n-th row and column keeps order and sense."""
    steps = tuple(slice(None, None, max(1, size // _SAMPLES)) for size in valid.shape)
    return np.asarray(points[steps], np.float64), np.asarray(valid[steps], bool)


def _lag(size):
    """How many pixels apart pairs are taken: some, to stand above the noise, but few, to stay on one side of a turn."""
    return max(1, min(8, size // 8))


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
