"""A photo with what its file says about where it was taken."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False, kw_only=True)
class Place:
    """Where a photo was taken, and how: a camera that looks along the third of its axes.

    Parameters
    ----------
    rotation : (3, 3) float64
        Its axes in the world, one a row: to the right, down, ahead.
    center : (3,) float64
        World coordinates, meters.
    focal_px : float
        Focal length in pixels of the photo.
    """

    rotation: np.ndarray
    center: np.ndarray
    focal_px: float

    def seen_from(self, pose):
        """Return (rotation, center) in the frame of a scanner whose pose, scanner to world, is (4, 4)."""
        turn, place = pose[:3, :3], pose[:3, 3]
        inverse = np.linalg.inv(turn)
        return self.rotation @ inverse.T, inverse @ (self.center - place)


@dataclass(frozen=True, eq=False, kw_only=True)
class Photo:
    """A photo to take colors from.

    Parameters
    ----------
    name : str
    rgb : (H, W, 3) uint8
        sRGB.
    place : Place or None
        Where it was taken, as far as that is stated. It is a place to begin at: nothing is taken from it untested.
    """

    name: str
    rgb: np.ndarray
    place: Place | None = None
