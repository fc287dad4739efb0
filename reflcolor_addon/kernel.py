"""The native kernel, where it is there: geodesic fields, nearest seeds, the blending of equation 1.

The library lives in the package ``reflcolor_kernel`` (one wheel per platform, bundled with the extension) and is called
through ctypes, so that the interpreter is free while it runs and threads of Python run side by side. ``available()``
says whether it loaded, ``reason()`` why it did not. Results are the same to the bit on every platform and for every
number of threads.

    graph = kernel.Graph(luminance, range_image, valid, beta=1.0, neighbors=8, wrap=False, step_cost=0.0)
    distances = kernel.field(graph, [pixel], control=control)                 # (H, W) float32
    blend = kernel.Blend((height, width), alpha)                              # one field after another
    blend.add(distances, (cb, cr))
    mean = blend.mean()                                                       # a Mean
    mean = kernel.blend_all(graph, pixels, colors, alpha, threads=2, control=control)

    distances, seeds = kernel.nearest(graph, pixels, k, control=control)      # (H, W, k) float32 and int32
    mean, bound = kernel.blend_nearest(distances, seeds, colors, alpha, control=control)

A pixel is ``row * width + column``. A ``Control`` carries the wish to cancel into the kernel and its progress out.

Accuracy: a step costs within 7 units of roundoff (u = 2^-24) of equation 6 on the float32 inputs, and a path of n steps
adds n roundings, so that a distance d lies within (n + 7) u d of the exact one.
"""

import ctypes
import functools
import mmap
import threading
from typing import NamedTuple

import numpy as np

from .errors import Cancelled, ReflcolorError

ABI_VERSION = 1
MAX_NEAREST = 1024

