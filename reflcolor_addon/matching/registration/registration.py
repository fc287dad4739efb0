"""Finds the model of one photo: candidates from features and from the search, refined, then tested."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...messages import Message
from ..grid_angles import GridAngles, closed
from ..scan_image import ScanImage, pixel_steps, reflectance_image
from . import features
from .fitting import COARSE, FINE, MIDDLE, beside, finely, refined
from .repetition import alone
from .search import Search, map_step
from .tiles import Tiles, surfaces
from .verification import (
    LEAST_PARTS,
    NO_EVIDENCE,
    RADIUS,
    TILE,
    Evidence,
    beyond_chance,
    judged,
    known_before,
    searched,
)

# Pixels, tile, radius, blur and spread from guess to guess: a direction from the scanner is found nearly exactly, and
# weak evidence shows on fine levels only; a place aside is found roughly.
_FROM_SCANNER = ([(0.6, TILE, 8, 2.0, 0.5)],)
_FROM_ASIDE = ([(*COARSE, 10, 1.5, 1.2)], [(*MIDDLE, 10, 1.0, 0.8)])
# From this multiple of the needed evidence on, nothing better is looked for.
_CONVINCING = 2.0
# And from this mean score of all tiles on: a homography may be right for a wall, where a camera is for all.
_CLEAR = 1.2
# How many are tried from the scanner, and from aside.
_GUESSES = 10, 14
_TRIED = 5
_ROUNDS, _PROMISING, _WORTH = 2, 0.2, 1.05
# A guess is refined with all there is only if its tiles tell something, a second only if it is nearly as good.
_TELLING, _NEARLY = 1.0, 0.6
# A homography whose tiles are in place no more often than by chance is dropped. Below chance at once; else it may be
# off by more than the tiles' windows, and is fitted on larger pixels first, where so much more must be in place.
_LEAST_DEVIATIONS, _LEAST_FITTED = 1.5, 4.0
_FROM_AFAR = [(*COARSE, 10, 1.5, 2.0), (*MIDDLE, 8, 1.0, 0.8)]
_AGAIN = [(*MIDDLE, 10, 1.5, 2.0)]
_LEAST_CONTRAST = 8
# A refined camera fits picked pairs as long as it is no farther off at them than by this factor.
_FITTING = 1.3
_LEAST_PIXELS = 400
# From this factor on measurements are stretched one way.
_STRETCHED = 1.5


@dataclass(frozen=True, eq=False)
class Registration:
    """A photo's model, the evidence for it, and where it came from.

    untestable : str or None
        Why it cannot be decided whether the photo shows the scan.
    beside : str or None
        The name of another photo, if the model follows from what both show.
    """

    model: object
    evidence: Evidence
    found_by: str
    untestable: str | None = None
    beside: str | None = None

    @property
    def accepted(self):
        """Whether the evidence is enough."""
        return self.model is not None and self.evidence.accepted

    @property
    def beyond_doubt(self):
        """Whether nothing better need be looked for."""
        return self.accepted and self.evidence.rank >= _CONVINCING

    @property
    def clear(self):
        """Whether nothing better than a homography need be looked for, either."""
        return self.beyond_doubt and self.evidence.mean >= _CLEAR

    def beyond_chance(self, views, photo):
        """Return it with the strength that it needs to stand out from chance, computed only where that decides."""
        if not self.accepted:
            return self
        return replace(self, evidence=beyond_chance(self.evidence, views.image(FINE[0]), photo, self.model))

    def alone(self, views, photo):
        """Return it with how much better the photo fits here than elsewhere, computed only where that decides."""
        if not self.accepted:
            return self
        return replace(self, evidence=alone(self.evidence, views.image(FINE[0]), photo, self.model))

    def better_than(self, other):
        """Whether there is more evidence for it than for another one."""
        return self.model is not None and (other.model is None or self.evidence.rank > other.evidence.rank)

    def preferable_to(self, other):
        """Whether it is to be used instead of another one."""
        return self.accepted and (not other.accepted or self.better_than(other))

    @classmethod
    def nothing(cls, found_by="nothing", untestable=None):
        """The registration before anything was found."""
        return cls(None, NO_EVIDENCE, found_by, untestable)


class ScanViews:
    """Everything about a scan that registering a photo needs, computed once, on first use."""

    def __init__(self, scan):
        self.scan = scan
        self.closed = closed(scan)
        self.step_deg = map_step(scan)
        self._made = {}

    @cached_property
    def untestable(self):
        """Why no photo can be tested on the scan; None where photos can."""
        points = self.scan.points[self.scan.valid]
        if len(points) < _LEAST_PIXELS:
            return Message(
                "the scan has {count} returns, at least {least} are needed", count=len(points), least=_LEAST_PIXELS
            )
        if np.ptp(points, axis=0).max() == 0:
            return Message("all returns of the scan are in one place")
        parts = len(self.tiles(*FINE).corners)
        if parts < LEAST_PARTS:
            return Message(
                "the scan has {count} parts to compare, at least {least} are needed", count=parts, least=LEAST_PARTS
            )
        return None

    @cached_property
    def _angles(self):
        return GridAngles.of(self.closed)

    @cached_property
    def ranks(self):
        """The reflectance as an image, see `scan_image.reflectance_image`."""
        return reflectance_image(self.closed, "ranks")

    @cached_property
    def described(self):
        """What matching features needs of the scan: a list of `features.Points` of its images."""
        images = [self.ranks]
        vertical, horizontal = pixel_steps(self.scan)
        if not 0.8 < vertical / horizontal < 1.25:
            images.append(self.image(0.0).reflectance)
        return [features.ScanPoints(image, self.scan.shape) for image in images]

    @property
    def repeats(self):
        """How many pixels of the finest image stand for one measurement."""
        return self.image(FINE[0]).pixels_per_measurement

    @property
    def stretched(self):
        """Whether measurements are much farther apart one way than the other, as the rows of a spinning lidar are.

        Tiles that are stretched so find a camera, but fitted further they move it away from where it should be.
        """
        return self.image(FINE[0]).stretch > _STRETCHED

    def image(self, share):
        """The `ScanImage` whose pixels are ``share`` of the search's."""
        return self.once(
            ("image", share), lambda: ScanImage(self.closed, self.ranks, self.step_deg * share, angles=self._angles)
        )

    def tiles(self, share, size):
        """Tiles on that image."""
        return Tiles.of(self.image(share), size)

    def once(self, key, make):
        """Return what ``make()`` returned the first time for this key."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]


def register(views, photo, *, step=lambda text: None):
    """Find the model of a photo.

    Parameters
    ----------
    views : ScanViews
    photo : PhotoImage
    step : callable
        Called with a text before each stage; may raise to end the work.

    Returns
    -------
    Registration
        The best there is, accepted or not.
    """
    untestable = views.untestable
    if np.ptp(photo.gray) < _LEAST_CONTRAST:
        untestable = Message("the photo is of one tone")
    if untestable:
        return Registration.nothing(untestable=untestable)
    best = Registration.nothing()
    search = Search(views, photo)

    def features_step():
        step(Message("{photo}: matching features", photo=photo.name))

    def search_step():
        step(Message("{photo}: searching directions", photo=photo.name))

    def aside_step():
        step(Message("{photo}: searching viewpoints", photo=photo.name))

    attempts = (
        lambda: _by_features(views, photo, features_step),
        lambda: _tried(views, photo, search.from_scanner(search_step), False, step),
        lambda: _tried(views, photo, search.from_aside(aside_step), True, step),
    )
    for attempt in attempts:
        found = attempt()
        if found.better_than(best):
            best = found
        if best.clear:
            break
    if best.accepted and best.model.kind == "pose":
        model, proof = beside(views, photo, best.model, best.evidence, step=step)
        best = replace(best, model=model, evidence=proof)
    best = replace(best, evidence=searched(best.evidence))
    return best.beyond_chance(views, photo).alone(views, photo)


def confirmed(views, photo, model, pairs=None):
    """Return the `Registration` of a model that is known roughly, refined and judged.

    Nothing was searched, so a wrong model hardly ever stands out by chance, and the least evidence is enough. With
    `HandPairs` only a camera that still fits them is taken.
    """
    return _near(views, photo, model, "known", known_before, pairs).beyond_chance(views, photo)


def derived(views, photo, model, beside):
    """Return the `Registration` of a camera that follows from another photo's, of the name ``beside``.

    That one was searched for, and what both show fits wherever it does: so this needs the evidence of a camera that was
    searched for, too.
    """
    found = _near(views, photo, model, "overlap", searched).beyond_chance(views, photo).alone(views, photo)
    return replace(found, beside=beside)


def _near(views, photo, model, found_by, needing, pairs=None):
    """The best registration near a model that is known roughly."""
    rng = np.random.default_rng(0)
    best = Registration.nothing(found_by)
    near, _ = refined(views, photo, model, [(*MIDDLE, 8, 1.0, 0.5)], free=model.POSE, rng=rng, pairs=pairs)
    for start in (model, near):
        if start is None:
            continue
        candidate, proof = finely(views, photo, start, rng, pairs=pairs)
        if pairs is not None and candidate is not None and pairs.off(candidate) > _FITTING * max(pairs.off(model), 1):
            continue
        found = Registration(candidate, needing(proof), found_by)
        if found.better_than(best):
            best = found
    return best


def _by_features(views, photo, step):
    """The best homography of the scan's grid: the straight one, or one from matching features."""
    rng = np.random.default_rng(0)
    best = Registration.nothing("features")

    def candidates():
        yield features.straight(views.scan.shape, photo)
        for points in views.described:
            yield from points.homographies(photo, step)

    step()
    for model in candidates():
        step()
        rough = surfaces(views.image(MIDDLE[0]), views.tiles(*MIDDLE), photo, model, RADIUS)
        in_excess = -np.inf if rough is None else judged(rough).deviations
        if in_excess < 0:
            continue
        if in_excess < _LEAST_DEVIATIONS:
            model, proof = refined(views, photo, model, _FROM_AFAR, free=model.ALL, rng=np.random.default_rng(1))
            if proof.deviations < _LEAST_FITTED:
                continue
        found = Registration(*finely(views, photo, model, rng), "features")
        if found.beyond_doubt and not found.clear:
            # What is right beyond doubt but for some pixels need not be searched for anew.
            found = _again(views, photo, found, rng)
        if found.better_than(best):
            best = found
        if best.beyond_doubt:
            break
    return best


