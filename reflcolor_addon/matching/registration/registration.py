"""Finding the model of one photo: candidates from features and from the search, refined, and judged."""

from dataclasses import dataclass

import numpy as np

from ..scan_image import TONES, ScanImage, pixel_steps, toned
from . import features
from .refinement import fitted, tightened
from .search import Search, map_step
from .tiles import Tiles, surfaces
from .verification import NO_EVIDENCE, RADIUS, TILE, Evidence, evidence, judged, known_before

# Of the search's step: the pixels of the scan's images on the three levels, with the tile's size.
_COARSE, _MIDDLE, _FINE = (1.3, 24), (0.8, 32), (0.5, TILE)
# Pixels, tile, radius, blur and spread from guess to guess: a direction from the scanner is found nearly exactly, and
# weak evidence shows on fine levels only; a place aside is found roughly.
_FROM_SCANNER = ([(0.6, TILE, 8, 2.0, 0.5)],)
_FROM_ASIDE = ([(*_COARSE, 10, 1.5, 1.2)], [(*_MIDDLE, 10, 1.0, 0.8)])
# From this multiple of the needed evidence on, nothing better is looked for.
_CONVINCING = 2.0
_GUESSES = 14
_TRIED = 5
_PENALTY = 0.004
_ROUNDS, _PROMISING = 2, 0.2
# A guess is refined with all there is only if its tiles tell something, a second only if it is nearly as good.
_TELLING, _NEARLY = 1.0, 0.6
# Of a homography whose tiles are in place no oftener than by chance nothing is hoped for.
_LEAST_DEVIATIONS = 1.5
_LEAST_CONTRAST = 8
_LEAST_PIXELS = 400


@dataclass(frozen=True, eq=False)
class Registration:
    """A photo's model, the evidence for it, and where it came from."""

    model: object
    evidence: Evidence
    found_by: str

    @property
    def accepted(self):
        """Whether the evidence is enough."""
        return self.model is not None and self.evidence.accepted

    @property
    def beyond_doubt(self):
        """Whether nothing better need be looked for."""
        return self.accepted and self.evidence.rank >= _CONVINCING

    def better_than(self, other):
        """Whether more speaks for it than for another one."""
        return self.model is not None and (other.model is None or self.evidence.rank > other.evidence.rank)

    @classmethod
    def nothing(cls, found_by="nothing"):
        """What there is before anything was found."""
        return cls(None, NO_EVIDENCE, found_by)


class ScanViews:
    """Everything of a scan that registering any photo needs, made when first asked for."""

    def __init__(self, scan):
        self.scan = scan
        self.step_deg = map_step(scan)
        self._made = {}

    @property
    def enough(self):
        """Whether there is anything to match: enough returns, and not all in one place."""
        points = self.scan.points[self.scan.valid]
        return len(points) >= _LEAST_PIXELS and bool(np.ptp(points, axis=0).max() > 0)

    def tone(self, tone):
        """The toned reflectance, see `scan_image.toned`."""
        return self._once(("tone", tone), lambda: toned(self.scan, tone))

    def image(self, tone, share):
        """The `ScanImage` whose pixels are ``share`` of the search's."""
        step = self.step_deg * share
        return self._once(("image", tone, share), lambda: ScanImage(self.scan, self.tone(tone), step))

    def tiles(self, tone, share, size):
        """Tiles on that image."""
        return self._once(("tiles", share, size), lambda: Tiles.of(self.image(tone, share), size))

    def _once(self, key, make):
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
    best = Registration.nothing()
    if np.ptp(photo.levels[0][0]) < _LEAST_CONTRAST or not views.enough:
        return best
    search = Search(views, photo)

    def features_step():
        step(f"{photo.name}: matching features")

    def search_step():
        step(f"{photo.name}: searching directions")

    def aside_step():
        step(f"{photo.name}: searching viewpoints")

    def from_scanner(tone):
        return _tried(views, photo, tone, search.from_scanner(tone, search_step), False, step)

    attempts = (
        (_CONVINCING, lambda: _by_features(views, photo, "ranks", features_step)),
        (_CONVINCING, lambda: from_scanner("ranks")),
        (1.0, lambda: _tried(views, photo, "ranks", search.from_aside("ranks", aside_step), True, step)),
        (1.0, lambda: from_scanner("percentiles")),
    )
    for enough, attempt in attempts:
        found = attempt()
        if found.better_than(best):
            best = found
        if best.accepted and best.evidence.rank >= enough:
            break
    return best


def confirmed(views, photo, model):
    """Return the `Registration` of a model that is known roughly, refined and judged.

    Nothing was searched, so that hardly a wrong model can stand out by chance: the least evidence will do.
    """
    rng = np.random.default_rng(0)
    best = Registration.nothing("known")
    for tone in TONES:
        near, _ = refined(views, photo, model, tone, [(*_MIDDLE, 8, 1.0, 0.5)], free=model.POSE, rng=rng)
        for start in (model, near):
            if start is None:
                continue
            candidate, proof = finely(views, photo, start, tone, rng)
            found = Registration(candidate, known_before(proof, views.image(tone, _FINE[0])), "known")
            if found.better_than(best):
                best = found
        if best.accepted:
            break
    return best


