"""Colors while seeds are picked: the same as those computed at once, coarse ones first, the latest wish only."""

import threading
import time

import numpy as np
import pytest
from small_scans import scan_from_ranges

from reflcolor_addon import Seeds, Settings, colorize
from reflcolor_addon.errors import SeedsError
from reflcolor_addon.view import live as live_module
from reflcolor_addon.view.live import LiveColorizer


def _scan(shape, seed=0):
    rng = np.random.default_rng(seed)
    smooth = np.add.outer(np.linspace(0, 3, shape[0]), np.linspace(0, 5, shape[1]))
    return scan_from_ranges(4 + smooth / 4, np.sin(smooth) + 0.02 * rng.normal(size=shape), np.ones(shape, bool))


SEEDS = Seeds([3, 20, 40], [5, 60, 20], [[200, 40, 40], [40, 60, 200], [90, 180, 60]])


@pytest.fixture
def started():
    """A function that starts a LiveColorizer, which is stopped at the end."""
    running = []

    def start(*args, **options):
        running.append(LiveColorizer(*args, **options))
        return running[-1]

    yield start
    for live in running:
        live.stop()
    assert not [thread for thread in threading.enumerate() if thread.name == "reflcolor live"]


def _results(live, number, until=lambda result: result.colorization is not None or result.error is not None):
    """What is delivered for a wish, up to the last."""
    found, limit = [], time.monotonic() + 30
    while time.monotonic() < limit:
        result = live.take()
        if result is not None:
            found.append(result)
            if result.number == number and until(result):
                return found
        time.sleep(0.001)
    raise AssertionError(f"no result for wish {number}")


def test_the_full_result_is_that_of_colorize(started):
    scan = _scan((50, 80))
    live = started(lambda: scan)
    final = _results(live, live.wish(SEEDS, Settings()))[-1]
    np.testing.assert_array_equal(final.rgb, colorize(scan, SEEDS, Settings()).rgb)


def test_a_large_scan_shows_a_coarse_result_first_that_is_near(started, monkeypatch):
    monkeypatch.setattr(live_module, "COARSE_PIXELS", 500)
    scan = _scan((60, 90))
    arrived = []
    live = started(lambda: scan, arrived=lambda: arrived.append(live.take()))
    live.wish(SEEDS, Settings())
    limit = time.monotonic() + 30
    while (len(arrived) < 2 or arrived[-1].colorization is None) and time.monotonic() < limit:
        time.sleep(0.001)
    coarse, full = arrived
    assert coarse.colorization is None and full.colorization is not None
    assert coarse.rgb.shape == full.rgb.shape
    assert np.abs(coarse.rgb.astype(int) - full.rgb).mean() < 12


def test_a_wish_makes_the_ones_before_it_void(started):
    scan = _scan((120, 160))
    gate = threading.Event()

    def read():
        gate.wait(10)
        return scan

    live = started(read)
    for red in range(0, 200, 20):
        number = live.wish(Seeds([3], [5], [[red, 40, 40]]), Settings())
    gate.set()
    found = _results(live, number)
    assert {result.number for result in found} <= {1, number}
    assert found[-1].rgb is not None and live.latest == number


def test_the_coarse_colors_are_as_light_as_the_full_ones(started):
    scan = _scan((240, 320))
    live = started(lambda: scan)
    coarse, full = _results(live, live.wish(SEEDS, Settings.preset("Natural")))
    assert coarse.colorization is None and full.colorization is not None
    assert np.abs(coarse.rgb.astype(int) - full.rgb).mean() < 6


def test_without_seeds_the_scan_is_gray(started):
    scan = _scan((20, 30))
    live = started(lambda: scan)
    number = live.wish(Seeds([], [], []), Settings())
    (result,) = _results(live, number, until=lambda result: result.rgb is not None)
    assert (result.rgb.min(axis=-1) == result.rgb.max(axis=-1)).all()


def test_bad_input_arrives_as_its_error_and_the_next_wish_is_served(started):
    scan = _scan((20, 30))
    live = started(lambda: scan)
    result = _results(live, live.wish(Seeds([50], [0], [[1, 2, 3]]), Settings()))[-1]
    assert isinstance(result.error, SeedsError)
    assert _results(live, live.wish(Seeds([5], [5], [[1, 2, 3]]), Settings()))[-1].error is None


def test_stopping_does_not_wait_for_a_long_colorization():
    scan = _scan((300, 400))
    live = LiveColorizer(lambda: scan)
    rng = np.random.default_rng(1)
    count = 300
    live.wish(
        Seeds(rng.integers(0, 300, count), rng.integers(0, 400, count), rng.integers(0, 255, (count, 3))),
        Settings(nearest=None),
    )
    time.sleep(0.2)
    start = time.monotonic()
    live.stop()
    assert time.monotonic() - start < 1.0


def test_what_showing_needs_is_prepared_in_the_thread(started):
    scan, threads = _scan((20, 30)), set()

    def prepare(rgb):
        threads.add(threading.current_thread().name)
        return rgb.sum()

    live = started(lambda: scan, prepare=prepare)
    result = _results(live, live.wish(SEEDS.chosen([0]), Settings()))[-1]
    assert result.prepared == result.rgb.sum() and threads == {"reflcolor live"}