def _again(views, photo, found, rng):
    """A homography fitted once more, on larger pixels first, or the same if that is no better."""
    model, _ = refined(views, photo, found.model, _AGAIN, free=found.model.ALL, rng=rng)
    if model is None:
        return found
    better = Registration(*finely(views, photo, model, rng), found.found_by)
    return better if better.better_than(found) else found


def _tried(views, photo, guesses, aside, step):
    """The best camera from guesses, of which the better ones go on to the finer levels."""
    rng = np.random.default_rng(0)
    promising = [(guess.camera(photo), NO_EVIDENCE) for guess in guesses[: _GUESSES[aside]]]
    for levels in _FROM_ASIDE if aside else _FROM_SCANNER:
        tried = []
        for model, _ in promising:
            step(Message("{photo}: trying directions", photo=photo.name))
            free = model.POSE if aside else model.ROTATION
            better, proof = refined(views, photo, model, levels, free=free, rng=rng)
            # What these pixels are too coarse for may show on the next level.
            tried.append((model if better is None else better, proof))
        # Large tiles of coarse pixels seldom have but one best place: their strength is all that tells.
        promising = sorted(tried, key=lambda pair: -pair[1].strength)[:_TRIED]
    best = Registration.nothing("search")
    for start, promise in promising[:2]:
        if promise.strength < max(_TELLING, _NEARLY * promising[0][1].strength) or best.evidence.rank >= _CONVINCING:
            break
        for turned_only in (False,) if aside else (True, False):
            step(Message("{photo}: refining", photo=photo.name))
            found = Registration(*finely(views, photo, start, rng, turned_only=turned_only), "search")
            if found.better_than(best):
                best = found
    # A camera far from its guess needs several rounds, also with larger pixels: what it sees changes while it moves.
    for _ in range(_ROUNDS):
        if best.evidence.rank < _PROMISING:
            break
        before = best
        wider, _ = refined(views, photo, best.model, [(*MIDDLE, 10, 1.0, 0.8)], free=best.model.POSE, rng=rng)
        for start in (before.model, wider):
            step(Message("{photo}: refining", photo=photo.name))
            if start is not None:
                found = Registration(*finely(views, photo, start, rng), "search")
                if found.evidence.rank > _WORTH * best.evidence.rank:
                    best = found
        if best is before:
            break
    return best
