"""The tone: how light the result is, and nothing else; and the hint where a scan needs one."""

import json

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from small_scans import random_scan, scan_from_ranges
from test_blender_import import srgb, write_small_ptx

from benchmarks.own_colors import own_seeds
from benchmarks.real_scans import NAMES, has_truth, load
from reflcolor_addon import Colorizer, Seeds, Settings, SettingsError, colorize, evaluate, read_scans
from reflcolor_addon.color.tone import DARK_MEDIAN, LIGHT_MEDIAN, tone_to_try, toned
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.settings import PRESETS, SETTINGS
from reflcolor_addon.view import live as live_module

LUMA = np.array([0.299, 0.587, 0.114])
HINT = "the colors are dark because most of the reflectance is; try tone "
TONES = SETTINGS["tone"].low, SETTINGS["tone"].high
SPACES = [choice.value for choice in SETTINGS["color_space"].choices]
tones = st.floats(*TONES)
levels = st.integers(0, 2550).map(lambda level: level / 10)
images = arrays(np.float32, (3, 5), elements=st.just(0) | st.floats(2**-10, 255, width=32))


def seeds_of(scan, count=6, spread=30):
    """Seeds of weak colors, which every luminance but the ends of the range can show."""
    rows, cols = np.nonzero(scan.valid)
    chosen = np.linspace(0, rows.size - 1, count).astype(int)
    return Seeds(rows[chosen], cols[chosen], np.random.default_rng(3).integers(128 - spread, 128 + spread, (count, 3)))


def nearly_gray_seeds_of(scan, count=6):
    """Seeds from dark to light, the channels of each two levels apart at most."""
    seeds = seeds_of(scan, count, spread=1)
    return Seeds(seeds.rows, seeds.cols, seeds.rgb + np.linspace(-70, 70, count).astype(int)[:, None])


def dark_scan(shape=(20, 30)):
    """Linear intensities: most are small, a few are large."""
    scan = random_scan(shape=shape)
    return scan_from_ranges(scan.range, scan.reflectance**8)


@given(image=images)
def test_the_paper_s_tone_is_no_change_at_all(image):
    assert toned(image, Settings().tone).tobytes() == image.tobytes()


@given(image=images, tone=tones)
def test_black_and_white_stay_and_no_order_is_turned(image, tone):
    image[0, :2] = 0, 255
    found = toned(image, tone)
    assert found.dtype == np.float32 and found.shape == image.shape
    assert found[0, :2].tolist() == [0, 255]
    assert ((found >= 0) & (found <= 255)).all()
    assert (np.diff(found.ravel()[np.argsort(image.ravel())]) >= 0).all()


@given(image=images, tone=st.floats(1.1, 5))
def test_above_1_is_lighter_below_darker_and_they_undo_each_other(image, tone):
    assert (toned(image, tone) >= image).all()
    assert (toned(image, 1 / tone) <= image).all()
    assert toned(toned(image, tone), 1 / tone) == pytest.approx(image, abs=1e-3)


@pytest.mark.parametrize("tone", [0.19, 5.1, -1, float("nan"), "2", None, True])
def test_a_tone_out_of_range_is_refused_in_one_line_that_names_it(tone):
    with pytest.raises(SettingsError, match=r"^tone: expected a number from 0.2 to 5, found [^\n]*$"):
        Settings(tone=tone)


@pytest.mark.parametrize("preset", PRESETS)
def test_presets_leave_the_tone_alone(preset):
    assert Settings.preset(preset).tone == 1
    assert Settings.preset(preset, tone=2.0).tone == 2


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("preset", PRESETS)
@settings(max_examples=20)
@given(tone=tones)
def test_only_the_luminance_changes(space, preset, tone):
    scan = random_scan(shape=(8, 11))
    seeds = nearly_gray_seeds_of(scan)
    plain, other = (
        colorize(scan, seeds, Settings.preset(preset, color_space=space, tone=value)) for value in (1.0, tone)
    )
    assert (other.nearest_seed == plain.nearest_seed).all()
    assert other.method == plain.method and other.normalization == plain.normalization
    # The gray of a luminance is what the nearly gray colors come to, within what two levels of color can add.
    before = plain.rgb @ LUMA
    if preset != "Natural":
        luminance, _ = normalize(scan.reflectance, scan.valid)
        assert before == pytest.approx(luminance, abs=4)
        before = luminance
    assert other.rgb @ LUMA == pytest.approx(toned(before, tone), abs=4)


