"""Geodesic distances over the pixel graph (eq. 5)."""

import numpy as np

from .engines import engine_for


def geodesic_distances(graph, rows, cols):
    """Return the (S, H, W) float32 distances of every pixel to every seed, eq. 5 with the steps of eq. 6.

    Parameters
    ----------
    graph : PixelGraph
    rows, cols : (S,) int
        The seeds' pixels.

    Returns
    -------
    (S, H, W) float32
        Infinite where no path leads.
    """
    engine = engine_for(graph)
    pixels = np.ravel_multi_index((rows, cols), graph.shape)
    return np.stack([engine.field(int(pixel), engine.control()) for pixel in pixels])
