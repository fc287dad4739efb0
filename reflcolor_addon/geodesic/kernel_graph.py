"""The graph of the pixels for the native kernel, and geodesic distances on it."""

import mmap

import numpy as np

from ..errors import ReflcolorError
from ..native.library import CGraph, address, check, library, pointer_to

# Windows has no other anonymous memory; elsewhere, shared is the default and costs more.
_PRIVATE = {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_PRIVATE") else {}


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
        arrays = [adjacent_rows(array) for array in arrays]
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


def adjacent_rows(array):
    """Return the array with its values adjacent along rows, and rows that do not overlap."""
    width = array.shape[1]
    adjacent = width <= 1 or array.strides[1] == array.itemsize
    apart = array.strides[0] % array.itemsize == 0 and array.strides[0] >= width * array.itemsize
    if adjacent and apart and array.size:
        return array
    # To NumPy an image of one row or column is contiguous whatever its strides are, and it would not be copied.
    return array.copy(order="C")
