"""Which other scans of a batch are of the place that a photo was found to show: by what the scan measured there.

Two scans of one place measure the same reflectance, whereas a photo of it is bright where that reflects visible light.
So what a scan sees around there is a better picture for a first look at other scans than the photo is.
"""

from statistics import median_high

import numpy as np

from ...matching.edges import filled
from ...matching.models import Camera, camera_axes
from ...matching.registration.search import Search
from ...matching.registration.sphere_map import drawn
from .two_looks import coarseness

# A picture of a scan is so many times as wide as it is high; its focal length, in widths, makes it show 78 degrees.
_RATIO, _FOCAL = 1.5, 0.617
# What is nearer to the one scanner than to the other looks larger there: focal lengths that it is looked for with.
_FOCALS = (0.8 * _FOCAL, _FOCAL, 1.25 * _FOCAL)
_MOST_PIXELS = 640
# How much narrower it is than one with a pixel for each return, so that nearly every pixel has one.
_FILLED = 0.8
# A scan is a partner if the picture fits it so many times as well as it usually fits a scan, and nearly as well as the
# best. Of 20 pictures of rooms that were scanned twice, 16 name the other scan; all 60 pictures of two archives name 4
# scans of other rooms (``python -m benchmarks.looks 7 8``).
_STANDS_OUT, _NEARLY = 1.5, 0.8


def picture_of(views, rows, cols):
    """Return what a scan measured around some of its pixels, as a camera in the scanner's place would show it.

    Parameters
    ----------
    views : ScanViews
    rows, cols : (N,) int
        Pixels with a return, at least one.

    Returns
    -------
    (h, w, 3) uint8
        Gray: the reflectance, every value as often as any other; filled smoothly where nothing was measured.
    """
    scan = views.closed
    middle = (scan.points[rows, cols] / np.maximum(scan.range[rows, cols], 1e-12)[:, None]).mean(axis=0)
    yaw, pitch = np.arctan2(middle[0], middle[1]), np.arctan2(middle[2], np.hypot(middle[0], middle[1]))
    axes = camera_axes(np.degrees(yaw), np.degrees(pitch), 0.0)
    camera = Camera(axes, np.zeros(3), _FOCAL * _MOST_PIXELS, 0.0, _MOST_PIXELS, round(_MOST_PIXELS / _RATIO))
    rows, cols = np.nonzero(scan.valid)
    xy, depth = camera.project(scan.points[rows, cols])
    with np.errstate(invalid="ignore"):
        inside = (depth > 0) & (xy >= 0).all(axis=1) & (xy < [camera.width, camera.height]).all(axis=1)
    rows, cols, xy = rows[inside], cols[inside], xy[inside]
    width = int(np.clip(_FILLED * np.sqrt(_RATIO * len(rows)), 2, _MOST_PIXELS))
    shape = max(2, round(width / _RATIO)), width
    x, y = np.minimum(xy * width / _MOST_PIXELS, [shape[1] - 1, shape[0] - 1]).astype(int).T
    image, _, seen = drawn(y, x, shape, scan.range[rows, cols], views.ranks[rows, cols])
    return np.repeat(np.uint8(np.clip(filled(image, seen), 0, 255))[..., None], 3, axis=2)


def look(views, picture, step=lambda: None):
    """Return how well a picture of another scan fits a scan, in the best direction from the scanner's place.

    Parameters
    ----------
    views : ScanViews
    picture : PhotoImage
        Of what `picture_of` returned.
    step : callable
        Called now and then; may raise to end the work.

    Returns
    -------
    float
        As `two_looks.first_look`; 0 where nothing can be told.
    """
    if views.untestable is not None or np.ptp(picture.gray) == 0:
        return 0.0
    guesses = Search(views, picture).directions(step, _FOCALS, coarseness(views))
    return max(guesses[0].score, 0.0) if guesses else 0.0


def partners(scores, usual, confirmed=()):
    """Return the items that a picture of another one stands out on.

    Parameters
    ----------
    scores : dict of str to float
        For each item what `look` gave.
    usual : dict of str to float
        For each item the usual score of a photo there: a scan with much detail fits everything better. Of items
        without one, as those that no photo was looked at for, nothing is known.
    confirmed : collection of str
        Items that are known to be of the place, which are left out. The picture fits another scan from the same spot
        best, and scans from beside it less well: these stand out once the first one is left out.

    Returns
    -------
    list of str
        Their names; empty where nothing stands out.
    """
    shares = {
        name: score / usual[name]
        for name, score in scores.items()
        if usual.get(name, 0.0) > 0 and name not in confirmed
    }
    if len(shares) < 2:
        return []
    least = max(_STANDS_OUT * median_high(shares.values()), _NEARLY * max(shares.values()))
    return sorted(name for name, share in shares.items() if share >= least > 0)
