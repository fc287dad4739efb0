"""What colorizing a scan gives."""

from dataclasses import dataclass, field

import numpy as np

from ..seeds.seeds import Seeds


@dataclass(frozen=True, eq=False, kw_only=True)
class Colorization:
    """A color for every pixel of a scan, and how far to trust it.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        sRGB; the gray of the reflectance where no seed reaches, black without a return.
    confidence : (H, W) float32
        0 to 1: falling with the geodesic distance to the nearest seed, with the difference between eq. 1 and kriging,
        and with what of the color could not be shown at the luminance there; 0 where no seed reaches.
    nearest_seed : (H, W) int32
        Index of the seed at the least geodesic distance; -1 where none reaches.
    observed : (H, W) float32
        How far each color is one that a photo saw there, 0..1; the rest is inferred.
    photo : (H, W) int16
        Index of the photo that led; -1 where a color is inferred.
    seeds : Seeds
        The seeds as used: those on pixels without a return are moved.
    warnings : tuple of str
        One line each.
    normalization : dict
        ``{"reflectance": (low, high), "range": (low, high)}``: the raw values that became 0 and 255.
    method : dict
        ``engine`` that computed the distances and a ``note`` if it is not the kernel; ``nearest``, the number of
        seeds per pixel (None: all), and then ``bound_levels``: the most, in 8-bit levels, that the seeds left out could
        change, over all pixels (``max``) and over 999 of 1,000 (``p99.9``); where that number was left to the program,
        ``doubled_levels``: how much 95 of 100 pixels change at most when half of it is doubled; with kriging, the
        share that it got in the chrominance (``kriging``) and, if it is spread, in the luminance
        (``kriging_of_luminance``), averaged over all pixels that a seed reaches.
    """

    rgb: np.ndarray
    confidence: np.ndarray
    nearest_seed: np.ndarray
    observed: np.ndarray
    photo: np.ndarray
    seeds: Seeds
    warnings: tuple[str, ...] = ()
    normalization: dict = field(default_factory=dict)
    method: dict = field(default_factory=dict)

    @property
    def values(self):
        """(H, W) arrays of what is known of every color, by the name of the attribute that it is written as."""
        return {
            "confidence": self.confidence,
            "nearest_seed": self.nearest_seed,
            "observed": self.observed,
            "photo": self.photo,
        }
