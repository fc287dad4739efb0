"""The pixel graph that geodesic distances are measured on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

# Half of the neighbors; the other half are the same steps backwards.
_OFFSETS = {4: ((0, 1), (1, 0)), 8: ((0, 1), (1, 0), (1, 1), (1, -1))}


@dataclass(frozen=True, eq=False, kw_only=True)
class PixelGraph:
    """What a path over the scan costs.

    Parameters
    ----------
    luminance : (H, W) float32
        Normalized reflectance Y, 0..255.
    range_image : (H, W) float32
        Normalized range D, 0..255.
    valid : (H, W) bool
        Pixels without a return are no nodes.
    beta : float
        Gain of the range in a step (eq. 6).
    neighbors : {4, 8}
    wrap : bool
        Whether the left and the right edge are neighbors (a full turn).
    step_cost : float
        Added to every step (times sqrt(2) on a diagonal); the paper has none.
    """

    luminance: np.ndarray
    range_image: np.ndarray
    valid: np.ndarray
    beta: float = 1.0
    neighbors: int = 8
    wrap: bool = False
    step_cost: float = 0.0

    @property
    def shape(self):
        """(H, W)."""
        return self.valid.shape

    def edge_cost(self, p, q):
        """Return the cost of the step between neighboring pixels, eq. 6: (beta (D_q - D_p)^2 + 1) |Y_q - Y_p|.

        ``p`` and ``q`` index the images; the arithmetic is float64.
        """
        luminance_step = np.abs(self.luminance[q].astype(np.float64) - self.luminance[p])
        range_step = self.range_image[q].astype(np.float64) - self.range_image[p]
        return (self.beta * range_step**2 + 1) * luminance_step

    def edges(self):
        """Return every edge between valid neighbors once: (E,) int64 from, (E,) int64 to, (E,) float64 cost."""
        height, width = self.shape
        index = np.arange(height * width).reshape(self.shape)
        starts, ends, costs = [], [], []
        for down, right in _OFFSETS[self.neighbors]:
            rows = height - down
            # A grid of one or two columns has no other neighbors around the back than it has already.
            if self.wrap and right and width > 2:
                p, q = index[:rows], np.roll(index[down:], -right, axis=1)
            else:
                p = index[:rows, max(0, -right) : width - max(0, right)]
                q = index[down:, max(0, right) : width - max(0, -right)]
            p, q = p.ravel(), q.ravel()
            both = self.valid.ravel()[p] & self.valid.ravel()[q]
            starts.append(p[both])
            ends.append(q[both])
            costs.append(np.full(starts[-1].size, self.step_cost * np.hypot(down, right)))
        p, q, cost = (np.concatenate(parts) for parts in (starts, ends, costs))
        return p, q, cost + self.edge_cost(np.unravel_index(p, self.shape), np.unravel_index(q, self.shape))

    @cached_property
    def matrix(self):
        """The graph as a scipy CSR matrix over all pixels, row-major; free edges are stored as explicit zeros."""
        from scipy.sparse import csr_array

        p, q, cost = self.edges()
        size = self.valid.size
        both = np.concatenate
        return csr_array((both([cost, cost]), (both([p, q]), both([q, p]))), shape=(size, size))
