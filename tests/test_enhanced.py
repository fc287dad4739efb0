"""The preset "Enhanced", and what it leaves as it was."""

import dataclasses

import numpy as np
import pytest
from small_scans import random_scan

from benchmarks.experiments.cases import EXAMPLES
from benchmarks.quality.scenes import load, perfect_seeds
from reflcolor_addon import Cancelled, Colorizer, Seeds, Settings, colorize
from reflcolor_addon.color.evaluation import error_map, evaluate, with_luminance_of
from reflcolor_addon.settings import PRESETS

ENHANCED = Settings.preset("Enhanced")


@pytest.fixture(scope="module")
def doria(data_dir):
    scan, known = load("doria")
    return scan, known, perfect_seeds(scan, known, 100)


def seeds_of(scan, count=12):
    rows, cols = np.nonzero(scan.valid)
    chosen = np.linspace(0, rows.size - 1, count).astype(int)
    colors = np.random.default_rng(3).integers(40, 200, (count, 3))
    return Seeds(rows[chosen], cols[chosen], colors)


def test_on_a_real_scan_it_is_nearer_to_the_truth_than_the_paper(doria):
    scan, known, seeds = doria
    ours, paper = (
        evaluate(colorize(scan, seeds, Settings.preset(name)).rgb, scan.color, known)["color_alone"]
        for name in ("Enhanced", "Paper")
    )
    assert ours["ciede2000_mean"] < 0.92 * paper["ciede2000_mean"]
    assert ours["chrominance_psnr_db"] > paper["chrominance_psnr_db"]


@pytest.mark.parametrize("preset", ["Paper", "Enhanced", "Natural"])
def test_pixels_of_higher_confidence_have_less_error(doria, preset):
    scan, known, seeds = doria
    settings = Settings.preset(preset)
    result = colorize(scan, seeds, settings)
    if settings.light == 0:
        # It is not sure of the luminance, which is the reflectance's.
        result = dataclasses.replace(result, rgb=with_luminance_of(result.rgb, scan.color))
    errors, confidence = error_map(result.rgb, scan.color, known)[known], result.confidence[known]
    sure = confidence > np.median(confidence)
    assert errors[sure].mean() < 0.8 * errors[~sure].mean()
    assert ((confidence >= 0) & (confidence <= 1)).all()


def test_the_paper_is_not_touched_by_what_is_added():
    scan = random_scan(shape=(12, 15))
    seeds = seeds_of(scan)
    paper, bare = colorize(scan, seeds), colorize(scan, seeds, Settings(smoothing=0.0, kriging=0.0))
    assert paper.rgb.tobytes() == bare.rgb.tobytes()
    assert "kriging" not in paper.method


@pytest.mark.parametrize("change", [{}, {"nearest": None}, {"nearest": "auto"}, {"color_space": "cielab"}], ids=str)
def test_the_same_input_gives_the_same_bytes_anew_or_at_once_and_with_any_number_of_threads(change):
    scan = random_scan(shape=(14, 17))
    seeds = seeds_of(scan)
    settings = dataclasses.replace(ENHANCED, **change)
    colorizer = Colorizer(scan, Settings(), threads=3)
    colorizer.colorize(seeds)
    results = [colorize(scan, seeds, settings), colorizer.colorize(seeds, settings)]
    results.append(Colorizer(scan, settings, threads=1).colorize(seeds))
    assert len({result.rgb.tobytes() for result in results}) == 1
    assert len({result.confidence.tobytes() for result in results}) == 1


def test_seeds_of_a_person_give_the_same_bytes_anew_or_at_once_and_with_any_number_of_threads(monkeypatch):
    scan = random_scan(shape=(14, 17))
    seeds = seeds_of(scan)
    evenly = colorize(scan, seeds, ENHANCED)
    monkeypatch.setattr("reflcolor_addon.color.spreader.picked_by_a_person", lambda *_: 0.7)
    colorizer = Colorizer(scan, threads=3)
    colorizer.colorize(seeds)
    results = [colorize(scan, seeds, ENHANCED), *(colorizer.colorize(seeds, ENHANCED) for _ in range(2))]
    results.append(Colorizer(scan, ENHANCED, threads=1).colorize(seeds))
    assert len({result.rgb.tobytes() for result in results}) == 1
    assert results[0].rgb.tobytes() != evenly.rgb.tobytes()


