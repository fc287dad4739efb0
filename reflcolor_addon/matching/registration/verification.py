"""A test that a wrong model fails: are the scan's tiles, each searched for by itself, found where the model puts them?

Under a wrong model a tile's best place is anywhere in its window, so few lie in the middle, by chance. The share of
tiles in the middle, in deviations of what chance gives, is the evidence. But one long edge, a skyline or an eave, puts
all tiles along it in place at once: so the tiles that have only one best place must pass the test by themselves, too.

What chance gives is not the same everywhere: where a scan or a photo repeats itself, where tiles are few or stretched,
a wrong model does better. So it is measured: parts of the photo are exchanged, which makes every model wrong, and the
model must stand out clearly from what is found then (`by_chance`). The rates of right and of wrong photos are measured
by ``python -m benchmarks.trust``.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...messages import Message
from .refinement import fitted, looked_up
from .tiles import Sighting, Tiles, surfaces

RADIUS = 8
"""Half the window that a tile is sought in, in pixels."""

TILE = 40
_SIZES = (28, TILE, 56)
NEAR = 1.5
"""Pixels from its place within which a tile is in place."""

_SPREAD = 0.5
_CHANCE = 0.06
# What strength is needed where the photo was taken from the scanner's place, and where from anywhere: the more freedom
# a model has, the more often a wrong one fits by chance. And how much more than what was found by chance.
_NEEDED_AT_SCANNER, _NEEDED_ANYWHERE = 3.5, 9.0
_BEYOND_CHANCE, _CHANCE_DEVIATIONS = 2.5, 2.0
_ANYWHERE_SHARE = 0.2
# A tile is distinct if nothing farther than this from its best place is nearly as good, in deviations; what strength
# they need, as a share of what all tiles do.
_APART, _DISTINCT = 3.0, 0.3
_NEEDED_OF_DISTINCT = 0.7
_ACCEPTED_MEAN = 0.7
# Tiles half overlap: four in place tell what one point does, and a camera that may be anywhere goes through any four.
# For wrong photos, up to fifteen in place have been found, and a strength of 6 where enough tiles were in place: what
# was searched for among many must be stronger than that. Right photos of real scans begin at 19 tiles and 8.8.
LEAST_PARTS, _TILES_AT_SCANNER, _TILES_ANYWHERE = 10, 16, 30
_NEEDED_OF_SEARCHED = 7.0
# Of a photo whose parts are exchanged: whether it is mirrored, and what share of it is moved down and to the right.
# More are tried where the verdict hangs on it: where what these ask for is within a factor of the strength.
_EXCHANGED = (
    (0, 0, 0.35),
    (0, 0, 0.65),
    (0, 0.5, 0.2),
    (0, 0.5, 0.7),
    (1, 0, 0),
    (1, 0, 0.5),
    (1, 0.5, 0.25),
    (1, 0.5, 0.75),
)
_MORE_EXCHANGED = tuple(
    (mirrored, down, right)
    for mirrored in (0, 1)
    for down, rights in ((0, (0.2, 0.8)), (0.3, (0.1, 0.45, 0.8)), (0.5, (0, 0.45)), (0.7, (0.3,)))
    for right in rights
)
_HANGS_ON_IT = 2.0
# The tiles in place must spread over the scan as far as a third of how all tiles do.
_ACCEPTED_SPREAD = 0.33
# Of the tiles in place, so many must be in place in wider windows, too; and the best fit elsewhere may have so much of
# the strength. See `repetition`.
_ACCEPTED_HELD, _ACCEPTED_ELSEWHERE = 0.25, 0.57


@dataclass(frozen=True)
class Evidence:
    """The evidence for a model.

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
    held : float
        Which share of the tiles in place is in place in wider windows, too; 1 where that was not looked for.
    elsewhere : float
        The strength of the best fit elsewhere as a share of the strength here; 0 where that was not looked for.
    """

    deviations: float
    in_place: int
    tiles: int
    mean: float
    spread: float
    distinct: float
    needed: float = _NEEDED_ANYWHERE
    needed_tiles: float = _TILES_ANYWHERE
    held: float = 1.0
    elsewhere: float = 0.0

    @property
    def accepted(self):
        """Whether the model is right."""
        return self.share >= 1

    @property
    def share(self):
        """The evidence as a share of what is needed: the smallest of strength, mean, tiles in place and spread, and of
        how much better the photo fits here than elsewhere."""
        enough = self.mean / _ACCEPTED_MEAN, self.in_place / self.needed_tiles, self.spread / _ACCEPTED_SPREAD
        return max(min(self.rank, *enough, self._only_here), 0.0)

    @property
    def _only_here(self):
        """How much better the photo fits here than elsewhere, as a share of what is needed; infinite if not tested."""
        held = self.held / _ACCEPTED_HELD if self.held < 1 else np.inf
        return min(held, _ACCEPTED_ELSEWHERE / self.elsewhere if self.elsewhere > 0 else np.inf)

    @property
    def repeats(self):
        """Whether the photo would fit elsewhere as well."""
        return self._only_here < 1

    @property
    def strength(self):
        """Deviations times mean score: right models are high in both."""
        return max(self.deviations, 0.0) * max(self.mean, 0.0)

    @property
    def rank(self):
        """One number to compare models by: the weaker of both strengths, as a share of what is needed."""
        return min(self.strength, self.distinct / _NEEDED_OF_DISTINCT) / self.needed

    @property
    def said(self):
        """A `Message` for a person."""
        if self.tiles == 0:
            return Message("it shows nothing of the scan that could be found")
        if self.repeats:
            said = "{count} of {all} parts of the scan agree with it, but would elsewhere as well"
        else:
            said = "{count} of {all} parts of the scan agree with it"
        return Message(said, count=self.in_place, all=self.tiles)


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


def known_before(proof):
    """Return the `Evidence` with the need of a model without any freedom: nothing was searched for it."""
    return replace(proof, needed=_NEEDED_AT_SCANNER, needed_tiles=LEAST_PARTS)


def searched(proof):
    """Return `Evidence` that need be what the best of all models that were tried needs, so that it is no chance."""
    return replace(proof, needed=max(proof.needed, _NEEDED_OF_SEARCHED))


def beyond_chance(proof, scan_image, photo, model):
    """Return the `Evidence` with a need that exceeds what is found for a photo whose parts are exchanged."""
    sighting = Sighting.of(scan_image, photo, model)
    if sighting is None:
        return proof
    strengths = by_chance(scan_image, sighting, model)
    needed = _needed_by_chance(strengths)
    if proof.strength / _HANGS_ON_IT < needed < proof.strength * _HANGS_ON_IT:
        strengths = np.concatenate([strengths, by_chance(scan_image, sighting, model, _MORE_EXCHANGED)])
        needed = _needed_by_chance(strengths)
    return replace(proof, needed=max(proof.needed, needed))


def _needed_by_chance(strengths):
    """The strength that is needed to stand out from those found by chance; 0 where hardly any was found."""
    if len(strengths) < 2:
        return 0.0
    return _BEYOND_CHANCE * float(strengths.mean() + _CHANCE_DEVIATIONS * strengths.std(ddof=1))


def _needed(scan_image, model):
    """The strength and the number of tiles that are needed for a model."""
    if model.kind == "homography":
        return _NEEDED_AT_SCANNER, _TILES_AT_SCANNER
    share = np.linalg.norm(model.center) / np.median(scan_image.range[scan_image.valid])
    freedom = [0, _ANYWHERE_SHARE]
    return (
        float(np.interp(share, freedom, [_NEEDED_AT_SCANNER, _NEEDED_ANYWHERE])),
        float(np.interp(share, freedom, [_TILES_AT_SCANNER, _TILES_ANYWHERE])),
    )


def judged(found, shift=0.0):
    """Return the `Evidence` in `Surfaces` of radius `RADIUS`, for a model that shifts the tiles by (N, 2) pixels more,
    to the right and down."""
    radius = found.radius
    count = len(found.scores)
    best = found.scores.reshape(count, -1).argmax(axis=1)
    row, col = np.divmod(best, 2 * radius + 1)
    shift = np.broadcast_to(shift, (count, 2))
    near = np.hypot(col - radius - shift[:, 0], row - radius - shift[:, 1]) <= NEAR
    middle = looked_up(found.scores, shift[None])[0]
    spread = 0.0
    if near.sum() >= 3:
        axes = np.linalg.svd(found.middles - found.middles.mean(axis=0), full_matrices=False)[2]
        spread = float(min((found.middles[near] @ axes.T).std(axis=0) / ((found.middles @ axes.T).std(axis=0) + 1e-9)))
    one_peak = _one_peak(found.scores, row, col)
    distinct = (
        max(_deviations(near[one_peak]), 0.0) * max(float(middle[one_peak].mean()), 0.0) if one_peak.any() else 0.0
    )
    return Evidence(_deviations(near), int(near.sum()), count, float(middle.mean()), spread, distinct)


def by_chance(scan_image, sighting, model, exchanged=_EXCHANGED):
    """Return the strengths (K,) that a model has for photos that cannot be right: parts of its own, exchanged.

    The photo's edges are moved far away, and mirrored, under the scan; then the model is fitted to them as it was to
    the photo. So it includes all that helps a wrong model: repetition, long edges, few or stretched tiles, freedom.
    """
    strengths, rng = [], np.random.default_rng(0)
    height, width = sighting.seen.shape
    for mirrored, down, right in exchanged:
        features = sighting.features[:, ::-1] * np.float32([1, 1, -1]) if mirrored else sighting.features
        features = np.roll(features, (round(down * height), round(right * width)), (0, 1))
        strengths.append(strength_of(scan_image, sighting, model, features, rng))
    return np.array([strength for strength in strengths if strength is not None])


def strength_of(scan_image, sighting, model, features, rng):
    """Return the strength of a model that is fitted to other edges (h, w, 3) than the photo's; None where too few tiles
    are seen."""
    found = surfaces(scan_image, Tiles.of(scan_image, TILE), None, model, RADIUS, replace(sighting, features=features))
    if found is None:
        return None
    free = model.ALL if model.kind == "homography" else model.POSE
    changed, _ = fitted(found, model, free, blur=1.0, spread=_SPREAD, rng=rng)
    shift = found.shifts(changed.project(found.sites)[0])
    return judged(found, np.nan_to_num(shift, nan=2.0 * RADIUS)).strength


def in_place(scores):
    """Return (N,) bool: tiles whose highest score, of surfaces (N, 2 r + 1, 2 r + 1), is in the middle."""
    row, col = np.divmod(scores.reshape(len(scores), -1).argmax(axis=1), scores.shape[2])
    return np.hypot(row - scores.shape[1] // 2, col - scores.shape[2] // 2) <= NEAR


def _deviations(near):
    """How far the number of tiles in place exceeds chance, in standard deviations."""
    return float((near.sum() - _CHANCE * len(near)) / np.sqrt(_CHANCE * (1 - _CHANCE) * len(near)))


def _one_peak(scores, row, col):
    """(N,) bool: surfaces where nothing apart from the highest place, at (row, col), is nearly as high."""
    y, x = np.ogrid[: scores.shape[1], : scores.shape[2]]
    apart = np.hypot(y - row[:, None, None], x - col[:, None, None]) > _APART
    second = np.where(apart, scores, -np.inf).max(axis=(1, 2))
    return scores.max(axis=(1, 2)) - second >= _DISTINCT
