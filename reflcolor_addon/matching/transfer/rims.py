"""Colors of other things, where a photo seemed to show the scan's surface.

Beside an outline a camera that is slightly off shows another thing, a ghost of it on this one; and what the scanner
never saw may stand in the way. What a photo shows at such places is kept where it agrees with what it shows farther in
on the same surface, or with the color that is inferred there. A small part that is cut off from the rest and mostly
doubtful is left out as a whole: it is what shows through gaps, most often something that the scanner did not see.
"""

import numpy as np

from ...geodesic.graph import PixelGraph
from ...geodesic.spreading import spread
from ...scan.normalization import normalize

# Distance in CIELAB from the color farther in; how many places of that are taken together, and by which power of
# their distances; and what a pixel of the way costs, in levels of the reflectance.
_GHOST = 20.0
_NEAREST, _ALPHA, _STEP = 6, 2.0, 1.0
_LEAST_SHARE = 0.5
# Of all that was seen: parts that are smaller count as small; and which share of one must be sure.
_SMALL, _LEAST_SURE = 0.02, 0.5


def ghosts(rgb, sure, doubtful, scan, reduced, inference):
    """Return (H, W) bool: doubtful pixels of a color that nothing supports.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        sRGB where ``sure`` or ``doubtful``.
    sure, doubtful : (H, W) bool
    scan : Scan
    reduced : Reduced
    inference : Inference
    """
    import cv2
    from skimage.color import rgb2lab

    place = np.nonzero(doubtful)
    if not len(place[0]):
        return doubtful
    own = rgb2lab(rgb[place])
    # NaN compares as False.
    agrees = np.linalg.norm(own - _from_within(rgb, sure, doubtful, scan)[place], axis=-1) <= _GHOST
    share = reduced.share(sure)
    guess = inference.estimate(reduced.lab(rgb, sure, share), share > _LEAST_SHARE, reduced.share(doubtful) > 0)
    agrees |= np.linalg.norm(own - reduced.whole_nearest(guess)[place], axis=-1) <= _GHOST
    found = np.zeros(doubtful.shape, bool)
    found[place] = ~agrees
    # Its own border is a mixture.
    return doubtful & (cv2.dilate(found.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)


def islands(seen, sure):
    """Return (H, W) bool: small parts of what was seen that are cut off from the rest and mostly doubtful.

    Parameters
    ----------
    seen, sure : (H, W) bool
        Where a photo saw anything, and where without a doubt.
    """
    import cv2

    count, label = cv2.connectedComponents(seen.astype(np.uint8), connectivity=8)
    size = np.bincount(label[seen], minlength=count)
    small = (size < _SMALL * size.sum()) & (np.bincount(label[seen & sure], minlength=count) < _LEAST_SURE * size)
    return small[label] & seen


def _from_within(rgb, sure, doubtful, scan):
    """(H, W, 3) float32 CIELAB that goes along paths from sure pixels into doubtful ones; NaN where none leads."""
    import cv2
    from skimage.color import rgb2lab

    border = sure & (cv2.dilate(doubtful.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    pixels = np.flatnonzero(border)
    if not len(pixels):
        return np.full(rgb.shape, np.nan, np.float32)
    graph = PixelGraph(
        luminance=normalize(scan.reflectance, scan.valid)[0],
        range_image=normalize(scan.range, scan.valid)[0],
        valid=border | doubtful,
        neighbors=4,
        wrap=scan.full_turn,
        step_cost=_STEP,
    )
    inner, least = spread(graph, pixels, rgb2lab(rgb.reshape(-1, 3)[pixels]), count=_NEAREST, alpha=_ALPHA)
    return np.where(np.isfinite(least)[..., None], inner, np.nan)