def test_the_chrominance_stays_where_it_can_be_shown():
    scan = random_scan(shape=(12, 15))
    scan = scan_from_ranges(scan.range, 1 + scan.reflectance)
    results = {tone: colorize(scan, seeds_of(scan), Settings(tone=tone)).rgb.astype(float) for tone in (0.7, 1.0, 2.0)}
    inside = np.all([((rgb > 0) & (rgb < 255)).all(axis=-1) for rgb in results.values()], axis=0)
    assert inside.mean() > 0.5
    for rgb in results.values():
        differences = rgb - (rgb @ LUMA)[..., None]
        expected = results[1.0] - (results[1.0] @ LUMA)[..., None]
        assert differences[inside] == pytest.approx(expected[inside], abs=1.5)


@given(tone=tones)
def test_pixels_that_no_seed_reaches_keep_the_gray_of_that_tone(tone):
    scan = random_scan(shape=(6, 9))
    valid = np.ones(scan.shape, bool)
    valid[:, 4] = False
    scan = scan_from_ranges(scan.range, scan.reflectance, valid)
    result = colorize(scan, Seeds([1], [1], [[200, 40, 40]]), Settings(tone=tone))
    luminance, _ = normalize(scan.reflectance, valid)
    assert (result.rgb[:, 5:] == np.rint(toned(luminance, tone)[:, 5:, None])).all()
    assert (result.rgb[:, 4] == 0).all()


@pytest.mark.parametrize("preset", PRESETS)
def test_another_tone_takes_no_new_paths_and_gives_the_same_bytes_as_anew(preset, monkeypatch):
    scan = random_scan(shape=(14, 17))
    colorizer = Colorizer(scan)
    first = colorizer.colorize(seeds_of(scan), Settings.preset(preset))
    kept = first.rgb.tobytes(), first.confidence.tobytes(), first.nearest_seed.tobytes()
    with monkeypatch.context() as patched:
        patched.setattr(colorizer._spreader, "_spread_from", None)
        again = colorizer.colorize(seeds_of(scan), Settings.preset(preset, tone=2.5))
    assert (first.rgb.tobytes(), first.confidence.tobytes(), first.nearest_seed.tobytes()) == kept
    anew = colorize(scan, seeds_of(scan), Settings.preset(preset, tone=2.5))
    assert again.rgb.tobytes() == anew.rgb.tobytes() != first.rgb.tobytes()
    assert again.confidence.tobytes() == anew.confidence.tobytes()
    other = Settings.preset(preset, tone=2.5, alpha=2.0)
    assert (
        colorizer.colorize(seeds_of(scan), other).rgb.tobytes() == colorize(scan, seeds_of(scan), other).rgb.tobytes()
    )


@given(median=levels, tone=tones)
def test_what_is_to_be_tried_is_tried_once(median, tone):
    found = tone_to_try(median, tone)
    if found is None:
        assert toned(median, tone) >= DARK_MEDIAN or median == 0 or tone >= tone_to_try(median, TONES[0])
    else:
        assert toned(median, tone) < DARK_MEDIAN and tone < found <= TONES[1]
        # Rounded to one decimal.
        assert found == TONES[1] or toned(median, found - 0.051) <= LIGHT_MEDIAN <= toned(median, found + 0.051)
        assert tone_to_try(median, found) is None


def test_dark_colors_are_told_once_with_a_tone_that_helps():
    scan = dark_scan()
    (told,) = colorize(scan, seeds_of(scan)).warnings
    assert told.startswith(HINT)
    lighter = colorize(scan, seeds_of(scan), Settings(tone=float(told.removeprefix(HINT))))
    assert lighter.warnings == ()
    assert np.median(lighter.rgb) == pytest.approx(LIGHT_MEDIAN, abs=10)


def test_of_a_scan_that_is_flat_nothing_is_said():
    scan = scan_from_ranges(np.full((5, 6), 2.0), np.full((5, 6), 7.0))
    assert colorize(scan, seeds_of(scan)).warnings == ()


