"""The native kernel, where it is there: geodesic fields, nearest seeds, the blending of equation 1.

``available()`` says whether it loaded, ``reason()`` why it did not. Results are the same to the bit on every platform.

    graph = kernel.Graph(luminance, range_image, valid, beta=1.0, neighbors=8, wrap=False, step_cost=0.0)
    distances = kernel.field(graph, [pixel], control=control)                 # (H, W) float32
    blend = kernel.Blend((height, width), alpha)                              # one field after another
    blend.add(distances, (cb, cr))                                            # or a whole color
    mean = blend.mean()                                                       # a Mean

    found = kernel.nearest(graph, pixels, k, control=control)                 # a Nearest
    mean, bound = found.blend(values, alpha, control=control)

A pixel is ``row * width + column``. A ``Control`` carries the wish to cancel into the kernel and its progress out.

Accuracy: a step costs within 7 units of roundoff (u = 2^-24) of equation 6 on the float32 inputs, and a path of n steps
adds n roundings, so that a distance d lies within (n + 7) u d of the exact one.
"""

import mmap
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from ..errors import Cancelled, ReflcolorError
from ..native.library import (
    ABI_VERSION,
    MAX_CHANNELS,
    SHORT,
    CGraph,
    Control,
    address,
    available,
    check,
    library,
    library_file,
    pointer_to,
    reason,
)

__all__ = [
    "ABI_VERSION",
    "MAX_NEAREST",
    "Blend",
    "Control",
    "Graph",
    "Mean",
    "Nearest",
    "available",
    "field",
    "library_file",
    "nearest",
    "reason",
]

MAX_NEAREST = 1024
MAX_PARTS = 64

