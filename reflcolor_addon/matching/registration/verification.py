"""A test that a wrong model fails: do the tiles of the scan, each sought by itself, lie where the model puts them?

Under a wrong model a tile's best place is anywhere in its window, so that few lie in the middle by chance. The share of
tiles in the middle, in deviations of what chance gives, is the evidence. But one long edge, a skyline or an eave, puts
all tiles along it in place at once: so the tiles that have but one best place must say the same by themselves. The
thresholds are set over all unrelated pairs of real scans and of simulated ones (``python -m benchmarks.matching
unrelated``); fitting the model to the same tiles is in that, too.
"""

from dataclasses import dataclass, replace

import numpy as np

from .tiles import Sighting, Tiles, surfaces

RADIUS = 8
"""Half the window that a tile is sought in, in pixels."""

TILE = 40
_SIZES = (28, TILE, 56)
_NEAR = 1.5
_CHANCE = 0.06
# What strength is needed where the photo was taken from the scanner's place, and where from anywhere: the more freedom
# a model has, the more often a wrong one fits by chance.
_NEEDED_AT_SCANNER, _NEEDED_ANYWHERE = 3.2, 14.0
_ANYWHERE_SHARE = 0.2
# A tile is distinct if nothing farther than this from its best place is nearly as good, in deviations; what strength
# they need, as a share of what all tiles do.
_APART, _DISTINCT = 3.0, 0.3
_NEEDED_OF_DISTINCT = 0.7
_ACCEPTED_MEAN = 0.85
# Tiles half overlap: four in place tell what one point does, and a camera that may be anywhere goes through any four.
_TILES_AT_SCANNER, _TILES_ANYWHERE = 10, 30
# The tiles in place must spread over the scan as far as a third of how all tiles do.
_ACCEPTED_SPREAD = 0.33


@dataclass(frozen=True)
class Evidence:
    """What speaks for a model.

    deviations : float
        How far the number of tiles in place exceeds chance, in standard deviations.
    in_place, tiles : int
    mean : float
        Mean score of all tiles where the model puts them, in deviations of the tiles' own surfaces.
    spread : float
        How far the tiles in place spread, as a share of how far all tiles do, in the weaker direction.
    distinct : float
        The `strength` of those tiles that have but one best place.
    needed : float
        The `strength` that is needed for a model of this freedom.
    needed_tiles : float
        How many tiles must be in place.
    """

    deviations: float
    in_place: int
    tiles: int
    mean: float
    spread: float
    distinct: float
    needed: float = _NEEDED_ANYWHERE
    needed_tiles: float = _TILES_ANYWHERE

    @property
    def accepted(self):
        """Whether the model is right."""
        return self.share >= 1

    @property
    def share(self):
        """How much there is of what is needed, of what there is least of: strength, mean, tiles in place, spread."""
        enough = self.mean / _ACCEPTED_MEAN, self.in_place / self.needed_tiles, self.spread / _ACCEPTED_SPREAD
        return max(min(self.rank, *enough), 0.0)

    @property
    def strength(self):
        """Deviations times mean score: right models have both."""
        return max(self.deviations, 0.0) * max(self.mean, 0.0)

    @property
    def rank(self):
        """One number to compare models by: the weaker of both strengths, as a share of what is needed."""
        return min(self.strength, self.distinct / _NEEDED_OF_DISTINCT) / self.needed

    def __str__(self):
        if self.tiles == 0:
            return "it shows nothing of the scan that could be found"
        return f"{self.in_place} of {self.tiles} parts of the scan agree with it"


NO_EVIDENCE = Evidence(0.0, 0, 0, 0.0, 0.0, 0.0)


def evidence(scan_image, photo, model):
    """Return the `Evidence` for a model on a `ScanImage`, from tiles of three sizes.

    Chance is not the same for tiles of different sizes: what is right stands out in all of them.
    """
    sighting = Sighting.of(scan_image, photo, model)
    if sighting is None:
        return NO_EVIDENCE
    found = [surfaces(scan_image, Tiles.of(scan_image, size), photo, model, RADIUS, sighting) for size in _SIZES]
    if any(one is None for one in found):
        return NO_EVIDENCE
    judgements = [judged(one) for one in found]
    middle = judgements[_SIZES.index(TILE)]
    return Evidence(
        float(np.mean([one.deviations for one in judgements])),
        middle.in_place,
        middle.tiles,
        float(np.mean([one.mean for one in judgements])),
        middle.spread,
        float(np.mean([one.distinct for one in judgements])),
        *_needed(scan_image, model),
    )


def known_before(proof, scan_image):
    """Return `Evidence` that need be but what a model without any freedom needs: nothing was searched for it."""
    return replace(proof, needed=_least(scan_image), needed_tiles=_TILES_AT_SCANNER)


def _least(scan_image):
    # Where the image is finer than the grid its pixels are not independent of each other, and chance does more.
    return _NEEDED_AT_SCANNER * scan_image.pixels_per_measurement


def _needed(scan_image, model):
    """The strength and the number of tiles that are needed for a model."""
    if model.kind == "homography":
        return _least(scan_image), _TILES_AT_SCANNER
    share = np.linalg.norm(model.center) / np.median(scan_image.range[scan_image.valid])
    freedom = [0, _ANYWHERE_SHARE]
    far = _NEEDED_ANYWHERE * scan_image.pixels_per_measurement
    return (
        float(np.interp(share, freedom, [_least(scan_image), far])),
        float(np.interp(share, freedom, [_TILES_AT_SCANNER, _TILES_ANYWHERE])),
    )


def judged(found):
    """Return the `Evidence` in `Surfaces` of radius `RADIUS`."""
    radius = found.radius
    count = len(found.scores)
    best = found.scores.reshape(count, -1).argmax(axis=1)
    row, col = np.divmod(best, 2 * radius + 1)
    near = np.hypot(row - radius, col - radius) <= _NEAR
    middle = found.scores[:, radius, radius]
    spread = 0.0
    if near.sum() >= 3:
        axes = np.linalg.svd(found.middles - found.middles.mean(axis=0), full_matrices=False)[2]
        spread = float(min((found.middles[near] @ axes.T).std(axis=0) / ((found.middles @ axes.T).std(axis=0) + 1e-9)))
    one_peak = _one_peak(found.scores, row, col)
    distinct = (
        max(_deviations(near[one_peak]), 0.0) * max(float(middle[one_peak].mean()), 0.0) if one_peak.any() else 0.0
    )
    return Evidence(_deviations(near), int(near.sum()), count, float(middle.mean()), spread, distinct)


def _deviations(near):
    """How far the number of tiles in place exceeds chance, in standard deviations."""
    return float((near.sum() - _CHANCE * len(near)) / np.sqrt(_CHANCE * (1 - _CHANCE) * len(near)))


def _one_peak(scores, row, col):
    """(N,) bool: surfaces where nothing apart from the highest place, at (row, col), is nearly as high."""
    y, x = np.ogrid[: scores.shape[1], : scores.shape[2]]
    apart = np.hypot(y - row[:, None, None], x - col[:, None, None]) > _APART
    second = np.where(apart, scores, -np.inf).max(axis=(1, 2))
    return scores.max(axis=(1, 2)) - second >= _DISTINCT
