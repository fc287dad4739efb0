"""Values of very many pixels, spread to the rest along paths."""

import numpy as np

from . import kernel


def spread(graph, pixels, values, *, count, alpha, control=None):
    """Take eq. 1 over the nearest of many pixels with known values, whose order decides among equal distances.

    Without the kernel it is the nearest pixel alone, for that is quick with any number of them.

    Parameters
    ----------
    graph : PixelGraph
    pixels : (S,) int
        ``row * width + column``, S at least 1.
    values : (S, C) float
    count : int
        How many of the nearest pixels are taken.
    alpha : float
        See eq. 2.
    control : Control, optional
        Can cancel the work.

    Returns
    -------
    mean : (H, W, C) float32
        0 where no path leads.
    least : (H, W) float32
        The distance of the nearest pixel; infinite where no path leads.

    Raises
    ------
    Cancelled
    """
    values = np.asarray(values, np.float32)
    if kernel.available():
        found = kernel.nearest(kernel.Graph.of(graph), pixels, min(count, len(pixels)), control=control)
        mean = np.empty((*graph.shape, values.shape[1]), np.float32)
        for first in range(0, values.shape[1], kernel.MAX_CHANNELS):
            part = slice(first, first + kernel.MAX_CHANNELS)
            blended, _ = found.blend(values[:, part], alpha, control=control)
            mean[..., part] = np.moveaxis(blended.values, 0, -1)
        return mean, blended.least
    from scipy.sparse.csgraph import dijkstra

    least, _, source = dijkstra(graph.matrix, indices=np.asarray(pixels), min_only=True, return_predecessors=True)
    reached = source >= 0
    mean = np.zeros((graph.valid.size, values.shape[1]), np.float32)
    by_pixel = np.zeros(graph.valid.size, np.int64)
    by_pixel[pixels] = np.arange(len(pixels))
    mean[reached] = values[by_pixel[source[reached]]]
    return mean.reshape(*graph.shape, -1), least.astype(np.float32).reshape(graph.shape)