# Windows has no other anonymous memory; elsewhere, shared is the default and costs more.
_PRIVATE = {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_PRIVATE") else {}
# Pixels blended between two checks for cancellation: few enough for the sums to stay in the cache.
_PIXELS_AT_ONCE = 1 << 15
_ROWS_AT_ONCE = 64
# From this number of nearest seeds on it pays to find a few first: they give the distances between seeds, which give
# bounds.
_MANY, _FEW = 16, 4


class Graph:
    """The pixels' graph, ready for propagation; 8 bytes per pixel, independent of the arrays it was made from.

    Parameters
    ----------
    luminance, range_image : (H, W) array
        Y and D, normalized to 0..255; used as float32.
    valid : (H, W) bool
        Other pixels are no nodes; their values may be anything.
    beta : float
        Weight of the squared range difference (eq. 6), at least 0.
    neighbors : {4, 8}
    wrap : bool
        Whether the left and the right edge are neighbors.
    step_cost : float
        Added to every step (times sqrt(2) on a diagonal); the paper has none.
    control : Control, optional

    Raises
    ------
    ReflcolorError
        If shapes disagree, or a value at a valid pixel is NaN or infinite, or a parameter is out of its range.
    """

    def __init__(
        self, luminance, range_image, valid, *, beta=1.0, neighbors=8, wrap=False, step_cost=0.0, control=None
    ):
        arrays = [np.asarray(luminance, np.float32), np.asarray(range_image, np.float32)]
        arrays.append(np.asarray(valid, bool))
        self.shape = arrays[2].shape
        if len(self.shape) != 2 or any(array.shape != self.shape for array in arrays):
            shapes = ", ".join(str(array.shape) for array in arrays)
            raise ReflcolorError("luminance, range and valid must be images of one size, found {shapes}", shapes=shapes)
        if neighbors not in (4, 8):
            raise ReflcolorError("neighbors must be 4 or 8, found {neighbors}", neighbors=neighbors)
        for name, value in (("beta", beta), ("step_cost", step_cost)):
            if not 0 <= value <= np.finfo(np.float32).max:
                raise ReflcolorError("{name} must be finite and at least 0, found {value}", name=name, value=value)
        arrays = [_rows(array) for array in arrays]
        height, width = self.shape
        size = library().rc_plane_size(height, width)
        if size < 0:
            raise ReflcolorError(
                "a graph needs 1 to {most} pixels, found an image of {height} x {width}",
                most=2**31 - 1,
                height=height,
                width=width,
            )
        self._y, self._d = np.empty(size, np.float32), np.empty(size, np.float32)
        strided = [part for array in arrays for part in (address(array), array.strides[0] // array.itemsize)]
        planes = address(self._y), address(self._d)
        code = library().rc_graph_fill(height, width, wrap, *strided, *planes, pointer_to(control))
        if code == -3:
            raise ReflcolorError("luminance and range must be finite at every valid pixel, found NaN or infinity")
        check(code)
        self._c = CGraph(height, width, neighbors, wrap, beta, step_cost, address(self._y), address(self._d))

    @classmethod
    def of(cls, graph):
        """Return that of a `PixelGraph`."""
        return cls(
            graph.luminance,
            graph.range_image,
            graph.valid,
            beta=graph.beta,
            neighbors=graph.neighbors,
            wrap=graph.wrap,
            step_cost=graph.step_cost,
        )

    @property
    def nbytes(self):
        """Bytes that the graph holds."""
        return self._y.nbytes + self._d.nbytes

    def _plane(self, depth=1):
        """A plane of the kernel with ``depth`` values per pixel, and its inner (H, W, depth) view, both float32."""
        height, width = self.shape
        # Straight from the system: page-aligned, so that a pixel's values lie in as few cache lines as they can, and in
        # small pages, which a propagation fills faster than the huge ones that NumPy asks for.
        try:
            plane = np.frombuffer(mmap.mmap(-1, self._y.size * depth * 4, **_PRIVATE), np.float32)
        except (OSError, OverflowError) as error:
            raise MemoryError from error
        grid = plane[: (height + 2) * (width + 2) * depth].reshape(height + 2, width + 2, depth)[1:-1, 1:-1]
        return plane, grid

    def _pixels(self, pixels):
        pixels = np.ascontiguousarray(np.atleast_1d(pixels), np.int64)
        if pixels.ndim != 1 or not pixels.size:
            raise ReflcolorError(
                "at least one seed pixel is needed, found an array of shape {shape}", shape=pixels.shape
            )
        height, width = self.shape
        outside = (pixels < 0) | (pixels >= height * width)
        if outside.any():
            found = int(pixels[outside][0])
            raise ReflcolorError(
                "seed pixel {found} lies outside the image of {height} x {width}",
                found=found,
                height=height,
                width=width,
            )
        return pixels


def _rows(array):
    """The array with its values adjacent along rows and rows not overlapping."""
    width = array.shape[1]
    adjacent = width <= 1 or array.strides[1] == array.itemsize
    apart = array.strides[0] % array.itemsize == 0 and array.strides[0] >= width * array.itemsize
    return array if adjacent and apart and array.size else np.ascontiguousarray(array)


def field(graph, pixels, *, start=None, control=None):
    """Geodesic distance of every pixel to the nearest of the given pixels (one for the field of a seed), eq. 5.

    Parameters
    ----------
    graph : Graph
    pixels : (P,) int, or int
        ``row * width + column``.
    start : (P,) float32, optional
        Distance that each of them starts at; 0.
    control : Control, optional

    Returns
    -------
    (H, W) float32
        Infinite where no path leads. A view into a slightly larger array: its rows are not adjacent.

    Raises
    ------
    Cancelled, ReflcolorError, MemoryError
    """
    pixels = graph._pixels(pixels)
    if start is not None:
        start = np.ascontiguousarray(np.broadcast_to(np.asarray(start, np.float32), pixels.shape))
    plane, grid = graph._plane()
    first = None if start is None else address(start)
    check(library().rc_field(graph._c, pixels.size, address(pixels), first, address(plane), pointer_to(control)))
    return grid[..., 0]


class Mean(NamedTuple):
    """Equation 1 for every pixel."""

    values: np.ndarray
    """(C, H, W) float32: the weighted means; 0 where no seed arrives."""
    weight: np.ndarray
    """(H, W) float32: the sum of (r / least r)^-alpha; at least 1, 0 where no seed arrives."""
    nearest_seed: np.ndarray
    """(H, W) int32: -1 where no seed arrives."""
    least: np.ndarray
    """(H, W) float32: distance of the nearest seed; infinite where none arrives."""


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
        shape, values = self._graph.shape, _values(values)
        _check_alpha(alpha)
        mean = Mean(
            values=np.empty((values.shape[1], *shape), np.float32),
            weight=np.empty(shape, np.float32),
            nearest_seed=np.empty(shape, np.int32),
            least=np.empty(shape, np.float32),
        )
        bound = np.empty(shape, np.float32)
        outputs = [address(each) for each in (mean.least, mean.nearest_seed, mean.weight, mean.values, bound)]
        rows = max(1, _PIXELS_AT_ONCE // shape[1])
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


class Blend:
    """The sums of equation 1, taken seed by seed; 12 bytes per pixel, and 4 for each channel.

    Parameters
    ----------
    shape : (H, W)
    alpha : float
        Exponent of eq. 2, at least 0.
    channels : int
        How many values a seed has: 2 of chrominance, or 3 of a whole color; 1 to 4.
    """

    def __init__(self, shape, alpha, channels=2):
        _check_alpha(alpha)
        self._alpha = alpha
        self._mean = Mean(
            values=np.zeros((channels, *shape), np.float32),
            weight=np.zeros(shape, np.float32),
            nearest_seed=np.full(shape, -1, np.int32),
            least=np.full(shape, np.inf, np.float32),
        )
        self._count = 0

    def add(self, distances, values, control=None):
        """Add a seed: its (H, W) float32 distances, infinite where it does not reach, and its value in each channel.

        Its index is the number of seeds added so far. The order of adding decides the last bits of the sums. After
        a cancellation they are of no more use.
        """
        self.add_all([distances], [values], control)

    def add_all(self, fields, values, control=None, run=map):
        """Add several seeds; ``run`` is `map` or a pool's, which lets threads work on parts of the image."""
        first, self._count = self._count, self._count + len(fields)
        fields = [_rows(np.asarray(distances, np.float32)) for distances in fields]
        values = _values(values)
        channels, height, width = self._mean.values.shape
        for distances in fields:
            if distances.shape != (height, width):
                raise ReflcolorError(
                    "distances of shape {shape} do not fit an image {height} x {width}",
                    shape=distances.shape,
                    height=height,
                    width=width,
                )
        if values.shape != (len(fields), channels):
            raise ReflcolorError(
                "expected values of shape {expected}, found {shape}",
                expected=(len(fields), channels),
                shape=values.shape,
            )
        sums = (self._mean.least, self._mean.nearest_seed, self._mean.weight, self._mean.values[0])
        rows = max(1, _PIXELS_AT_ONCE // width)

        def add_to(strip):
            parts = [address(each[strip]) for each in sums]
            for seed, (distances, own) in enumerate(zip(fields, values, strict=True), first):
                part = distances[strip]
                stride = max(part.strides[0] // 4, width)
                arguments = len(part), width, address(part), stride, self._alpha, seed, channels, address(own)
                check(library().rc_blend_add(*arguments, *parts, height * width, pointer_to(control)))

        for _ in run(add_to, [slice(top, min(top + rows, height)) for top in range(0, height, rows)]):
            pass

    def mean(self, keep=True):
        """Return the `Mean` of the seeds so far.

        More can be added afterwards if the sums are kept; else they become the result, which saves their memory.
        """
        mean = Mean(*(sums.copy() for sums in self._mean)) if keep else self._mean
        channels, pixels = len(mean.values), mean.weight.size
        check(library().rc_blend_finish(pixels, address(mean.weight), channels, address(mean.values), pixels))
        return mean


def _check_alpha(alpha):
    if not 0 <= alpha <= np.finfo(np.float32).max:
        raise ReflcolorError("alpha must be finite and at least 0, found {alpha}", alpha=alpha)


def _values(values):
    values = np.ascontiguousarray(values, np.float32)
    if values.ndim != 2 or not 1 <= values.shape[1] <= MAX_CHANNELS:
        raise ReflcolorError(
            "expected values of shape (seeds, 1 to {most}), found {shape}",
            most=MAX_CHANNELS,
            shape=values.shape,
        )
    if not np.isfinite(values).all():
        raise ReflcolorError("the seeds' values must be finite, found NaN or infinity")
    return values
