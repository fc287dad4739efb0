"""Superpixels and Method 2 as published."""

import numpy as np
import painted_room
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reflcolor_addon import Settings
from reflcolor_addon.matching import match_seeds
from reflcolor_addon.matching.superpixels import superpixels

SLIC = {"compactness": 0.1, "sigma": 1.0}


def image(height=40, width=60):
    return np.random.default_rng(0).uniform(0, 255, (height, width)).astype(np.float32)


@settings(max_examples=15)
@given(st.integers(1, 4000), st.integers(0, 2**32 - 1))
def test_every_measured_pixel_is_in_a_segment_and_every_center_in_its_own(segments, seed):
    valid = np.random.default_rng(seed).random((40, 60)) < 0.7
    found = superpixels(image(), valid, segments=segments, **SLIC)
    assert ((found.labels >= 0) == valid).all()
    assert set(np.unique(found.labels[valid])) == set(range(len(found)))
    assert (found.labels[tuple(found.centers.T)] == np.arange(len(found))).all()


def test_one_segment_is_the_whole():
    assert len(superpixels(image(), np.ones((40, 60), bool), segments=1, **SLIC)) == 1


def test_more_segments_than_pixels_are_the_pixels():
    assert len(superpixels(image(), np.ones((40, 60), bool), segments=5000, **SLIC)) == 2400


def test_nothing_measured_has_no_segment():
    assert len(superpixels(image(), np.zeros((40, 60), bool), segments=50, **SLIC)) == 0


def test_as_published_every_superpixel_of_the_scan_gets_the_center_color_of_one_of_a_photo():
    room = painted_room.scan(rows=60, columns=90, step_deg=0.6)
    photos = [painted_room.photo(painted_room.camera(width=120, height=90), seed) for seed in (0, 1)]
    seeds = match_seeds(room, photos, Settings(matching="paper", slic_segments=80))
    assert 40 < len(seeds) < 160
    assert set(seeds.reason) == {"appearance"}
    assert set(seeds.photos) == {"photo 1", "photo 2"}
    assert ((seeds.confidence >= 0) & (seeds.confidence <= 1)).all()


@pytest.mark.parametrize("changes", [{"slic_segments": 1}, {"slic_segments": 20_000}, {"hog_window": 16}])
def test_as_published_extreme_settings_give_seeds(changes):
    room = painted_room.scan(rows=20, columns=30, step_deg=1.8)
    photo = painted_room.photo(painted_room.camera(width=40, height=30))
    seeds = match_seeds(room, [photo], Settings(matching="paper", **changes))
    assert 1 <= len(seeds) <= room.valid.sum()


def test_superpixels_lie_across_the_edge_of_a_full_turn():
    angle = np.radians(np.arange(120) * 3.0)
    around = np.broadcast_to(127 + 100 * np.cos(angle), (40, 120)).astype(np.float32)
    around = around + np.random.default_rng(0).normal(0, 3, around.shape).astype(np.float32)
    valid = np.ones(around.shape, bool)
    found = superpixels(around, valid, segments=40, full_turn=True, **SLIC)
    assert (found.labels >= 0).all()
    assert (found.labels[tuple(found.centers.T)] == np.arange(len(found))).all()
    across = np.intersect1d(found.labels[:, 0], found.labels[:, -1])
    assert len(across)
    for label in across:
        cols = np.nonzero((found.labels == label).any(axis=0))[0]
        unwrapped = np.where(cols < 60, cols + 120, cols)
        assert np.ptp(unwrapped) < 60
        center = found.centers[label][1]
        assert unwrapped.min() <= (center + 120 if center < 60 else center) <= unwrapped.max()
    assert not len(np.intersect1d(*(superpixels(around, valid, segments=40, **SLIC).labels[:, [0, -1]].T)))
