"""Colors guessed from likeness: only where they prove better than the mean color."""

import numpy as np

from reflcolor_addon.matching.transfer.appearance import LEAST_CONFIDENCE, Appearance

RNG = np.random.default_rng(0)
PLACES = np.argwhere(np.ones((20, 20), bool)).astype(float)
LOOKS = RNG.normal(0, 1, (400, 9))


def test_colors_that_follow_from_the_look_are_guessed():
    rgb = np.where(LOOKS[:, :1] > 0, [200, 60, 50], [50, 80, 200]).astype(np.uint8)
    wanted = RNG.normal(0, 1, (100, 9))
    wanted[:, 0] = np.where(wanted[:, 0] > 0, 1.5, -1.5)
    guessed, confidence = Appearance.learned(LOOKS * [9, *(1,) * 8], rgb, PLACES).predict(wanted * [9, *(1,) * 8])
    sure = confidence >= LEAST_CONFIDENCE
    assert sure.mean() > 0.5
    assert ((guessed[:, 0] > 120) == (wanted[:, 0] > 0))[sure].mean() > 0.8


def test_colors_that_have_nothing_to_do_with_the_look_are_not_guessed():
    rgb = RNG.integers(0, 255, (400, 3)).astype(np.uint8)
    _, confidence = Appearance.learned(LOOKS, rgb, PLACES).predict(LOOKS[:50])
    assert (confidence < LEAST_CONFIDENCE).all()


def test_what_looks_like_nothing_that_was_seen_is_not_guessed():
    rgb = np.where(LOOKS[:, :1] > 0, [200, 60, 50], [50, 80, 200]).astype(np.uint8)
    _, confidence = Appearance.learned(LOOKS, rgb, PLACES).predict(LOOKS[:20] + 30)
    assert (confidence == 0).all()


def test_where_a_color_changes_from_place_to_place_it_is_not_guessed():
    # Every neighbor of the same look has its color, but beyond a border another one.
    rgb = np.where(PLACES[:, :1] < 10, [200, 60, 50], [50, 80, 200]).astype(np.uint8)
    _, confidence = Appearance.learned(LOOKS, rgb, PLACES).predict(LOOKS)
    assert (confidence < LEAST_CONFIDENCE).all()
