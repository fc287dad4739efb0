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
    parts = _parts(pixels, 0, threads)
    with ThreadPoolExecutor(len(parts), "reflcolor") as pool:
        run = pool.map if len(parts) > 1 else map
        found = _searched(graph, pixels, k, bound, parts, run, control)
        if found is None:
            bound.fill(np.inf)
            found = _searched(graph, pixels, k, bound, parts, run, control)
    return found


def extend(found, pixels, first, *, threads=1, control=None):
    """Add seeds to the lists that `nearest` found: far less work than finding them anew.

    A new seed is sought only as far as it is nearer than the last one of a list. The distances become those that
    `nearest` finds for all seeds at once, to the bit. Where several seeds are equally far, others of them may be listed
    last than there.

    Parameters
    ----------
    found : Nearest
        Is changed; after an error or a cancellation it is of no more use.
    pixels : (S,) int
        One per seed, as for `nearest`: those that are listed, and behind them the new ones.
    first : int
        Index of the first new one.
    threads : int, optional
    control : Control, optional

    Raises
    ------
    Cancelled, ReflcolorError, MemoryError
    """
    graph, k = found._graph, found._k
    pixels = graph._pixels(pixels)
    control = control or Control()
    bound, inner = graph._plane()
    inner[...] = found._grid[:, :, k - 1 : k]
    # What the rim holds of an image that goes all the way round; it is never looked at in others.
    rows = bound[: (graph.shape[0] + 2) * (graph.shape[1] + 2)].reshape(graph.shape[0] + 2, -1)
    rows[:, 0], rows[:, -1] = rows[:, -2], rows[:, 1]
    parts = _parts(pixels, first, min(threads, MAX_PARTS - 1))
    with ThreadPoolExecutor(len(parts), "reflcolor") as pool:
        _searched(graph, pixels, k, bound, parts, pool.map if len(parts) > 1 else map, control, found)


def _parts(pixels, first, count):
    """Indices of the seeds from ``first`` on, in up to ``count`` ascending int32 arrays, one for each thread."""
    # By rows, because then the parts have few pixels in common.
    order = first + np.argsort(pixels[first:], kind="stable")
    return [np.sort(part).astype(np.int32) for part in np.array_split(order, min(count, MAX_PARTS, order.size))]


def _searched(graph, pixels, k, bound, parts, run, control, found=None):
    """The Nearest of the seeds of all parts, and of those of ``found``, which then becomes the result.

    None if a bound was too low, as rounding could in principle make it; those of ``found`` are exact.
    """
    results = [(Nearest(graph, k), np.zeros(bound.size, np.uint8)) for _ in parts]
    # Rows in which there is something to merge.
    rows = range(0, graph.shape[0], _ROWS_AT_ONCE)

    def search(part, result):
        new, listed = result
        own = np.ascontiguousarray(pixels[part])
        arguments = part.size, address(own), address(part), k, address(new._plane), address(listed)
        check(library().rc_nearest_part(graph._c, address(bound), *arguments, pointer_to(control)))

    for _ in run(search, parts, results):
        pass
    if found is not None:
        rows = [top for top in rows if any(_has_new(graph, listed, top) for _, listed in results)]
        results.insert(0, (found, np.ones(bound.size, np.uint8)))
    labels = np.array([address(each._plane) for each, _ in results], np.uintp)
    listed = np.array([address(listed) for _, listed in results], np.uintp)

    def merge(top):
        end = min(top + _ROWS_AT_ONCE, graph.shape[0])
        arguments = address(bound), k, len(results), address(labels), address(listed)
        return library().rc_nearest_merge(graph._c, top, end, *arguments, pointer_to(control))

    codes = list(run(merge, rows))
    if SHORT in codes:
        return None
    for code in codes:
        check(code)
    return results[0][0]


def _has_new(graph, listed, top):
    """Whether a plane of bytes has any set in the rows that are merged at once from ``top`` on."""
    width = graph.shape[1] + 2
    return listed[(top + 1) * width : (top + 1 + _ROWS_AT_ONCE) * width].any()


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

    @property
    def nbytes(self):
        """Bytes that the lists take."""
        return self._plane.nbytes

    def blend(self, values, alpha, *, bounded=True, threads=1, control=None):
        """Take equation 1 over the k nearest seeds of every pixel.

        Parameters
        ----------
        values : (S, C) float
            What is blended, of all seeds: chrominance, or a whole color; C is 1 to 4.
        alpha : float
        bounded : bool, optional
            Whether the bound is wanted, which takes a third of the time.
        threads : int, optional
        control : Control, optional

        Returns
        -------
        mean : Mean
        bound : (H, W) float32, or None
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
        bound = np.empty(shape, np.float32) if bounded else None
        outputs = [address(each) for each in (mean.least, mean.nearest_seed, mean.weight, mean.values)]
        outputs.append(address(bound) if bounded else None)
        rows = max(1, PIXELS_AT_ONCE // shape[1])

        def blend_rows(row):
            if control and control.cancelled:
                raise Cancelled
            arguments = row, min(row + rows, shape[0]), self._k, address(self._plane)
            arguments += *values.shape, address(values), alpha
            check(library().rc_blend_nearest(self._graph._c, *arguments, *outputs))

        with ThreadPoolExecutor(threads, "reflcolor") as pool:
            for _ in (pool.map if threads > 1 else map)(blend_rows, range(0, shape[0], rows)):
                pass
        return mean, bound

    def _complete(self):
        if not self._whole:
            height, width = self._graph.shape
            y = self._graph._y[: (height + 2) * (width + 2)].reshape(height + 2, width + 2)[1:-1, 1:-1]
            outside = np.isnan(y)
            self._grid[outside, : self._k] = np.inf
            self._grid.view(np.int32)[outside, self._k :] = -1
            self._whole = True
