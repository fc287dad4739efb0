"""The parts of a scan that every photo needs, at the scan's full resolution."""

from functools import cached_property

import numpy as np

from ...scan.grid_mesh import face_mask
from ...scan.normals import surface_normals
from ..scan_image import pixel_steps
from .unknown_space import UnknownSpace, outlines


class GridSurface:
    """The surface of a scan.

    Parameters
    ----------
    scan : Scan
    """

    def __init__(self, scan):
        self.scan = scan

    @cached_property
    def normals(self):
        """(H, W, 3) float32: pointing to the scanner's side; zeros where unknown."""
        return surface_normals(self.scan.points, self.scan.valid, wrap=self.scan.full_turn)

    @property
    def pixel_area(self):
        """Solid angle of a pixel, in steradians, as if all were of one size."""
        vertical, horizontal = pixel_steps(self.scan)
        return np.radians(vertical) * np.radians(horizontal)

    @cached_property
    def quads(self):
        """(H - 1, W - 1) bool, or (H - 1, W) where a full turn closes: which neighbors are joined to a surface."""
        return face_mask(self.scan)

    @cached_property
    def edge(self):
        """(H, W) bool: pixels with a return where the surface breaks off.

        Not all four squares around them are joined, or the range jumps.
        """
        height, width = self.scan.shape
        squares = np.zeros((height + 1, width + 1), bool)
        squares[1:-1, 1 : self.quads.shape[1] + 1] = self.quads
        if self.scan.full_turn:
            squares[:, 0] = squares[:, -1]
        else:
            # Beyond the border of the grid nothing is known to break off.
            squares[:, 0], squares[:, -1] = squares[:, 1], squares[:, -2]
        squares[0], squares[-1] = squares[1], squares[-2]
        whole = squares[1:, 1:] & squares[1:, :-1] & squares[:-1, 1:] & squares[:-1, :-1]
        for axis in (0, 1):
            for pixels in outlines(self.scan, axis):
                whole[tuple(pixels)] = False
        return self.scan.valid & ~whole

    @cached_property
    def unknown(self):
        """The `UnknownSpace` behind it."""
        return UnknownSpace(self.scan)
