"""Seeds in the colors that came with a scan."""

import numpy as np

from ..errors import SeedsError
from .seeds import Seeds
from .sources import SCAN

# Two numbers whose multiples, but for whole numbers, are spread as evenly as can be over a square: the powers of the
# inverse of the real root of x^3 = x + 1 (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
_SPREAD = 1 / 1.32471795724474602596 ** np.array([1, 2])

# More are asked for by mistake.
MOST_SEEDS = 100_000


def seeds_from_color(scan, count):
    """Return seeds that are spread evenly over a scan, in the colors that came with it.

    A seed has the median color of the 3 x 3 pixels around it where all of them have one, so that a single odd pixel
    does not matter. Black is what scanners write where they saw no color: no seed is placed there.

    Parameters
    ----------
    scan : Scan
    count : int
        How many; fewer where fewer pixels have a color.

    Returns
    -------
    Seeds
        With the source "scan".

    Raises
    ------
    SeedsError
        If the scan came without colors.
    """
    import cv2

    known = scan.valid & scan.color.any(axis=-1) if scan.color is not None else np.zeros(scan.shape, bool)
    if not known.any():
        raise SeedsError("{scan}: it came without colors; give seeds another way", scan=scan.name)
    rows, cols = _spread(known, count)
    surrounded = cv2.erode(known.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    median = cv2.medianBlur(np.ascontiguousarray(scan.color), 3)
    rgb = np.where(surrounded[..., None], median, scan.color)[rows, cols]
    return Seeds(rows=rows, cols=cols, rgb=rgb, reason=(SCAN,) * len(rows))


def _spread(known, count):
    """(S,) rows and columns of so many pixels, in reading order; of all where there are no more."""
    height, width = known.shape
    total = np.count_nonzero(known)
    if count >= total:
        return np.nonzero(known)
    chosen, tried = np.zeros(0, np.int64), 0
    while len(chosen) < count:
        # The more of the grid is known, the fewer have to be tried.
        more = np.arange(tried, tried + 2 * count * (known.size // total + 1)) + 1
        tried += len(more)
        places = (0.5 + more[:, None] * _SPREAD) % 1
        pixels = (places[:, 0] * height).astype(np.int64) * width + (places[:, 1] * width).astype(np.int64)
        pixels = np.concatenate([chosen, pixels[known.ravel()[pixels]]])
        _, first = np.unique(pixels, return_index=True)
        chosen = pixels[np.sort(first)][:count]
    return np.divmod(np.sort(chosen), width)
