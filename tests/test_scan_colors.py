"""Seeds in the colors that came with a scan."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_scans import random_scan

from reflcolor_addon import Scan, SeedsError
from reflcolor_addon.seeds.scan_colors import seeds_from_color


def colored(color, valid=None, shape=(30, 40)):
    scan = random_scan(2, shape)
    valid = scan.valid if valid is None else valid
    return Scan(name="hall", points=scan.points, reflectance=scan.reflectance, valid=valid, color=color)


@given(st.integers(1, 1500), st.integers(0, 100))
def test_as_many_as_asked_for_on_pixels_with_a_return_and_a_color(count, seed):
    rng = np.random.default_rng(seed)
    valid, color = rng.random((30, 40)) > 0.3, rng.integers(1, 256, (30, 40, 3), np.uint8)
    color[rng.random((30, 40)) < 0.2] = 0
    known = valid & color.any(axis=-1)
    seeds = seeds_from_color(colored(color, valid), count)
    assert len(seeds) == min(count, known.sum())
    assert known[seeds.rows, seeds.cols].all()
    assert len(set(zip(seeds.rows.tolist(), seeds.cols.tolist(), strict=True))) == len(seeds)
    assert set(seeds.reason) == {"scan"} and not seeds.all_guessed


def test_they_are_spread_evenly():
    seeds = seeds_from_color(colored(np.full((30, 40, 3), 90, np.uint8)), 48)
    quarters = np.bincount(seeds.rows // 15 * 2 + seeds.cols // 20, minlength=4)
    assert (np.abs(quarters - 12) <= 2).all()


def test_a_single_odd_pixel_gives_no_odd_seed():
    color = np.full((30, 40, 3), 90, np.uint8)
    color[10, 10] = 255
    seeds = seeds_from_color(colored(color), 1200)
    assert (seeds.rgb == 90).all()


@pytest.mark.parametrize("color", [None, np.zeros((30, 40, 3), np.uint8)])
def test_a_scan_without_colors_is_told(color):
    with pytest.raises(SeedsError, match=r"^hall: it came without colors"):
        seeds_from_color(colored(color), 5)
