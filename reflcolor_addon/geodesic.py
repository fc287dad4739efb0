"""Geodesic distances over the pixel graph (eq. 5)."""

import numpy as np

ENGINE = "scipy.sparse.csgraph.dijkstra"
"""What computes the distances; for reports."""


def distance_fields(graph, rows, cols):
    """Yield the (H, W) float64 distance of every pixel to each seed in turn; infinite where no path leads.

    Parameters
    ----------
    graph : PixelGraph
    rows, cols : (S,) int
        The seeds' pixels.
    """
    from scipy.sparse.csgraph import dijkstra

    for source in np.ravel_multi_index((rows, cols), graph.shape):
        distance = dijkstra(graph.matrix, directed=True, indices=int(source)).reshape(graph.shape)
        # Without any edge, scipy still calls the source its own neighbor.
        yield np.where(graph.valid, distance, np.inf)


def geodesic_distances(graph, rows, cols):
    """Return the (S, H, W) float64 distances of every pixel to every seed, eq. 5 with the steps of eq. 6.

    Parameters
    ----------
    graph : PixelGraph
    rows, cols : (S,) int
        The seeds' pixels.
    """
    return np.stack(list(distance_fields(graph, rows, cols)))
