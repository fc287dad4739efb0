"""Matching on real scans, whose true colors are known."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks import real_scans
from reflcolor_addon.matching import match_photos


def median_error(matching, scan):
    seeds = matching.seeds
    known = real_scans.has_truth(scan)[seeds.rows, seeds.cols]
    error = np.abs(seeds.rgb.astype(int) - scan.color[seeds.rows, seeds.cols]).max(axis=1)
    return np.median(error[known])


@pytest.mark.slow
def test_infrared_is_registered_with_a_photo_from_beside(data_dir):
    scan = real_scans.load("k4a", data_dir)
    matching = match_photos(scan, [Path(data_dir, "k4a_mug/color_1280x720.jpg")])
    assert matching.photos[0].verified
    # The color camera is 32 mm beside the infrared one.
    assert np.linalg.norm(matching.photos[0].model.center) < 0.1
    assert median_error(matching, scan) < 12


@pytest.mark.slow
def test_a_view_is_registered_with_one_turned_by_thirty_degrees(data_dir):
    scan, other = (real_scans.load(f"bildstein_{view}", data_dir) for view in ("10", "15"))
    matching = match_photos(scan, [other.color])
    assert matching.photos[0].verified
    seen = np.array(matching.photos[0].reason) == np.array(matching.seeds.reason)
    assert seen.sum() > 50


@pytest.mark.slow
@pytest.mark.parametrize("name", ["doria", "pumpA"])
def test_a_scans_own_colors_are_registered(data_dir, name):
    scan = real_scans.load(name, data_dir)
    matching = match_photos(scan, [scan.color])
    assert matching.photos[0].verified
    assert median_error(matching, scan) < 15
