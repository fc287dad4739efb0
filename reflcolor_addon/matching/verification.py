"""A test that a wrong model fails: do the tiles of the scan, each sought by itself, lie where the model puts them?

Under a wrong model a tile's best place is anywhere in its window, so that few lie in the middle by chance. The share of
tiles in the middle, in deviations of what chance gives, is the evidence. Its threshold is set over all unrelated pairs
of the real scans (``python -m benchmarks.matching unrelated``); fitting the model to the same tiles is in that, too.
"""

from dataclasses import dataclass

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
_ACCEPTED_MEAN = 0.85
_ACCEPTED_TILES = 10
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
    needed : float
        The `strength` that is needed for a model of this freedom.
    """

    deviations: float
    in_place: int
    tiles: int
    mean: float
    spread: float
    needed: float = _NEEDED_ANYWHERE

    @property
    def accepted(self):
        """Whether the model is right."""
        return (
            self.strength >= self.needed
            and self.mean >= _ACCEPTED_MEAN
            and self.in_place >= _ACCEPTED_TILES
            and self.spread >= _ACCEPTED_SPREAD
        )

    @property
    def strength(self):
        """Deviations times mean score: right models have both."""
        return max(self.deviations, 0.0) * max(self.mean, 0.0)

    @property
    def rank(self):
        """One number to compare models by: the strength as a share of what is needed."""
        return self.strength / self.needed

    def __str__(self):
        return f"{self.in_place} of {self.tiles} tiles in place"


NO_EVIDENCE = Evidence(0.0, 0, 0, 0.0, 0.0)


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
        _needed(scan_image, model),
    )


def needed_at_least(scan_image):
    """Return the strength that a model without any freedom needs on a `ScanImage`.

    Where the image is finer than the grid its pixels are not independent of each other, and chance does more.
    """
    return _NEEDED_AT_SCANNER * scan_image.pixels_per_measurement


def _needed(scan_image, model):
    least = needed_at_least(scan_image)
    if model.kind == "homography":
        return least
    share = np.linalg.norm(model.center) / np.median(scan_image.range[scan_image.valid])
    far = _NEEDED_ANYWHERE * scan_image.pixels_per_measurement
    return float(np.interp(share, [0, _ANYWHERE_SHARE], [least, far]))


def judged(found):
    """Return the `Evidence` in `Surfaces` of radius `RADIUS`."""
    radius = found.radius
    count = len(found.scores)
    best = found.scores.reshape(count, -1).argmax(axis=1)
    row, col = np.divmod(best, 2 * radius + 1)
    near = np.hypot(row - radius, col - radius) <= _NEAR
    in_place = int(near.sum())
    deviations = (in_place - _CHANCE * count) / np.sqrt(_CHANCE * (1 - _CHANCE) * count)
    mean = float(found.scores[:, radius, radius].mean())
    spread = 0.0
    if in_place >= 3:
        axes = np.linalg.svd(found.middles - found.middles.mean(axis=0), full_matrices=False)[2]
        spread = float(min((found.middles[near] @ axes.T).std(axis=0) / ((found.middles @ axes.T).std(axis=0) + 1e-9)))
    return Evidence(float(deviations), in_place, count, mean, spread)
