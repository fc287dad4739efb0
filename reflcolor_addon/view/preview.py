"""A small picture of a scan: before, after, where the colors come from, and how sure they are."""

import numpy as np

from ..scan.normalization import normalize
from ..seeds.sources import GUESSED
from .colormaps import UNKNOWN, painted

TILES = ("before", "after", "evidence", "confidence")
"""What the tiles show, from left to right; all have the same size."""
OBSERVED, INFERRED, GUESS = (46, 160, 67), (88, 130, 220), (214, 126, 44)
"""sRGB of pixels that a verified photo saw, that follow from seeds, and that follow from guessed seeds."""
_LONGEST_SIDE = 320


def preview(scan, colorization):
    """Return the tiles side by side, with square pixels.

    Parameters
    ----------
    scan : Scan
    colorization : Colorization

    Returns
    -------
    (h, 4 w, 3) uint8
        sRGB.
    """
    return _side_by_side(
        scan,
        [
            _reflectance(scan),
            colorization.rgb,
            evidence(scan, colorization),
            painted(np.where(scan.valid, colorization.confidence, np.nan).ravel(), "viridis", (0.0, 1.0)),
        ],
    )


def uncolored_preview(scan):
    """Return the first of these tiles, (h, w, 3) uint8, of a scan without colors."""
    return _side_by_side(scan, [_reflectance(scan)])


def _reflectance(scan):
    gray = np.rint(normalize(scan.reflectance, scan.valid)[0]).astype(np.uint8)
    return np.repeat(np.where(scan.valid, gray, 0)[..., None], 3, axis=-1)


def _side_by_side(scan, tiles):
    import cv2

    height, width = scan.shape[0], scan.shape[1] * scan.pixel_aspect
    scale = min(1.0, _LONGEST_SIDE / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    tiles = [cv2.resize(tile.reshape(*scan.shape, 3), size, interpolation=cv2.INTER_AREA) for tile in tiles]
    return np.hstack(tiles)


def evidence(scan, colorization):
    """Return (H, W, 3) uint8: every pixel in the color of where its own comes from; gray where it has none."""
    nearest, seeds = colorization.nearest_seed, colorization.seeds
    guessed = np.array([reason in GUESSED for reason in seeds.reason] + [False])
    picture = np.full((*scan.shape, 3), UNKNOWN, np.uint8)
    picture[nearest >= 0] = INFERRED
    picture[(nearest >= 0) & guessed[nearest]] = GUESS
    picture[colorization.observed >= 0.5] = OBSERVED
    picture[~scan.valid] = 0
    return picture
