"""How many nearest seeds are taken where that is left to the program."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon import Scan, Seeds, Settings, colorize
from reflcolor_addon.color import nearest_seeds


def ramp_scan(shape, reflectance):
    rows, cols = np.mgrid[: shape[0], : shape[1]]
    points = np.stack([np.full(shape, 5.0), -cols * 0.01, -rows * 0.01], axis=-1)
    return Scan(name="ramp", points=points, reflectance=reflectance.astype(np.float32), valid=np.ones(shape, bool))


@pytest.fixture
def never_all(monkeypatch):
    monkeypatch.setattr(nearest_seeds, "EXACT_PIXEL_SEEDS", 0)


def test_the_least_number_is_taken_where_the_nearest_seeds_decide(never_all):
    # A rough scan: every step costs, so that the weights r^-6 fall off steeply.
    scan = ramp_scan((40, 40), np.random.default_rng(0).uniform(0, 255, (40, 40)))
    rows, cols = (place.ravel() for place in np.mgrid[2:40:4, 2:40:4])
    shades = 100 + (rows + cols) % 20
    seeds = Seeds(rows, cols, np.stack([shades, shades // 2, shades // 3], axis=1))
    method = colorize(scan, seeds, Settings(nearest="auto")).method
    assert method["nearest"] == 8
    assert method["doubled_levels"]["p95"] <= 1


def test_the_greatest_number_is_taken_where_all_seeds_are_equally_far(never_all):
    # Nothing costs anything on a flat image: all seeds share all pixels.
    scan = ramp_scan((12, 12), np.full((12, 12), 7.0))
    rng = np.random.default_rng(1)
    seeds = Seeds(rng.integers(0, 12, 100), rng.integers(0, 12, 100), rng.integers(0, 256, (100, 3)))
    method = colorize(scan, seeds, Settings(nearest="auto")).method
    assert method["nearest"] == 32
    assert method["doubled_levels"]["p95"] > 1


def test_no_more_seeds_are_sought_than_there_are(never_all):
    scan = ramp_scan((12, 12), np.full((12, 12), 7.0))
    seeds = Seeds(np.arange(12), np.arange(12), np.random.default_rng(2).integers(0, 256, (12, 3)))
    every = colorize(scan, seeds, Settings())
    found = colorize(scan, seeds, Settings(nearest="auto"))
    assert found.method["nearest"] == 12
    assert np.abs(found.rgb.astype(int) - every.rgb).max() <= 1


def test_colors_that_are_all_the_same_do_not_change():
    random = np.random.default_rng(3)
    lists = np.sort(random.random((50, 8)).astype(np.float32), axis=1), random.integers(0, 9, (50, 8)).astype(np.int32)
    assert nearest_seeds.doubled_levels(lists, np.full((9, 2), 5.0), 6.0, 2.0) == pytest.approx(0)


def test_the_change_is_that_of_eq_1_over_half_of_the_seeds():
    distances = np.array([[1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1e9, 1e9]], np.float32)
    lists = distances, np.array([[0, 1, 2, 3], [0, 1, 2, 3]], np.int32)
    # The first pixel goes from the mean of 0 and 4, 2, to that of all, 5; the second stays.
    values = np.array([[0.0], [4.0], [6.0], [10.0]])
    assert nearest_seeds.doubled_levels(lists, values, 6.0, 2.0) == pytest.approx(0.95 * 6.0)


@given(shape=st.tuples(st.integers(1, 400), st.integers(1, 400)), share=st.floats(0.1, 1.0))
def test_the_sample_is_of_pixels_with_a_return_all_over_the_scan(shape, share):
    valid = np.random.default_rng(0).random(shape) < share
    pixels = nearest_seeds.sample_of(valid)
    assert valid.ravel()[pixels].all()
    if min(shape) > 100:
        rows, cols = np.divmod(pixels, shape[1])
        for places, length in ((rows, shape[0]), (cols, shape[1])):
            parts = np.bincount(places * 10 // length, minlength=10)
            assert parts.max() < 2 * parts.min()
