"""The color that a place of a scan should have, from places whose color is sure: to compare with what photos show."""

from dataclasses import replace
from functools import cached_property

import numpy as np

from ...color.kriging import Kriging, pixel_features
from ...scan.normalization import normalize

_MOST_SEEDS = 600


class Inference:
    """Kriging on the reduced grid of a scan.

    Parameters
    ----------
    scan : Scan
    reduced : Reduced
    """

    def __init__(self, scan, reduced):
        self._scan, self._reduced = scan, reduced

    @cached_property
    def _small(self):
        scan, chosen = self._scan, np.ix_(self._reduced.rows, self._reduced.cols)
        return replace(
            scan, points=scan.points[chosen], reflectance=scan.reflectance[chosen], valid=scan.valid[chosen], color=None
        )

    @cached_property
    def _features(self):
        return pixel_features(self._small, normalize(self._small.reflectance, self._small.valid)[0])

    def estimate(self, lab, known, wanted):
        """Return (h, w, 3) float32 CIELAB, NaN where it is not wanted or cannot be told.

        Parameters
        ----------
        lab : (h, w, 3) float
        known, wanted : (h, w) bool
            Where that is sure, and where it is to be estimated.
        """
        result = np.full(lab.shape, np.nan, np.float32)
        seeds, asked = (np.flatnonzero(mask & self._small.valid) for mask in (known, wanted))
        seeds = seeds[:: -(-len(seeds) // _MOST_SEEDS) or 1]
        if len(seeds) > 1 and len(asked):
            kriging = Kriging(self._features[seeds], lab.reshape(-1, 3)[seeds])
            for chunk in kriging.chunks(len(asked)):
                part = asked[chunk]
                result.reshape(-1, 3)[part] = kriging.estimate(self._features[part])
        return result
