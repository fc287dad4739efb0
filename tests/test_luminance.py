"""How light the colors are: as the scan, as the seeds tell, or between."""

import dataclasses

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Colorizer, Seeds, Settings, colorize
from reflcolor_addon.settings import SETTINGS

# Everything holds with the native kernel and without.
pytestmark = pytest.mark.usefixtures("engine")

NATURAL = Settings.preset("Natural")
PATHS = Settings(light=1.0)
SEEDS = Seeds([1, 4, 8], [2, 9, 5], [[200, 60, 40], [30, 40, 90], [120, 200, 110]])


@pytest.mark.parametrize("settings", [NATURAL, PATHS], ids=["Natural", "paths"])
def test_from_one_seed_everything_has_its_color_and_keeps_half_of_the_scan_s_light_and_dark(settings):
    scan = random_scan(shape=(9, 12))
    result = colorize(scan, Seeds([3], [3], [[90, 60, 40]]), settings)
    assert np.abs(result.rgb[3, 3].astype(int) - [90, 60, 40]).max() <= 1
    level = result.rgb @ [0.299, 0.587, 0.114]
    order = np.argsort(scan.reflectance, axis=None)
    assert (np.diff(level.ravel()[order]) >= -1).all() and level.max() > 1.5 * level.min()
    assert (result.rgb[..., 0] >= result.rgb[..., 1]).all() and (result.rgb[..., 1] >= result.rgb[..., 2]).all()


@pytest.mark.parametrize("space", [choice.value for choice in SETTINGS["color_space"].choices])
def test_along_paths_a_seed_keeps_its_whole_color(space):
    result = colorize(random_scan(shape=(9, 12)), SEEDS, Settings(light=1.0, color_space=space))
    assert np.abs(result.rgb[SEEDS.rows, SEEDS.cols].astype(int) - SEEDS.rgb).max() <= 1


def test_between_the_scan_and_the_photo_the_luminance_is_between():
    scan, gray = random_scan(shape=(9, 12)), Seeds(SEEDS.rows, SEEDS.cols, [[90] * 3, [30] * 3, [200] * 3])
    dark, half, light = (
        colorize(scan, gray, Settings(light=share)).rgb[..., 0].astype(float) for share in (0, 0.25, 1)
    )
    np.testing.assert_allclose(half, 0.75 * dark + 0.25 * light, atol=1)


def test_the_chrominance_does_not_depend_on_the_light():
    scan = random_scan(shape=(9, 12))
    scan = dataclasses.replace(scan, reflectance=0.4 + 0.2 * scan.reflectance)
    colorizer = Colorizer(scan)
    scans, photos = (
        colorizer.spread(SEEDS, dataclasses.replace(NATURAL, light=light))[0].values[..., :2] for light in (0, 1)
    )
    np.testing.assert_allclose(scans, photos, atol=1e-4)


def test_another_light_or_tone_computes_nothing_anew(monkeypatch):
    scan = random_scan(shape=(9, 12))
    colorizer = Colorizer(scan, NATURAL)
    colorizer.colorize(SEEDS)
    monkeypatch.setattr(colorizer._spreader, "_spread_from", None)
    for change in ({"light": 0.3}, {"tone": 1.7}, {"light": 0.8, "tone": 0.6}):
        settings = dataclasses.replace(NATURAL, **change)
        assert colorizer.colorize(SEEDS, settings).rgb.tobytes() == colorize(scan, SEEDS, settings).rgb.tobytes()


def test_the_light_can_be_asked_for_later():
    scan = random_scan(shape=(9, 12))
    for first, then in ((Settings(), PATHS), (PATHS, Settings()), (NATURAL, PATHS)):
        colorizer = Colorizer(scan, first)
        colorizer.colorize(SEEDS)
        assert colorizer.colorize(SEEDS, then).rgb.tobytes() == colorize(scan, SEEDS, then).rgb.tobytes()


def test_pixels_cut_off_from_every_seed_keep_the_gray_of_the_scan():
    scan = random_scan(shape=(9, 12))
    valid = np.ones(scan.shape, bool)
    valid[:, 6] = False
    scan = dataclasses.replace(scan, valid=valid)
    seeds = Seeds([1, 5], [2, 3], [[200, 40, 40], [40, 200, 40]])
    gray, natural = (colorize(scan, seeds, settings) for settings in (Settings(), NATURAL))
    np.testing.assert_array_equal(natural.rgb[:, 7:], gray.rgb[:, 7:])


def test_a_dark_scan_is_not_told_to_be_lightened_when_the_photo_says_how_light_it_is():
    scan = random_scan(shape=(9, 12))
    scan = dataclasses.replace(scan, reflectance=scan.reflectance**9)
    assert any("tone" in warning for warning in colorize(scan, SEEDS, Settings()).warnings)
    assert not any("tone" in warning for warning in colorize(scan, SEEDS, NATURAL).warnings)
