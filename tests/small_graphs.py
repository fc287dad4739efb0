"""Small random graphs for Hypothesis: every shape from one pixel upward, holes, plateaus, seeds anywhere."""

from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from reflcolor_addon.geodesic import kernel


class SmallGraph(NamedTuple):
    """Images, settings and seed pixels of a small graph."""

    luminance: np.ndarray
    range_image: np.ndarray
    valid: np.ndarray
    settings: dict
    pixels: np.ndarray

    def kernel_graph(self):
        """The kernel's graph."""
        return kernel.Graph(self.luminance, self.range_image, self.valid, **self.settings)

    def fields(self):
        """(S, H, W) float32 distances, one field after another."""
        graph = self.kernel_graph()
        return np.stack([kernel.field(graph, pixel) for pixel in self.pixels])


@st.composite
def small_graphs(draw, largest=7, seeds=6):
    """Graphs of up to ``largest`` by ``largest`` pixels with up to ``seeds`` seeds, some sharing a pixel."""
    height, width = draw(st.integers(1, largest)), draw(st.integers(1, largest))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    # Few levels make plateaus and equal distances, one level a constant image.
    levels = draw(st.sampled_from([1, 2, 5, 256, 2**20]))
    luminance, range_image = (
        (random.integers(0, levels, (height, width)) * (255 / max(levels - 1, 1))).astype(np.float32) for _ in range(2)
    )
    valid = random.random((height, width)) < draw(st.sampled_from([0.5, 0.8, 1.0]))
    valid.flat[random.integers(valid.size)] = True
    settings = {
        "beta": draw(st.sampled_from([0.0, 1e-3, 1.0, 30.0, 1e6])),
        "neighbors": draw(st.sampled_from([4, 8])),
        "wrap": draw(st.booleans()),
        "step_cost": draw(st.sampled_from([0.0, 0.25])),
    }
    pixels = random.choice(np.flatnonzero(valid), draw(st.integers(1, seeds)))
    return SmallGraph(luminance, range_image, valid, settings, pixels)
