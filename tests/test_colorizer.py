"""The Colorizer, which keeps what it computed: the same bytes as colorizing at once, for less work."""

import itertools

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Cancelled, Colorizer, Seeds, Settings, colorize
from reflcolor_addon.geodesic.engines import engine_for
from reflcolor_addon.geodesic.graph import PixelGraph

# Everything holds with the native kernel and without.
pytestmark = pytest.mark.usefixtures("engine")


def test_colorizing_anew_after_any_change_gives_the_bytes_of_colorizing_at_once():
    scan = random_scan(shape=(20, 30))
    rng = np.random.default_rng(0)
    rows, cols = rng.integers(0, 20, 12).tolist(), rng.integers(0, 30, 12).tolist()
    colors = rng.integers(0, 256, (12, 3)).tolist()
    colorizer = Colorizer(scan)
    for change in (
        lambda: None,
        lambda: (rows.append(3), cols.append(4), colors.append([9, 200, 30])),
        lambda: (rows.pop(2), cols.pop(2), colors.pop(2)),
        lambda: rows.__setitem__(5, 19),
        lambda: colors.__setitem__(0, [255, 0, 0]),
        lambda: (rows.append(3), cols.append(4), colors.append([0, 0, 255])),
    ):
        change()
        seeds = Seeds(rows, cols, np.array(colors))
        for settings in (
            Settings(),
            Settings(alpha=2.0),
            Settings(beta=0.0),
            Settings(color_space="cielab"),
            Settings(nearest=3),
            Settings(nearest=20),
            Settings.preset("Natural"),
        ):
            anew, at_once = colorizer.colorize(seeds, settings), colorize(scan, seeds, settings)
            assert anew.rgb.tobytes() == at_once.rgb.tobytes()
            assert anew.confidence.tobytes() == at_once.confidence.tobytes()
            assert anew.nearest_seed.tobytes() == at_once.nearest_seed.tobytes()


def test_a_change_of_one_seed_computes_one_field_at_most(monkeypatch):
    scan = random_scan(shape=(20, 30))
    colorizer, computed = Colorizer(scan), []
    kind = type(
        engine_for(PixelGraph(luminance=np.zeros((1, 1)), range_image=np.zeros((1, 1)), valid=scan.valid[:1, :1]))
    )
    field = kind.field
    monkeypatch.setattr(
        kind, "field", lambda self, pixel, control: computed.append(pixel) or field(self, pixel, control)
    )

    def fields_for(rows, cols, colors):
        computed.clear()
        colorizer.colorize(Seeds(rows, cols, np.array(colors)))
        return len(computed)

    colors = [[9, 9, 9], [99, 0, 0], [0, 99, 0]]
    assert fields_for([1, 2, 3], [4, 5, 6], colors) == 3
    assert fields_for([1, 2, 3, 4], [4, 5, 6, 7], [*colors, [5, 5, 5]]) == 1
    assert fields_for([1, 9, 3, 4], [4, 5, 6, 7], [*colors, [5, 5, 5]]) == 1
    assert fields_for([1, 9, 3, 4], [4, 5, 6, 7], [*colors, [50, 5, 5]]) == 0
    assert fields_for([1, 3, 4], [4, 6, 7], [*colors[:2], [50, 5, 5]]) == 0


def test_a_cancelled_change_leaves_nothing_of_it_behind():
    scan = random_scan(shape=(20, 30))
    rng = np.random.default_rng(0)
    rows, cols, colors = rng.integers(0, 20, 12), rng.integers(0, 30, 12), rng.integers(0, 256, (12, 3))
    colorizer = Colorizer(scan)
    colorizer.colorize(Seeds(rows[:9], cols[:9], colors[:9]))
    asked = itertools.count()
    with pytest.raises(Cancelled):
        colorizer.colorize(Seeds(rows, cols, colors), cancelled=lambda: next(asked) > 2)
    seeds = Seeds(rows[1:], cols[1:], colors[1:])
    assert colorizer.colorize(seeds).rgb.tobytes() == colorize(scan, seeds).rgb.tobytes()


def test_fields_are_held_within_the_limit_and_the_oldest_goes_first():
    scan = random_scan(shape=(20, 30))
    rows, cols = np.arange(10), np.arange(10)
    colors = np.random.default_rng(0).integers(0, 256, (10, 3))
    colorizer = Colorizer(scan, memory=5000)
    assert colorizer.held_bytes == 0
    result = colorizer.colorize(Seeds(rows, cols, colors))
    assert 0 < colorizer.held_bytes <= 5000
    # Recoloring the first seed needs all fields again, most of which were dropped.
    colors[0] = 7
    result = colorizer.colorize(Seeds(rows, cols, colors))
    assert result.rgb.tobytes() == colorize(scan, Seeds(rows, cols, colors)).rgb.tobytes()


def test_the_number_of_threads_changes_no_bit():
    scan = random_scan(shape=(40, 50))
    rng = np.random.default_rng(1)
    seeds = Seeds(rng.integers(0, 40, 9), rng.integers(0, 50, 9), rng.integers(0, 256, (9, 3)))
    results = {Colorizer(scan, threads=threads).colorize(seeds).rgb.tobytes() for threads in (1, 2, 5)}
    assert len(results) == 1
