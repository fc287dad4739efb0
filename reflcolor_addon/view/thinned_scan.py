"""Every n-th row and column of a scan, where its light mesh needs no more, and the way back to the scan's own grid."""

import math
from dataclasses import replace

import numpy as np

from ..scan.scan import Scan

MOST_PIXELS = 4_000_000
"""Of a grid whose faces are merged; the memory for that is 1.6 KB a pixel."""

_PIXELS_PER_FACE = 4
"""A light mesh of very many faces is made of more."""


def thinning_step(shape, faces):
    """Return n, where a light mesh of so many faces is made of every n-th row and column of a grid."""
    most = max(MOST_PIXELS, _PIXELS_PER_FACE * faces)
    return math.ceil(math.sqrt(shape[0] * shape[1] / most))


def thinned_scan(scan, step):
    """Return a `Scan` of every ``step``-th row and column."""
    every = np.s_[::step, ::step]
    return Scan(
        name=scan.name,
        points=scan.points[every],
        reflectance=scan.reflectance[every],
        valid=scan.valid[every],
        pose=scan.pose,
    )


def on_whole_scan(light, scan, step, whole):
    """Return the `LightMesh` of a thinned scan as that of the whole one, which has so many triangles."""
    (height, width), (thin_height, thin_width) = scan.shape, light.scan.shape
    rows, cols = (np.arange(0, size, step) for size in (height, width))
    # Columns go on beyond the seam of a full turn, before which less than a whole step may be left.
    cols = np.concatenate([cols, width + cols])
    places = np.stack(
        [
            np.interp(light.places[:, 0], np.arange(thin_height), rows),
            np.interp(light.places[:, 1], np.arange(2 * thin_width), cols),
        ],
        axis=1,
    )
    row, col = np.divmod(light.pixel, thin_width)
    return replace(light, scan=scan, places=places, pixel=row * step * width + col * step, whole=whole)
