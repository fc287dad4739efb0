"""A camera or homography that is known roughly, fitted level by level; and a camera one step of a pattern aside."""

from dataclasses import replace

import numpy as np

from ...messages import Message
from .refinement import fitted, tightened
from .tiles import surfaces
from .verification import NO_EVIDENCE, RADIUS, TILE, evidence, judged

# As shares of the search's step: the pixels of the scan's images on the three levels, with the tile's size.
COARSE, MIDDLE, FINE = (1.3, 24), (0.8, 32), (0.5, TILE)
# How far aside a camera is tried, in the median distance of what the scan sees; how much stronger it must be there; and
# how often it may move on.
_ASIDE, _STRONGER, _MOVES = (-0.18, -0.12, -0.06, 0.06, 0.12, 0.18), 1.05, 3


def refined(views, photo, model, levels, *, free, rng, pairs=None):
    """Return a model fitted level by level, and its `Evidence` on the last one."""
    model = _led(views, photo, model, levels, free, rng, pairs)
    if model is None:
        return None, NO_EVIDENCE
    share, size = levels[-1][:2]
    found = surfaces(views.image(share), views.tiles(share, size), photo, model, RADIUS)
    return model, NO_EVIDENCE if found is None else judged(found)


def _led(views, photo, model, levels, free, rng, pairs=None):
    """A model fitted level by level; None where the photo shows too little of the scan."""
    for share, size, radius, blur, spread in levels:
        found = surfaces(views.image(share), views.tiles(share, size), photo, model, radius)
        if found is None:
            return None
        model, _ = fitted(found, model, free, blur=blur, spread=spread, rng=rng, pairs=pairs)
    return model


def finely(views, photo, model, rng, *, turned_only=False, pairs=None):
    """Return a camera or homography that is nearly right, fitted with all it has, and its `Evidence`.

    With ``turned_only`` a camera stays where it is: where that is right, nothing is as sure.
    """
    last = model.TURNED if turned_only else model.ALL
    if pairs is not None and views.repeats > 1:
        # A few pairs bend to a lens, and drawn out tiles do not hold it.
        last = model.POSE
    if model.kind == "homography":
        stages = [(model.ALL, [(*FINE, 6, 0.5, 0.4)])]
    elif turned_only:
        stages = [(model.ROTATION, [(*FINE, 8, 1.0, 0.5), (*FINE, 6, 0.5, 0.3)])]
    else:
        stages = [(model.POSE, [(*FINE, 8, 1.0, 0.5), (*FINE, 8, 0.7, 0.4)]), (last, [(*FINE, 6, 0.5, 0.2)])]
    for free, levels in stages:
        model = _led(views, photo, model, levels, free, rng, pairs)
        if model is None:
            return None, NO_EVIDENCE
    image, tiles = views.image(FINE[0]), views.tiles(*FINE)
    for _ in range(2):
        found = surfaces(image, tiles, photo, model, RADIUS)
        if found is None:
            return None, NO_EVIDENCE
        model = tightened(found, model, last, pairs)
    return model, evidence(image, photo, model)


def beside(views, photo, model, proof, *, step=lambda text: None):
    """Return a camera aside that agrees with more of the scan than an accepted one, and its `Evidence`; or the same.

    Where a scene repeats itself, bricks, tiles, windows in a row, a camera that is off by one of them has nearly as
    much in place as the right one, and what lies between is beyond the tiles' windows.
    """
    rng = np.random.default_rng(0)
    distance = np.median(views.scan.range[views.scan.valid])
    level = [(*MIDDLE, RADIUS, 0.7, 0.5)]
    for _ in range(_MOVES):
        step(Message("{photo}: looking for what repeats", photo=photo.name))
        _, here = refined(views, photo, model, [(*MIDDLE, RADIUS, 0.7, 0.3)], free=model.POSE, rng=rng)
        tried = []
        for share in _ASIDE:
            start = replace(model, center=model.center + share * distance * model.rotation[0])
            tried.append(refined(views, photo, start, level, free=model.POSE, rng=rng))
        moved, strength = max(tried, key=lambda pair: pair[1].strength)
        if strength.strength <= _STRONGER * here.strength:
            break
        candidate, found = finely(views, photo, moved, rng)
        if not found.accepted or found.strength <= _STRONGER * proof.strength:
            break
        model, proof = candidate, found
    return model, proof
