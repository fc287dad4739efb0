"""Outlines of scanned surfaces: smooth ones, between pixels, instead of steps along the grid."""

from functools import cache
from itertools import product

import numpy as np

RIGHT, DOWN, LEFT, UP = range(4)
STEPS = ((0, 1), (1, 0), (0, -1), (-1, 0))
"""Rows down and columns to the right of a pixel's four neighbors: right, below, left, above."""

# Corners of a square of four pixels, counterclockwise as seen from the scanner: rows down, columns to the right, and
# which way the next corner and the one before are.
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
_AHEAD = (DOWN, RIGHT, UP, LEFT)
_BACK = (RIGHT, UP, LEFT, DOWN)
# Pixels of the Gaussian by which a surface's outline is smoothed, and how far it reaches.
_SIGMA, _REACH = 2.0, 4
# The outline runs between a pixel of the surface and the next one, not through either.
_NEAREST, _FARTHEST = 0.05, 0.95
_CHUNK = 1 << 18


def outline_shares(surface, pixels, directions, *, wrap=False):
    """Return where a surface's outline crosses the way from its pixels to neighbors that are not on it.

    The outline is where half of what is around belongs to the surface. Of two surfaces that meet, both have the same.

    Parameters
    ----------
    surface : (H, W) int
        Which surface a pixel is on; negative where on none.
    pixels : (E,) int
        Flat indices of pixels of a surface.
    directions : (E,) int
        Of ``STEPS``.
    wrap : bool
        Whether the left and the right edge are neighbors.

    Returns
    -------
    (E,) float64
        0 at the pixel, 1 at the neighbor.
    """
    width, pad = surface.shape[1], _REACH + 1
    wide = np.pad(surface, ((0, 0), (pad, pad)), mode="wrap" if wrap else "edge")
    wide = np.pad(wide, ((pad, pad), (0, 0)), mode="edge").ravel()
    rows, cols = pixels // width, pixels % width
    stride = width + 2 * pad
    shares = np.empty(len(pixels))
    for first in range(0, len(pixels), _CHUNK):
        part = slice(first, first + _CHUNK)
        center = (rows[part] + pad) * stride + cols[part] + pad
        for direction, (down, right) in enumerate(STEPS):
            chosen = directions[part] == direction
            shares[part][chosen] = _crossing(wide, stride, center[chosen], down, right)
    return shares


def _crossing(wide, stride, center, down, right):
    """Of pixels by their places in the padded grid, in one direction."""
    here, there, whole = np.zeros(len(center)), np.zeros(len(center)), 0.0
    own = wide[center]
    for row, col in product(range(-_REACH, _REACH + 1), repeat=2):
        weight = np.exp(-(row**2 + col**2) / (2 * _SIGMA**2))
        here += weight * (wide[center + row * stride + col] == own)
        there += weight * (wide[center + (row + down) * stride + col + right] == own)
        whole += weight
    here, there = here / whole - 0.5, there / whole - 0.5
    # An object one pixel wide has no such place; it is drawn as wide as a pixel.
    crossing = np.where(here > 0, here / np.maximum(here - there, 1e-9), 0.5)
    return np.clip(np.where(there > 0, 0.5, crossing), _NEAREST, _FARTHEST)


@cache
def square_polygons(ahead):
    """Return the polygons of a square of four pixels, of which some neighbors are joined.

    Parameters
    ----------
    ahead : (there, joined): tuples of 4 bool
        Which corners are on a surface; which are joined with the next corner.

    Returns
    -------
    tuple of tuples of (corner, direction)
        Counterclockwise as seen from the scanner. A direction of -1 is the corner itself, another the point where its
        surface's outline crosses the way to its neighbor.
    """
    there, joined = ahead
    if all(joined):
        return (tuple((corner, -1) for corner in range(4)),)
    polygons = []
    for first in range(4):
        if not there[first] or joined[first - 1]:
            continue
        run = [first]
        while joined[run[-1]]:
            run.append((run[-1] + 1) % 4)
        inner = ((corner, -1) for corner in run)
        polygons.append(((first, _BACK[first]), *inner, (run[-1], _AHEAD[run[-1]])))
    return tuple(polygons)
