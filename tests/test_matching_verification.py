"""The test that a wrong model fails, on made-up surfaces of scores."""

import numpy as np

from reflcolor_addon.matching.registration.tiles import Surfaces
from reflcolor_addon.matching.registration.verification import RADIUS, judged

SIDE = 2 * RADIUS + 1
SHIFT = np.arange(SIDE) - RADIUS


def found(scores):
    """The surfaces of tiles that lie on a lattice."""
    count = len(scores)
    deviation = scores.std(axis=(1, 2), keepdims=True)
    scores = ((scores - scores.mean(axis=(1, 2), keepdims=True)) / deviation).astype(np.float32)
    middles = np.argwhere(np.ones((8, -(-count // 8))))[:count] * 20
    return Surfaces(scores, middles.astype(float), middles.astype(float), np.array([np.eye(2)] * count), middles, 5.0)


def noise(count, seed=0):
    """Smooth surfaces, as correlations are."""
    import cv2

    grain = np.random.default_rng(seed).standard_normal((count, SIDE, SIDE))
    return np.array([cv2.GaussianBlur(one, (0, 0), 1.5) for one in grain])


def test_tiles_anywhere_are_no_evidence():
    evidence = judged(found(noise(160)))
    assert abs(evidence.deviations) < 3
    assert evidence.rank < 0.1


def test_tiles_in_their_places_are_evidence():
    peak = np.exp(-(SHIFT[:, None] ** 2 + SHIFT**2) / 8)
    scores = noise(160)
    scores[::2] += peak
    evidence = judged(found(scores))
    assert 70 <= evidence.in_place <= 100
    assert evidence.accepted


def test_tiles_along_one_edge_are_no_evidence():
    # An edge through all tiles: across it they are in place, along it they may lie anywhere.
    ridge = np.broadcast_to(np.exp(-(SHIFT[:, None] ** 2) / 8), (SIDE, SIDE))
    evidence = judged(found(0.15 * noise(160) + ridge))
    assert evidence.strength > 5
    assert evidence.distinct < 0.3 * evidence.strength
    assert not evidence.accepted
