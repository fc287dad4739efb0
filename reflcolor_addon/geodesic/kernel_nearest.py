"""The nearest seeds of every pixel with their exact distances, found and blended by the native kernel."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..errors import Cancelled, ReflcolorError
from ..native.library import SHORT, Control, address, check, library, pointer_to
from .kernel_blend import PIXELS_AT_ONCE, Mean, check_alpha, checked_values

MAX_NEAREST = 1024
MAX_PARTS = 64

_ROWS_AT_ONCE = 64
# From this number of nearest seeds on it pays to find a few first: they give the distances between seeds, which give
# bounds.
_MANY, _FEW = 16, 4


def nearest(graph, pixels, k, *, threads=1, known=None, control=None):
    """Find the k nearest seeds of every pixel with their exact distances.

    Parameters
    ----------
    graph : Graph
    pixels : (S,) int
        One per seed, ``row * width + column``; several seeds may share a pixel.
    k : int
        1 to 1024; more than there are seeds leaves places empty.
    threads : int, optional
        Each takes the seeds of some rows; their number changes no bit.
    known : Nearest, optional
        The nearest of the same seeds, fewer than k, from an earlier call: they tell how far to search.
    control : Control, optional

    Returns
    -------
    Nearest

    Raises
    ------
    Cancelled, ReflcolorError, MemoryError
    """
    pixels = graph._pixels(pixels)
    if not 1 <= k <= MAX_NEAREST:
        raise ReflcolorError("the number of nearest seeds must be 1 to {most}, found {k}", most=MAX_NEAREST, k=k)
    control = control or Control()
    if known is None and k >= _MANY:
        known = nearest(graph, pixels, _FEW, threads=threads, control=control.uncounted())
    bound, _ = graph._plane()
    lists = (0, None) if known is None else (known._k, address(known._plane))
    arguments = pixels.size, address(pixels), k, *lists, address(bound)
    check(library().rc_nearest_bounds(graph._c, *arguments, pointer_to(control)))
    # By rows, because then the parts have few pixels in common.
    parts = np.array_split(np.argsort(pixels, kind="stable"), min(threads, MAX_PARTS, pixels.size))
    parts = [np.sort(part).astype(np.int32) for part in parts]
    with ThreadPoolExecutor(len(parts), "reflcolor") as pool:
        run = pool.map if len(parts) > 1 else map
        found = _searched(graph, pixels, k, bound, parts, run, control)
        if found is None:
            bound.fill(np.inf)
            found = _searched(graph, pixels, k, bound, parts, run, control)
    return found


def _searched(graph, pixels, k, bound, parts, run, control):
    """The Nearest of the seeds of all parts; None if a bound was too low, as rounding could in principle make it."""
    results = [(Nearest(graph, k), np.zeros(bound.size, np.uint8)) for _ in parts]

    def search(part, result):
        found, listed = result
        own = np.ascontiguousarray(pixels[part])
        arguments = part.size, address(own), address(part), k, address(found._plane), address(listed)
        check(library().rc_nearest_part(graph._c, address(bound), *arguments, pointer_to(control)))

    for _ in run(search, parts, results):
        pass
    labels = np.array([address(found._plane) for found, _ in results], np.uintp)
    listed = np.array([address(listed) for _, listed in results], np.uintp)

    def merge(top):
        rows = top, min(top + _ROWS_AT_ONCE, graph.shape[0])
        arguments = address(bound), k, len(results), address(labels), address(listed)
        return library().rc_nearest_merge(graph._c, *rows, *arguments, pointer_to(control))

    codes = list(run(merge, range(0, graph.shape[0], _ROWS_AT_ONCE)))
    if SHORT in codes:
        return None
    for code in codes:
        check(code)
    return results[0][0]


class Nearest:
    """The k nearest seeds of every pixel, as `nearest` found them; 8 k bytes for each that has a return."""

    def __init__(self, graph, k):
        self._graph, self._k = graph, k
        self._plane, self._grid = graph._plane(2 * k)
        # The kernel leaves memory of pixels without a return untouched, so that it takes no room.
        self._whole = False

    @property
    def distances(self):
        """(H, W, k) float32: ascending; infinite in empty places."""
        self._complete()
        return self._grid[..., : self._k]

    @property
    def seeds(self):
        """(H, W, k) int32: the lower index first among equal distances; -1 in empty places."""
        self._complete()
        return self._grid[..., self._k :].view(np.int32)

    def at(self, pixels):
        """(P, k) distances and seeds of single pixels that have a return."""
        lists = self._grid[np.unravel_index(pixels, self._graph.shape)]
        return lists[:, : self._k], lists[:, self._k :].view(np.int32)

    def blend(self, values, alpha, *, control=None):
        """Take equation 1 over the k nearest seeds of every pixel.

        Parameters
        ----------
        values : (S, C) float
            What is blended, of all seeds: chrominance, or a whole color; C is 1 to 4.
        alpha : float
        control : Control, optional

        Returns
        -------
        mean : Mean
        bound : (H, W) float32
            The most by which the seeds left out could change any channel, if each lies no nearer than the k-th.
        """
        shape, values = self._graph.shape, checked_values(values)
        check_alpha(alpha)
        mean = Mean(
            values=np.empty((values.shape[1], *shape), np.float32),
            weight=np.empty(shape, np.float32),
            nearest_seed=np.empty(shape, np.int32),
            least=np.empty(shape, np.float32),
        )
        bound = np.empty(shape, np.float32)
        outputs = [address(each) for each in (mean.least, mean.nearest_seed, mean.weight, mean.values, bound)]
        rows = max(1, PIXELS_AT_ONCE // shape[1])
        for row in range(0, shape[0], rows):
            if control and control.cancelled:
                raise Cancelled
            arguments = row, min(row + rows, shape[0]), self._k, address(self._plane)
            arguments += *values.shape, address(values), alpha
            check(library().rc_blend_nearest(self._graph._c, *arguments, *outputs))
        return mean, bound

    def _complete(self):
        if not self._whole:
            height, width = self._graph.shape
            y = self._graph._y[: (height + 2) * (width + 2)].reshape(height + 2, width + 2)[1:-1, 1:-1]
            outside = np.isnan(y)
            self._grid[outside, : self._k] = np.inf
            self._grid.view(np.int32)[outside, self._k :] = -1
            self._whole = True
