"""Computes geodesic distances: with the native kernel, or with scipy where it does not load.

Both have the same methods.

Distances are float32. A path of n steps lies within (n + 7) 2^-24 of its exact length with the kernel; scipy's are
float64, rounded.
"""

import numpy as np

from ..errors import Cancelled
from . import kernel
from .blending import Blend, blend_nearest


def engine_for(graph):
    """Return the engine for a PixelGraph: the kernel's where it loads."""
    return engine_class()(graph)


def engine_class():
    """Return the engine that will be taken: the kernel's where it loads."""
    return NativeEngine if kernel.available() else ScipyEngine


class NativeEngine:
    """The C kernel."""

    name = f"reflcolor kernel, interface {kernel.ABI_VERSION}"
    note = None
    # Memory in bytes per pixel: always, per thread, and per nearest seed.
    memory = (90, 20, 10)

    def __init__(self, graph):
        self.shape = graph.shape
        self._graph = kernel.Graph.of(graph)

    def control(self):
        """Return what can cancel a running call."""
        return kernel.Control()

    def field(self, pixel, control):
        """Return the (H, W) float32 distances to a pixel (row * W + column)."""
        return kernel.field(self._graph, pixel, control=control)

    def blend(self, alpha, channels=2):
        """Return the empty sums of eq. 1."""
        return kernel.Blend(self.shape, alpha, channels)

    def nearest(self, pixels, k, control, *, threads=1, known=None):
        """Return the k nearest seeds of every pixel, as a `kernel.Nearest`; ``known`` is one of fewer."""
        return kernel.nearest(self._graph, pixels, k, threads=threads, known=known, control=control)

    def extend(self, lists, pixels, first, control, *, threads=1):
        """Add the seeds from index ``first`` on to the lists of those before them, in place."""
        kernel.extend(lists, pixels, first, threads=threads, control=control)


class ScipyEngine:
    """scipy's Dijkstra and NumPy: slower, and everywhere."""

    name = "scipy.sparse.csgraph.dijkstra"
    memory = (480, 40, 24)

    def __init__(self, graph):
        self.shape = graph.shape
        self.note = f"{kernel.reason() or 'the kernel was not asked for'}; colored by scipy, which is slower"
        self._graph = graph

    def control(self):
        """Return what can cancel a running call: between two seeds, for scipy cannot be stopped."""
        return _Flag()

    def field(self, pixel, control):
        """Return the (H, W) float32 distances to a pixel (row * W + column)."""
        from scipy.sparse.csgraph import dijkstra

        control.check()
        distance = dijkstra(self._graph.matrix, directed=True, indices=int(pixel)).reshape(self.shape)
        # Without any edge, scipy still reaches the source.
        return np.where(self._graph.valid, distance, np.inf).astype(np.float32)

    def blend(self, alpha, channels=2):
        """Return the empty sums of eq. 1."""
        return Blend(self.shape, alpha, channels)

    def nearest(self, pixels, k, control, *, threads=1, known=None):
        """Return the k nearest seeds of every pixel, as a `Listed`."""
        lists = Listed(np.full((*self.shape, k), np.inf, np.float32), np.full((*self.shape, k), -1, np.int32))
        self.extend(lists, pixels, 0, control)
        return lists

    def extend(self, lists, pixels, first, control, *, threads=1):
        """Add the seeds from index ``first`` on to the lists of those before them, in place."""
        for seed, pixel in enumerate(pixels[first:], first):
            lists.add(self.field(pixel, control), seed)
            control.done = seed + 1 - first


class Listed:
    """The nearest seeds of every pixel, as arrays; it offers what a `kernel.Nearest` does.

    Parameters
    ----------
    distances : (H, W, k) float32
    seeds : (H, W, k) int32
    """

    def __init__(self, distances, seeds):
        self._distances, self._seeds = distances, seeds

    @property
    def nbytes(self):
        """Bytes that the lists take."""
        return self._distances.nbytes + self._seeds.nbytes

    def add(self, field, seed):
        """Add a seed that lies as far as (H, W) ``field`` tells."""
        distances = np.concatenate([self._distances, field[..., None]], axis=-1)
        seeds = np.concatenate([self._seeds, np.where(np.isinf(field), -1, seed)[..., None]], axis=-1, dtype=np.int32)
        order = np.argsort(distances, axis=-1, kind="stable")[..., :-1]
        self._distances, self._seeds = (np.take_along_axis(array, order, axis=-1) for array in (distances, seeds))

    def at(self, pixels):
        """(P, k) distances and seeds of single pixels."""
        place = np.unravel_index(pixels, self._seeds.shape[:2])
        return self._distances[place], self._seeds[place]

    def blend(self, values, alpha, *, bounded=True, threads=1, control=None):
        """Return the mean over the seeds of every pixel, and its (H, W) bound."""
        # Empty places would change the last bits of sums.
        places = np.s_[..., : len(values)]
        return blend_nearest(self._distances[places], self._seeds[places], values, alpha)


class _Flag:
    """The request to cancel, and the number of seeds done."""

    def __init__(self):
        self.done = 0
        self.cancelled = False

    def cancel(self):
        self.cancelled = True

    def check(self):
        if self.cancelled:
            raise Cancelled
