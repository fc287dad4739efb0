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

from ..native.library import ABI_VERSION, Control, available, library_file, reason
from .kernel_blend import MAX_CHANNELS, Blend, Mean
from .kernel_graph import Graph, field
from .kernel_nearest import MAX_NEAREST, Nearest, extend, nearest

__all__ = [
    "ABI_VERSION",
    "MAX_CHANNELS",
    "MAX_NEAREST",
    "Blend",
    "Control",
    "Graph",
    "Mean",
    "Nearest",
    "available",
    "extend",
    "field",
    "library_file",
    "nearest",
    "reason",
]