def test_seeds_of_the_program_s_own_are_no_person_s_however_they_look(monkeypatch):
    scan = random_scan(shape=(14, 17))
    seeds = seeds_of(scan)
    found = dataclasses.replace(seeds, reason=("pose",) * len(seeds))
    evenly = colorize(scan, found, ENHANCED).rgb
    monkeypatch.setattr("reflcolor_addon.color.spreader.picked_by_a_person", lambda *_: 0.7)
    colorizer = Colorizer(scan, ENHANCED)
    np.testing.assert_array_equal(colorizer.colorize(found).rgb, evenly)
    locked = dataclasses.replace(found, locked=np.ones(len(found), bool))
    assert (colorizer.colorize(locked).rgb != evenly).any()


def test_with_seeds_picked_by_hand_no_preset_is_farther_from_the_truth_than_the_paper():
    scan, known = load("cones")
    folder = EXAMPLES / "cones"
    seeds = Seeds.load(folder / "cones.seeds.json", [folder / "photo.jpg"])
    errors = {}
    for name in PRESETS:
        rgb = with_luminance_of(colorize(scan, seeds, Settings.preset(name)).rgb, scan.color)
        errors[name] = error_map(rgb, scan.color, known)[known].mean()
    assert errors["Natural"] < errors["Enhanced"] < 0.95 * errors["Paper"]


def test_with_all_seeds_as_nearest_ones_it_is_the_same_as_with_all():
    scan = random_scan(shape=(14, 17))
    seeds = seeds_of(scan)
    every, nearest = (colorize(scan, seeds, dataclasses.replace(ENHANCED, nearest=n)) for n in (None, len(seeds)))
    assert every.method["kriging"] == nearest.method["kriging"]
    assert np.abs(every.rgb.astype(int) - nearest.rgb).max() <= 1


def test_pixels_cut_off_from_every_seed_keep_their_gray():
    scan = random_scan(shape=(9, 12))
    valid = np.ones(scan.shape, bool)
    valid[:, 6] = False
    scan = dataclasses.replace(scan, valid=valid)
    result = colorize(scan, Seeds([1, 5], [2, 3], [[200, 40, 40], [40, 200, 40]]), ENHANCED)
    assert (result.rgb[:, 7:] == result.rgb[:, 7:, :1]).all()
    assert (result.confidence[:, 7:] == 0).all()
    assert (result.confidence[:, :6] > 0).all()


def test_one_seed_colors_everything_it_reaches():
    scan = random_scan(shape=(6, 7))
    result = colorize(scan, Seeds([3], [3], [[200, 60, 40]]), ENHANCED)
    assert (result.nearest_seed[scan.valid] == 0).all()
    assert np.isfinite(result.confidence).all()


def test_more_seeds_than_kriging_takes_are_told_and_blended_without_it(monkeypatch):
    monkeypatch.setattr("reflcolor_addon.color.spreader.MAX_SEEDS", 5)
    scan = random_scan(shape=(9, 12))
    result = colorize(scan, seeds_of(scan), ENHANCED)
    assert "kriging is left out: it takes 5 seeds at most, found 12" in result.warnings
    without = colorize(scan, seeds_of(scan), dataclasses.replace(ENHANCED, kriging=0.0))
    assert result.rgb.tobytes() == without.rgb.tobytes()


def test_progress_grows_from_0_to_1_and_it_can_be_cancelled_while_kriging():
    scan, told = random_scan(shape=(14, 17)), []
    colorize(scan, seeds_of(scan), ENHANCED, progress=lambda fraction, text: told.append((fraction, text)))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)
    seen = []
    with pytest.raises(Cancelled):
        colorize(
            scan,
            seeds_of(scan),
            ENHANCED,
            progress=lambda fraction, text: seen.append(text),
            cancelled=lambda: "Estimating by kriging" in seen,
        )
    assert seen[-1] == "Estimating by kriging"
