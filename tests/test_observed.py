"""Colors that photos saw, joined with those that seeds tell."""

from dataclasses import replace

import numpy as np
import pytest
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import Cancelled, Colorizer, ReflcolorError, Seeds, Settings, colorize
from reflcolor_addon.color.observed import Observed
from reflcolor_addon.report.provenance import outline
from reflcolor_addon.report.report import build_report, scan_entry
from reflcolor_addon.view import live as live_module
from reflcolor_addon.view.live import LiveColorizer

# Everything holds with the native kernel and without.
pytestmark = pytest.mark.usefixtures("engine")

NATURAL = Settings.preset("Natural")
SHAPE = (40, 60)


def flat_scan(shape=SHAPE):
    """A wall of hardly any texture, with a black and a white stripe at its sides."""
    reflectance = 0.5 + 0.002 * np.random.default_rng(1).normal(size=shape)
    reflectance[:, :3], reflectance[:, -3:] = 0, 1
    return scan_from_ranges(np.broadcast_to(np.linspace(4, 5, shape[1]), shape), reflectance)


def observed_left(shape=SHAPE, color=(150, 110, 70), photo=0):
    """A photo that saw the left half."""
    weight = np.zeros(shape, np.float32)
    weight[:, : shape[1] // 2] = 1
    rgb = np.where(weight[..., None] > 0, np.array(color), 0).astype(np.uint8)
    return Observed(rgb, weight, np.where(weight > 0, photo, -1).astype(np.int16))


def found(rows, cols, rgb):
    """Seeds that a photo's camera found."""
    return Seeds(rows, cols, rgb, reason=["pose"] * len(rows))


def test_every_pixel_that_was_seen_has_its_photo_s_color():
    scan = random_scan(shape=SHAPE)
    rng = np.random.default_rng(0)
    observed = observed_left()
    observed = replace(observed, rgb=rng.integers(20, 230, (*SHAPE, 3)).astype(np.uint8))
    result = colorize(scan, found([5], [5], [[90, 60, 40]]), NATURAL, observed)
    seen = observed.seen
    # In its last few pixels it fades into what is inferred.
    inner = np.s_[:, : SHAPE[1] // 2 - 4]
    assert np.abs(result.rgb[inner].astype(int) - observed.rgb[inner]).max() <= 1
    assert (result.observed[inner] == 1).all() and (result.observed[seen] > 0).all() and (result.photo[seen] == 0).all()
    assert (result.observed[~seen] == 0).all() and (result.photo[~seen] == -1).all()
    assert (result.confidence[seen] > 0.99).all()


@pytest.mark.parametrize("preset", ["Paper", "Enhanced"])
def test_other_presets_take_nothing_of_it(preset):
    scan, seeds = random_scan(shape=SHAPE), found([5, 9], [5, 50], [[90, 60, 40], [20, 90, 200]])
    settings = Settings.preset(preset)
    with_it, without = colorize(scan, seeds, settings, observed_left()), colorize(scan, seeds, settings)
    assert with_it.rgb.tobytes() == without.rgb.tobytes()
    assert with_it.confidence.tobytes() == without.confidence.tobytes()
    assert not with_it.observed.any() and (with_it.photo == -1).all()


def test_no_edge_shows_where_the_photo_ends():
    # The seeds are brighter and redder than what the photo shows of the same wall.
    seeds = found([20, 20], [15, 55], [[190, 120, 80], [190, 120, 80]])
    result = colorize(flat_scan(), seeds, NATURAL, observed_left())
    steps = np.abs(np.diff(result.rgb.astype(int), axis=1)).max(axis=-1)[2:-2]
    # Without joining them it is 40.
    assert steps[:, SHAPE[1] // 2 - 1].max() <= 5
    assert np.median(steps[:, SHAPE[1] // 2 - 1]) <= 1
    # Farther away it is the seeds' color again.
    assert result.rgb[20, -5, 0] > result.rgb[20, SHAPE[1] // 2, 0] + 4


def test_beside_the_border_the_photo_s_colors_go_on_without_what_seeds_differ_by_from_pixel_to_pixel():
    rng = np.random.default_rng(2)
    scan = flat_scan()
    scan = replace(scan, reflectance=(scan.reflectance + 0.05 * rng.normal(size=SHAPE)).astype(np.float32))
    seeds = found(rng.integers(0, 40, 30), rng.integers(0, 60, 30), rng.integers(120, 180, (30, 3)))
    result = colorize(scan, seeds, NATURAL, observed_left())
    steps = np.abs(np.diff(result.rgb.astype(int), axis=1)).max(axis=-1).mean(axis=0)
    border = SHAPE[1] // 2
    assert steps[border - 4 : border].max() < 3 < steps[border + 8 : -4].max()


def test_beside_the_border_chance_is_evened_out_and_edges_stay():
    rng = np.random.default_rng(3)
    scan, upper = flat_scan(), np.arange(SHAPE[0])[:, None, None] < 20
    scan = replace(scan, reflectance=np.where(upper[..., 0], scan.reflectance, 0.2).astype(np.float32))
    observed = observed_left()
    noisy = np.where(upper, (150, 110, 70), (60, 60, 160)) + rng.normal(0, 8, (*SHAPE, 1))
    observed = replace(observed, rgb=np.where(observed.seen[..., None], noisy, 0).astype(np.uint8))
    result = colorize(scan, found([5, 35], [5, 5], [[150, 110, 70], [60, 60, 160]]), NATURAL, observed)
    beside = result.rgb[:, SHAPE[1] // 2 + 1].astype(float)
    assert beside[2:17].std(axis=0).max() < 3 < 5 < observed.rgb[2:17, 10].std(axis=0).max()
    assert (beside[18, 0] - beside[21, 0]) > 70


def test_what_was_seen_badly_counts_by_its_weight():
    observed = observed_left()
    weak = replace(observed, weight=(observed.weight * 0.5).astype(np.float32))
    seeds = found([20], [55], [[190, 120, 80]])
    alone, half = (colorize(flat_scan(), seeds, NATURAL, each).rgb[10, 5].astype(float) for each in (None, weak))
    np.testing.assert_allclose(half, (alone + (150, 110, 70)) / 2, atol=2)


def test_what_is_doubtful_but_agrees_with_its_surface_has_the_photo_s_color_alone_and_is_not_carried_on():
    observed, seeds = observed_left(), found([20], [55], [[190, 120, 80]])
    doubtful = replace(observed, weight=(observed.weight * 0.75).astype(np.float32))
    result = colorize(flat_scan(), seeds, NATURAL, doubtful)
    assert np.abs(result.rgb[10, 5].astype(int) - (150, 110, 70)).max() <= 1
    alone = colorize(flat_scan(), seeds, NATURAL)
    np.testing.assert_array_equal(result.rgb[:, 40:], alone.rgb[:, 40:])
    assert 0.7 < result.confidence[10, 5] < 1


@pytest.mark.parametrize("how", ["picked", "locked"])
def test_a_person_s_seed_outranks_a_photo(how):
    scan, observed, red = flat_scan((160, 240)), observed_left((160, 240)), [[220, 30, 30]]
    seeds = Seeds([80], [40], red) if how == "picked" else replace(found([80], [40], red), locked=[True])
    result = colorize(scan, seeds, NATURAL, observed)
    np.testing.assert_array_equal(result.rgb[80, 40], red[0])
    assert result.observed[80, 40] == 0 and result.photo[80, 40] == -1
    # Beside it, too, but not all over the photo.
    assert np.median(result.rgb[79:82, 39:42, 0]) > 160
    assert result.observed[80, 80] > 0.9
    found_one = colorize(scan, found([80], [40], red), NATURAL, observed)
    assert np.abs(found_one.rgb[80, 40].astype(int) - (150, 110, 70)).max() <= 1


def test_pixels_that_no_seed_reaches_take_the_color_of_what_was_seen_beside_them():
    valid = np.ones(SHAPE, bool)
    valid[:, 20] = False
    scan = flat_scan()
    scan = replace(scan, valid=valid, reflectance=np.where(valid, scan.reflectance, 0).astype(np.float32))
    scan = replace(scan, points=np.where(valid[..., None], scan.points, 0))
    # The only seed is left of the gap; the photo saw beyond it, too.
    observed = observed_left()
    observed = replace(observed, weight=np.where(valid, observed.weight, 0).astype(np.float32))
    result = colorize(scan, found([20], [5], [[190, 120, 80]]), NATURAL, observed)
    assert np.abs(result.rgb[10, 55].astype(int) - (150, 110, 70)).max() <= 2
    assert not [warning for warning in result.warnings if "cut off" in warning]


def test_a_colorizer_gives_the_same_again_and_follows_what_changes():
    scan, observed = random_scan(shape=SHAPE), observed_left()
    seeds = found([5, 9], [5, 50], [[90, 60, 40], [20, 90, 200]])
    colorizer = Colorizer(scan, NATURAL)
    for light, seen in ((1.0, observed), (1.0, None), (0.0, observed), (1.0, observed_left(color=(10, 200, 10)))):
        settings = replace(NATURAL, light=light)
        ours = colorizer.colorize(seeds, settings, seen)
        assert ours.rgb.tobytes() == colorize(scan, seeds, settings, seen).rgb.tobytes()


def test_joining_can_be_cancelled():
    scan, seeds = random_scan(shape=SHAPE), found([5], [5], [[90, 60, 40]])
    colorizer = Colorizer(scan, NATURAL)
    spread, _ = colorizer.spread(seeds)
    with pytest.raises(Cancelled):
        colorizer.joined(spread, seeds, observed_left(), cancelled=lambda: True)


def test_colors_of_another_scan_are_refused():
    with pytest.raises(ReflcolorError, match="expected observed colors"):
        colorize(random_scan(), found([2], [2], [[1, 2, 3]]), NATURAL, observed_left())


def test_the_report_and_its_outline_count_what_each_photo_saw():
    scan, seeds = random_scan(shape=SHAPE), found([5], [5], [[90, 60, 40]])
    result = colorize(scan, seeds, NATURAL, observed_left(photo=1))
    photos = [{"name": name, "verified": name == "b.jpg"} for name in ("a.jpg", "b.jpg")]
    report = build_report(scan_entry(scan, 1), result, NATURAL, given_seeds=seeds, inputs=[], photos=photos)
    assert [photo["observed"] for photo in report["photos"]] == [0, SHAPE[0] * SHAPE[1] // 2]
    assert report["result"]["observed"] == SHAPE[0] * SHAPE[1] // 2
    told = outline(report)
    assert told.observed == (("b.jpg", SHAPE[0] * SHAPE[1] // 2),)
    assert told.inferred == SHAPE[0] * SHAPE[1] // 2


def test_the_preview_shows_what_photos_saw_coarse_and_in_full(monkeypatch):
    monkeypatch.setattr(live_module, "COARSE_PIXELS", 500)
    arrived, scan, observed = [], random_scan(shape=SHAPE), observed_left()
    live = LiveColorizer(lambda: scan, arrived=lambda: arrived.append(live.take()))
    try:
        live.wish(found([5], [50], [[90, 60, 40]]), NATURAL, observed)
        for _ in range(10_000):
            if arrived and arrived[-1].colorization is not None:
                break
            live._thread.join(0.002)
    finally:
        live.stop()
    coarse, full = arrived
    inside = np.s_[:, : SHAPE[1] // 2 - 14]
    for result in (coarse, full):
        assert np.abs(result.rgb[inside].astype(int) - observed.rgb[inside]).max() <= 1
