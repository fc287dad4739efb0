"""Seeds where no photo could be verified: by appearance and in spatial agreement, else the photo's mean color.

A single most similar superpixel is wrong more often than not, and a scan colored this way looks worse than one in the
photo's mean color. But where neighbors in the scan find neighbors in the photo, in the same arrangement, it is no
chance. So a seed moves from the mean color toward its match only as far as its neighbors agree with it.
"""

import numpy as np

from ...srgb import linear_to_srgb8, srgb8_to_linear

_NEIGHBORS = 12
_AGREEING = 0.06
# What share of neighbors agrees by chance, and from which share on a match is taken in full.
_BY_CHANCE, _CERTAIN = 0.35, 0.85


def mean_color(photos):
    """Return the (3,) uint8 sRGB mean color of photos, all of one weight."""
    return np.rint(np.mean([photo.reshape(-1, 3).mean(axis=0) for photo in photos], axis=0)).astype(np.uint8)


def agreement(scan_xy, matched_xy, photo):
    """Return (S,) in 0..1: how far each match agrees with those of its neighbors.

    Parameters
    ----------
    scan_xy, matched_xy : (S, 2)
        Shares of width and height, in the scan and in the matched photo.
    photo : (S,) int
        Which photo is matched.
    """
    from scipy.spatial import cKDTree

    count = len(scan_xy)
    if count < 4:
        return np.zeros(count)
    _, near = cKDTree(scan_xy).query(scan_xy, min(_NEIGHBORS + 1, count))
    near = near[:, 1:]
    way_in_scan = scan_xy[near] - scan_xy[:, None]
    way_in_photo = matched_xy[near] - matched_xy[:, None]
    same = (photo[near] == photo[:, None]) & (np.linalg.norm(way_in_photo - way_in_scan, axis=2) < _AGREEING)
    return np.clip((same.mean(axis=1) - _BY_CHANCE) / (_CERTAIN - _BY_CHANCE), 0, 1)


def cautious_colors(matches, scan_xy, mean):
    """Return (S, 3) uint8 colors and (S,) confidence for `HogMatches`, as far from the mean as neighbors support."""
    certain = agreement(scan_xy, matches.xy, matches.photo)
    light = srgb8_to_linear(matches.rgb) * certain[:, None] + srgb8_to_linear(mean) * (1 - certain[:, None])
    return linear_to_srgb8(light), certain * matches.similarity