def refined(views, photo, model, tone, levels, *, free, rng):
    """Return a model fitted level by level, and its `Evidence` on the last one."""
    model = _led(views, photo, model, tone, levels, free, rng)
    if model is None:
        return None, NO_EVIDENCE
    share, size = levels[-1][:2]
    found = surfaces(views.image(tone, share), views.tiles(tone, share, size), photo, model, RADIUS)
    return model, NO_EVIDENCE if found is None else judged(found)


def _led(views, photo, model, tone, levels, free, rng):
    """A model fitted level by level; None where the photo shows too little of the scan."""
    for share, size, radius, blur, spread in levels:
        found = surfaces(views.image(tone, share), views.tiles(tone, share, size), photo, model, radius)
        if found is None:
            return None
        model, _ = fitted(found, model, free, blur=blur, spread=spread, penalty=_PENALTY, rng=rng)
    return model


def finely(views, photo, model, tone, rng, *, turned_only=False):
    """Return a camera or homography that is nearly right, fitted with all it has, and its `Evidence`.

    With ``turned_only`` a camera stays where it is: where that is right, nothing is as sure.
    """
    if model.kind == "homography":
        stages = [(model.ALL, [(*_FINE, 6, 0.5, 0.4)])]
    elif turned_only:
        stages = [(model.ROTATION, [(*_FINE, 8, 1.0, 0.5), (*_FINE, 6, 0.5, 0.3)])]
    else:
        stages = [(model.POSE, [(*_FINE, 8, 1.0, 0.5), (*_FINE, 8, 0.7, 0.4)]), (model.ALL, [(*_FINE, 6, 0.5, 0.2)])]
    for free, levels in stages:
        model = _led(views, photo, model, tone, levels, free, rng)
        if model is None:
            return None, NO_EVIDENCE
    image, tiles = views.image(tone, _FINE[0]), views.tiles(tone, *_FINE)
    for _ in range(2):
        found = surfaces(image, tiles, photo, model, RADIUS)
        if found is None:
            return None, NO_EVIDENCE
        model = tightened(found, model, model.TURNED if turned_only else model.ALL)
    return model, evidence(image, photo, model)


def _by_features(views, photo, tone, step):
    """The best homography of the scan's grid: the straight one, or one from matching features."""
    rng = np.random.default_rng(0)
    best = Registration.nothing("features")
    scan = views.scan
    images = [views.tone(tone)]
    vertical, horizontal = pixel_steps(scan)
    if not 0.8 < vertical / horizontal < 1.25:
        images.append(views.image(tone, 0.0).reflectance)

    def candidates():
        yield features.straight(scan.shape, photo)
        for image in images:
            yield from features.homographies(image, scan.shape, photo, step)

    step()
    for model in candidates():
        step()
        rough = surfaces(views.image(tone, _MIDDLE[0]), views.tiles(tone, *_MIDDLE), photo, model, RADIUS)
        if rough is None or judged(rough).deviations < _LEAST_DEVIATIONS:
            continue
        found = Registration(*finely(views, photo, model, tone, rng), "features")
        if found.better_than(best):
            best = found
        if best.beyond_doubt:
            break
    return best


def _tried(views, photo, tone, guesses, aside, step):
    """The best camera from guesses, of which the better ones go on to the finer levels."""
    rng = np.random.default_rng(0)
    promising = [(guess.camera(photo), NO_EVIDENCE) for guess in guesses[:_GUESSES]]
    for levels in _FROM_ASIDE if aside else _FROM_SCANNER:
        tried = []
        for model, _ in promising:
            step(f"{photo.name}: trying directions")
            free = model.POSE if aside else model.ROTATION
            tried.append(refined(views, photo, model, tone, levels, free=free, rng=rng))
        tried = [pair for pair in tried if pair[0] is not None]
        promising = sorted(tried, key=lambda pair: -pair[1].rank)[:_TRIED]
    best = Registration.nothing("search")
    for start, promise in promising[:2]:
        if promise.strength < max(_TELLING, _NEARLY * promising[0][1].strength) or best.evidence.rank >= _CONVINCING:
            break
        for turned_only in (False,) if aside else (True, False):
            step(f"{photo.name}: refining")
            found = Registration(*finely(views, photo, start, tone, rng, turned_only=turned_only), "search")
            if found.better_than(best):
                best = found
    # A camera far from its guess needs several rounds: what it sees changes while it moves.
    for _ in range(_ROUNDS):
        if best.evidence.rank < _PROMISING:
            break
        step(f"{photo.name}: refining")
        model, proof = finely(views, photo, best.model, tone, rng)
        if proof.rank <= 1.05 * best.evidence.rank:
            break
        best = Registration(model, proof, "search")
    return best