@pytest.fixture(scope="module")
def real_scans(data_dir):
    return {name: load(name, data_dir) for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_of_the_real_scans_only_the_infrared_camera_s_is_called_dark(real_scans, name):
    scan = real_scans[name]
    hints = [line for line in colorize(scan, own_seeds(scan).chosen([0, 1])).warnings if line.startswith(HINT)]
    assert hints == ([HINT + "4.1"] if name == "k4a" else [])


@pytest.mark.slow
def test_the_infrared_camera_s_colors_come_nearer_to_the_truth_with_the_tone_to_try(real_scans):
    scan = real_scans["k4a"]
    colorizer, known = Colorizer(scan), has_truth(scan)
    plain, lighter = (
        evaluate(colorizer.colorize(own_seeds(scan), Settings(tone=tone)).rgb, scan.color, known) for tone in (1.0, 4.1)
    )
    assert lighter["as_is"]["ciede2000_mean"] < 0.6 * plain["as_is"]["ciede2000_mean"]
    assert lighter["color_alone"]["ciede2000_mean"] <= plain["color_alone"]["ciede2000_mean"]


@pytest.mark.parametrize("tone", [0.5, 2.0])
def test_color_alone_does_not_ask_for_the_luminance(tone):
    scan = random_scan(shape=(12, 15))
    scan = scan_from_ranges(scan.range, 1 + scan.reflectance)
    seeds = seeds_of(scan, spread=10)
    truth = colorize(scan, seeds.chosen([0, 1, 2]), Settings(color_space="yuv")).rgb
    rgbs = [colorize(scan, seeds, Settings(tone=value)).rgb for value in (1.0, tone)]
    shown = np.all([((rgb > 0) & (rgb < 255)).all(axis=-1) for rgb in (*rgbs, truth)], axis=0)
    plain, other = (evaluate(rgb, truth, shown)["color_alone"]["ciede2000_mean"] for rgb in rgbs)
    assert other == pytest.approx(plain, abs=0.2)


def test_the_preview_has_the_tone_coarsely_in_full_and_without_seeds(monkeypatch):
    monkeypatch.setattr(live_module, "COARSE_PIXELS", 500)
    scan = dark_scan((60, 90))
    luminance, _ = normalize(scan.reflectance, scan.valid)
    live, settings = live_module._LiveScan(scan), Settings(tone=3.0)
    seeds = seeds_of(scan, spread=3)
    full = live.full(seeds, settings, None, lambda: False).rgb
    for rgb in (full, live.coarse(seeds, settings, None, None), live.coarse(seeds.chosen([]), settings, None, None)):
        assert rgb @ LUMA == pytest.approx(toned(luminance, 3.0), abs=6)
    assert full.tobytes() == colorize(scan, seeds, settings).rgb.tobytes()


@pytest.fixture
def dark_file(tmp_path):
    return write_small_ptx(tmp_path / "wall.ptx", dark_scan((6, 10)))


def test_on_the_command_line_it_is_an_option_reported_and_hinted_at(run_cli, dark_file, tmp_path):
    seeds_of(read_scans(dark_file)[0]).save(tmp_path / "wall.seeds.json")
    line = ("colorize", dark_file, "--seeds", tmp_path / "wall.seeds.json", "-o", tmp_path / "wall.png")
    line += ("--preset", "Paper")
    status, _, err = run_cli(*line)
    assert status == 0 and HINT in err
    dark = cv2.imread(str(tmp_path / "wall.png"))
    status, _, err = run_cli(*line, "--tone", "3", "--report", tmp_path / "wall.json")
    assert status == 0 and HINT not in err
    assert json.loads((tmp_path / "wall.json").read_text())["settings"]["tone"] == 3
    assert cv2.imread(str(tmp_path / "wall.png")).mean() > dark.mean() + 20
    status, _, err = run_cli(*line, "--tone", "9")
    assert status == 2 and "--tone: expected a number from 0.2 to 5, found 9" in err


@pytest.fixture
def seeded(blender, dark_file):
    """bpy with the dark scan and its seeds, and those seeds."""
    blender.ops.reflcolor.import_scan(filepath=str(dark_file))
    seeds = seeds_of(read_scans(dark_file)[0])
    for row, col, color in zip(seeds.rows, seeds.cols, seeds.rgb, strict=True):
        blender.ops.reflcolor.add_seed(row=int(row), col=int(col), color=[value / 255 for value in color])
    return blender, seeds


def test_in_blender_the_scene_s_tone_counts_and_the_gray_before_stays(seeded, dark_file):
    bpy, seeds = seeded
    obj = bpy.context.active_object
    gray = srgb(obj, "Reflectance_Gray").copy()
    bpy.ops.reflcolor.apply_preset(preset="Paper")
    bpy.ops.reflcolor.colorize()
    assert any(notice.warning and HINT in notice.text for notice in obj.reflcolor.notices)
    bpy.context.scene.reflcolor.tone = 4.0
    bpy.ops.reflcolor.colorize()
    assert not any(notice.warning for notice in obj.reflcolor.notices)
    expected = colorize(read_scans(dark_file)[0], seeds, Settings(tone=4.0, nearest="auto")).rgb.reshape(-1, 3)
    assert np.abs(srgb(obj, "Colorized").astype(int) - expected).max() <= 1
    assert (srgb(obj, "Reflectance_Gray") == gray).all()


def test_in_blender_a_preset_leaves_the_tone_alone(blender):
    settings = blender.context.scene.reflcolor
    settings.tone = 2.0
    for preset in PRESETS:
        blender.ops.reflcolor.apply_preset(preset=preset)
        assert settings.tone == 2.0