_OK, _CANCELLED, _MEMORY = 0, 1, 2
# Windows has no other anonymous memory; elsewhere, shared is the default and costs more.
_PRIVATE = {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_PRIVATE") else {}
# Blended between two looks at the wish to cancel.
_PIXELS_AT_ONCE = 1 << 17
_NO_MEMORY = "the geodesic kernel ran out of memory: use a larger stride or fewer nearest seeds"
_REFUSED = {
    -1: "a null pointer",
    -2: "an image that is empty or too large for 32-bit pixel indices",
    -3: "a value that is negative, not a number, infinite or out of its range",
    -4: "a seed outside the image or on a pixel without a return",
}

_i32, _i64, _f32, _pointer = ctypes.c_int32, ctypes.c_int64, ctypes.c_float, ctypes.c_void_p


class _CGraph(ctypes.Structure):
    _fields_ = (
        ("height", _i64),
        ("width", _i64),
        ("neighbors", _i32),
        ("wrap", _i32),
        ("beta", _f32),
        ("step_cost", _f32),
        ("y", _pointer),
        ("d", _pointer),
    )


class _CControl(ctypes.Structure):
    _fields_ = (("cancel", _pointer), ("progress", _pointer))


_graph_pointer, _control_pointer = ctypes.POINTER(_CGraph), ctypes.POINTER(_CControl)
_FUNCTIONS = {
    "rc_abi_version": (_i32,),
    "rc_plane_size": (_i64, _i64, _i64),
    "rc_graph_fill": (_i32, _i64, _i64, _i32, _pointer, _i64, _pointer, _i64, _pointer, _i64, _pointer, _pointer),
    "rc_field": (_i32, _graph_pointer, _i64, _pointer, _pointer, _pointer, _control_pointer),
    "rc_nearest": (_i32, _graph_pointer, _i64, _pointer, _i32, _pointer, _control_pointer),
    "rc_blend_add": (_i32, _i64, _i64, _pointer, _i64, _f32, _i32, _f32, _f32, *[_pointer] * 5),
    "rc_blend_finish": (_i32, _i64, _pointer, _pointer, _pointer),
    "rc_blend_nearest": (
        *(_i32, _i64, _i64, _i64, _i64, _i32, _pointer, _i64, _pointer, _f32),
        *[_pointer] * 4,
    ),
}


@functools.cache
def _load():
    """(library, None), or (None, why not)."""
    try:
        import reflcolor_kernel

        library = ctypes.CDLL(str(reflcolor_kernel.library_path()))
    except ImportError:
        return None, "no kernel for this platform is installed (package reflcolor_kernel)"
    except OSError as error:
        return None, f"the kernel does not load: {error}"
    try:
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except AttributeError as error:
        return None, f"the kernel is not the one this version needs: {error}"
    version = library.rc_abi_version()
    if version != ABI_VERSION:
        return None, f"the kernel has interface {version}, this version needs {ABI_VERSION}"
    return library, None


def available():
    """Whether the kernel loaded."""
    return _load()[0] is not None


def reason():
    """Why the kernel did not load, one line; None if it did."""
    return _load()[1]


def _library():
    library, why = _load()
    if library is None:
        raise ReflcolorError(why)
    return library


def _check(code):
    if code == _CANCELLED:
        raise Cancelled
    if code == _MEMORY:
        raise MemoryError(_NO_MEMORY)
    if code != _OK:
        raise ReflcolorError(f"the geodesic kernel refused {_REFUSED.get(code, f'its arguments (code {code})')}")


def _address(array):
    return array.ctypes.data


class Control:
    """Cancels a running call from another thread and tells how far it is.

    ``cancel()`` makes every call that was given this object raise `Cancelled`, those running within a millisecond
    or so. ``done`` counts pixels settled (`field`) or seeds finished (`nearest`).
    """

    def __init__(self):
        self._cancel, self._done = np.zeros(1, np.int32), np.zeros(1, np.int64)
        self._c = _CControl(_address(self._cancel), _address(self._done))

    def cancel(self):
        """Stop the calls that use this object."""
        self._cancel[0] = 1

    @property
    def cancelled(self):
        """Whether `cancel` was called."""
        return bool(self._cancel[0])

    @property
    def done(self):
        """Units of work finished since the object was made."""
        return int(self._done[0])


def _control(control):
    return None if control is None else ctypes.byref(control._c)


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

    Raises
    ------
    ReflcolorError
        If shapes disagree, or a value at a valid pixel is NaN or infinite, or a parameter is out of its range.
    """

    def __init__(self, luminance, range_image, valid, *, beta=1.0, neighbors=8, wrap=False, step_cost=0.0):
        library = _library()
        arrays = [np.asarray(luminance, np.float32), np.asarray(range_image, np.float32)]
        arrays.append(np.asarray(valid, bool))
        self.shape = arrays[2].shape
        if len(self.shape) != 2 or any(array.shape != self.shape for array in arrays):
            shapes = ", ".join(str(array.shape) for array in arrays)
            raise ReflcolorError(f"luminance, range and valid must be images of one size, found {shapes}")
        if neighbors not in (4, 8):
            raise ReflcolorError(f"neighbors must be 4 or 8, found {neighbors}")
        for name, value in (("beta", beta), ("step_cost", step_cost)):
            if not 0 <= value <= np.finfo(np.float32).max:
                raise ReflcolorError(f"{name} must be finite and at least 0, found {value}")
        arrays = [_rows(array) for array in arrays]
        height, width = self.shape
        size = library.rc_plane_size(height, width)
        if size < 0:
            raise ReflcolorError(f"a graph needs 1 to {2**31 - 1} pixels, found an image of {height} x {width}")
        self._y, self._d = np.empty(size, np.float32), np.empty(size, np.float32)
        strided = [part for array in arrays for part in (_address(array), array.strides[0] // array.itemsize)]
        code = library.rc_graph_fill(height, width, wrap, *strided, _address(self._y), _address(self._d))
        if code == -3:
            raise ReflcolorError("luminance and range must be finite at every valid pixel, found NaN or infinity")
        _check(code)
        self._c = _CGraph(height, width, neighbors, wrap, beta, step_cost, _address(self._y), _address(self._d))

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
            raise MemoryError(_NO_MEMORY) from error
        grid = plane[: (height + 2) * (width + 2) * depth].reshape(height + 2, width + 2, depth)[1:-1, 1:-1]
        return plane, grid

    def _pixels(self, pixels):
        pixels = np.ascontiguousarray(np.atleast_1d(pixels), np.int64)
        if pixels.ndim != 1 or not pixels.size:
            raise ReflcolorError(f"at least one seed pixel is needed, found an array of shape {pixels.shape}")
        height, width = self.shape
        outside = (pixels < 0) | (pixels >= height * width)
        if outside.any():
            found = int(pixels[outside][0])
            raise ReflcolorError(f"seed pixel {found} lies outside the image of {height} x {width}")
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
    first = None if start is None else _address(start)
    _check(_library().rc_field(graph._c, pixels.size, _address(pixels), first, _address(plane), _control(control)))
    return grid[..., 0]


def nearest(graph, pixels, k, *, control=None):
    """The k nearest seeds of every pixel with their exact distances.

    Parameters
    ----------
    graph : Graph
    pixels : (S,) int
        One per seed, ``row * width + column``; several seeds may share a pixel.
    k : int
        1 to 1024; more than there are seeds leaves places empty.
    control : Control, optional

    Returns
    -------
    distances : (H, W, k) float32
        Ascending; infinite in empty places.
    seeds : (H, W, k) int32
        Indices into ``pixels``, the lower first among equal distances; -1 in empty places.

    Raises
    ------
    Cancelled, ReflcolorError, MemoryError
    """
    pixels = graph._pixels(pixels)
    if not 1 <= k <= MAX_NEAREST:
        raise ReflcolorError(f"the number of nearest seeds must be 1 to {MAX_NEAREST}, found {k}")
    plane, grid = graph._plane(2 * k)
    _check(_library().rc_nearest(graph._c, pixels.size, _address(pixels), k, _address(plane), _control(control)))
    return grid[..., :k], grid[..., k:].view(np.int32)


class Mean(NamedTuple):
    """Equation 1 for every pixel."""

    chroma: np.ndarray
    """(2, H, W) float32: the weighted means; 0 where no seed arrives."""
    weight: np.ndarray
    """(H, W) float32: the sum of (r / least r)^-alpha; at least 1, 0 where no seed arrives."""
    nearest_seed: np.ndarray
    """(H, W) int32: -1 where no seed arrives."""
    least: np.ndarray
    """(H, W) float32: distance of the nearest seed; infinite where none arrives."""


class Blend:
    """The sums of equation 1, taken seed by seed; 20 bytes per pixel.

    Parameters
    ----------
    shape : (H, W)
    alpha : float
        Exponent of eq. 2, at least 0.
    """

    def __init__(self, shape, alpha):
        if not 0 <= alpha <= np.finfo(np.float32).max:
            raise ReflcolorError(f"alpha must be finite and at least 0, found {alpha}")
        self._alpha = alpha
        self._mean = Mean(
            chroma=np.zeros((2, *shape), np.float32),
            weight=np.zeros(shape, np.float32),
            nearest_seed=np.full(shape, -1, np.int32),
            least=np.full(shape, np.inf, np.float32),
        )
        self._count = 0

    def add(self, distances, color, seed=None):
        """Add a seed: its (H, W) float32 distances, infinite where it does not reach, and its two chrominances.

        ``seed`` is its index, by default the number of seeds added so far. The order of adding decides the last
        bits of the sums.
        """
        seed = self._count if seed is None else seed
        self._count += 1
        distances = _rows(np.asarray(distances, np.float32))
        color = [float(value) for value in color]
        mean = self._mean
        if distances.shape != mean.weight.shape:
            raise ReflcolorError(f"distances of shape {distances.shape} do not fit an image {mean.weight.shape}")
        stride = max(distances.strides[0] // 4, distances.shape[1])
        sums = (mean.least, mean.nearest_seed, mean.weight, *mean.chroma)
        _check(
            _library().rc_blend_add(
                *distances.shape, _address(distances), stride, self._alpha, seed, *color, *map(_address, sums)
            )
        )

    def mean(self):
        """Return the `Mean` of the seeds so far; more can be added afterwards."""
        return _means_of(Mean(*(sums.copy() for sums in self._mean)))


def _means_of(sums):
    """Turn sums into means, in place."""
    _check(_library().rc_blend_finish(sums.weight.size, _address(sums.weight), *map(_address, sums.chroma)))
    return sums


def blend_all(graph, pixels, colors, alpha, *, threads=1, control=None, finished=None):
    """Equation 1 over all seeds, exactly; one field per thread is in memory at any time.

    Parameters
    ----------
    graph : Graph
    pixels : (S,) int
    colors : (S, 2) float
        Chrominance of every seed.
    alpha : float
    threads : int
        How many fields are computed at once. The sums are taken in the order of the seeds, whatever the number.
    control : Control, optional
    finished : callable, optional
        Called with the number of seeds blended so far, from any thread.

    Returns
    -------
    Mean

    Raises
    ------
    Cancelled, ReflcolorError, MemoryError
    """
    pixels = graph._pixels(pixels)
    colors = _colors(colors, pixels.size)
    control = control or Control()
    blend = Blend(graph.shape, alpha)
    turn, failures = threading.Condition(), []
    state = {"next": 0, "blended": 0}

    def work():
        try:
            while True:
                with turn:
                    seed = state["next"]
                    if seed == pixels.size or failures:
                        return
                    state["next"] = seed + 1
                distances = field(graph, pixels[seed], control=control)
                with turn:
                    turn.wait_for(lambda seed=seed: state["blended"] == seed or failures)
                if failures:
                    return
                # Only the thread whose turn it is writes to the sums.
                blend.add(distances, colors[seed], seed)
                del distances
                with turn:
                    state["blended"] = seed + 1
                    turn.notify_all()
                if finished:
                    finished(seed + 1)
        except BaseException as error:
            with turn:
                failures.append(error)
                turn.notify_all()
            control.cancel()

    workers = [threading.Thread(target=work, daemon=True) for _ in range(min(max(threads, 1), pixels.size) - 1)]
    for worker in workers:
        worker.start()
    work()
    for worker in workers:
        worker.join()
    if failures:
        raise failures[0]
    return _means_of(blend._mean)


def blend_nearest(distances, seeds, colors, alpha, *, control=None):
    """Equation 1 over the k nearest seeds of every pixel.

    Parameters
    ----------
    distances, seeds : (H, W, k)
        As `nearest` returned them.
    colors : (S, 2) float
        Chrominance of all seeds.
    alpha : float
    control : Control, optional

    Returns
    -------
    mean : Mean
    bound : (H, W) float32
        The most by which the seeds left out could change either chrominance: each lies at least as far as the k-th,
        and no color lies outside the range of the seeds' colors.
    """
    height, width, k = distances.shape
    colors = _colors(colors)
    labels = _labels(distances, seeds)
    if not 0 <= alpha <= np.finfo(np.float32).max:
        raise ReflcolorError(f"alpha must be finite and at least 0, found {alpha}")
    chroma = np.empty((2, height, width), np.float32)
    weight, bound = np.empty((height, width), np.float32), np.empty((height, width), np.float32)
    outputs = [_address(output) for output in (weight, *chroma, bound)]
    rows = max(1, _PIXELS_AT_ONCE // width)
    for row in range(0, height, rows):
        if control and control.cancelled:
            raise Cancelled
        end = min(row + rows, height)
        arguments = (height, width, row, end, k, labels, len(colors), _address(colors), alpha)
        _check(_library().rc_blend_nearest(*arguments, *outputs))
    return Mean(chroma, weight, seeds[..., 0].copy(), distances[..., 0].copy()), bound


def _colors(colors, count=None):
    colors = np.ascontiguousarray(colors, np.float32)
    if colors.ndim != 2 or colors.shape[1] != 2 or (count is not None and len(colors) != count):
        expected = "(seeds, 2)" if count is None else f"({count}, 2)"
        raise ReflcolorError(f"expected chrominances of shape {expected}, found {colors.shape}")
    if not np.isfinite(colors).all():
        raise ReflcolorError("chrominances must be finite, found NaN or infinity")
    return colors


def _labels(distances, seeds):
    """Address of the plane that the views `nearest` returned lie in."""
    _, width, k = distances.shape
    pixel = 2 * k * 4
    strides = ((width + 2) * pixel, pixel, 4)
    if (
        (distances.dtype, seeds.dtype) != (np.float32, np.int32)
        or not distances.shape == seeds.shape
        or not distances.strides == seeds.strides == strides
        or _address(seeds) != _address(distances) + 4 * k
    ):
        raise ReflcolorError("distances and seeds must be the arrays that `nearest` returned")
    return _address(distances) - strides[0] - strides[1]
