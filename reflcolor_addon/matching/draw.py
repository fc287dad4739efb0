"""Matches drawn side by side, as in the paper's figures 7a and 10a: scan left, photos right, a line per seed."""

import numpy as np

from ..scan.scan import Scan
from ..seeds.seeds import Seeds
from ..seeds.sources import SOURCES
from .opened_photos import opened_photos
from .photo_image import Photos
from .scan_image import pixel_steps, reflectance_image
from .superpixels import sized

_HEIGHT = 720
_GAP = 8
_MOST_LINES = 250
_PLAIN = (200, 200, 200)


def draw_matches(scan: Scan, photos: Photos, seeds: Seeds) -> np.ndarray:
    """Draw where each seed's color comes from.

    Parameters
    ----------
    scan : Scan
    photos : sequence
        As given to `match_seeds`.
    seeds : Seeds

    Returns
    -------
    (H, W, 3) uint8
        The reflectance on square pixels with the seeds in their colors, the photos beside it, and lines between; green
        for ``pose``, blue for ``homography``, orange for ``appearance``, magenta for ``hand``. If there are very many
        seeds, only some have a line. A seed of confidence 0 has none: its color comes from no single place.

    Examples
    --------
    >>> from reflcolor_addon import Seeds, draw_matches, read_scans
    >>> draw_matches(read_scans("garage.ptx")[0], ["garage.jpg"], Seeds([1], [2], [[200, 80, 40]])).shape
    (720, 2168, 3)
    """
    import cv2

    opened = opened_photos(photos)
    own = _shown(scan)
    panels = [own, *(sized(photo.rgb, max(photo.width, photo.height) * _HEIGHT / photo.height) for photo in opened)]
    canvas = np.full((_HEIGHT, sum(p.shape[1] + _GAP for p in panels) - _GAP, 3), 24, np.uint8)
    lefts, left = [], 0
    for panel in panels:
        height = min(_HEIGHT, panel.shape[0])
        canvas[:height, left : left + panel.shape[1]] = panel[:height]
        lefts.append(left)
        left += panel.shape[1] + _GAP
    places = {photo.name: (lefts[index + 1], photo) for index, photo in enumerate(opened)}
    starts = np.column_stack(
        [(seeds.cols + 0.5) * own.shape[1] / scan.shape[1], (seeds.rows + 0.5) * _HEIGHT / scan.shape[0]]
    ).reshape(-1, 2)
    every = max(1, -(-len(seeds) // _MOST_LINES))
    for index, (start, name, xy) in enumerate(zip(starts, seeds.photos, seeds.photo_xy, strict=True)):
        if name in places and np.isfinite(xy).all() and index % every == 0 and seeds.confidence[index] != 0:
            left, photo = places[name]
            end = (left + xy[0] * _HEIGHT / photo.height, xy[1] * _HEIGHT / photo.height)
            source = SOURCES.get(seeds.reason[index] or "")
            color = _PLAIN if source is None else source.color
            cv2.line(canvas, _whole(start), _whole(end), color, 1, cv2.LINE_AA)
            cv2.circle(canvas, _whole(end), 3, color, -1, cv2.LINE_AA)
    for start, rgb in zip(starts, seeds.rgb.tolist(), strict=True):
        cv2.circle(canvas, _whole(start), 4, (0, 0, 0), -1, cv2.LINE_AA)
        cv2.circle(canvas, _whole(start), 3, rgb, -1, cv2.LINE_AA)
    return canvas


def _shown(scan):
    import cv2

    vertical, horizontal = pixel_steps(scan)
    width = max(1, round(_HEIGHT * scan.shape[1] * horizontal / (scan.shape[0] * vertical)))
    image = reflectance_image(scan, "percentiles")
    gray = cv2.resize(image, (min(width, 8 * _HEIGHT), _HEIGHT), interpolation=cv2.INTER_AREA)
    return np.repeat(np.rint(gray).astype(np.uint8)[..., None], 3, axis=-1)


def _whole(point):
    return round(float(point[0])), round(float(point[1]))
