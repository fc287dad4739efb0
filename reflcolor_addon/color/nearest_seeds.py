"""Eq. 1 over the nearest seeds of every pixel, and how many they are where that is left to the program."""

import numpy as np

from ..files.memory import require_memory
from ..geodesic.blending import weighted_mean
from ..geodesic.exact import done_apart
from ..messages import Message
from . import colorspaces

# All seeds up to this many pixels times seeds, about 2 s on two threads. A fixed number, not a measured time: the same
# input must give the same result everywhere.
EXACT_PIXEL_SEEDS = 1.5e8
NUMBERS = (8, 16, 32)
"""Otherwise the first of these that suffices, or the last."""
# A number of seeds is enough if half of them would have given 95 of 100 pixels the same color within one 8-bit level.
_ENOUGH_PERCENTILE, _ENOUGH_LEVELS = 95, 1.0
# Number of pixels at which this is checked.
_SAMPLE = 50_000
_GOLDEN = 0.6180339887498949


class HeldLists:
    """The lists of nearest seeds that were found last.

    Parameters
    ----------
    limit : int
        Bytes that they may take; larger ones are not kept.
    growing : bool
        Whether seeds that come behind the known ones are added to their lists. That is quick, but which of several
        equally far seeds is listed last then depends on what was there before.
    """

    def __init__(self, limit, *, growing):
        self._limit, self._growing = limit, growing
        self.clear()

    @property
    def nbytes(self):
        """Bytes that they take now."""
        return 0 if self._lists is None else self._lists.nbytes

    def clear(self):
        """Drop them."""
        self._lists, self._pixels, self._k = None, None, 0

    def places(self, number, seeds):
        """Return how long lists are to be, of ``number`` nearest of so many seeds: with room for more, if they grow."""
        return min(number, max(seeds, NUMBERS[0]) if self._growing else seeds)

    def take(self, pixels, k):
        """Return lists of k places and the number of these seeds that are in them; None and 0 where there are none.

        They are not kept any longer, because they will be changed: `hold` them again.
        """
        lists, known = self._lists, self._pixels
        fits = (
            lists is not None
            and self._k == k
            and (self._growing or len(known) == len(pixels))
            and np.array_equal(known, pixels[: len(known)])
        )
        self.clear()
        return (lists, len(known)) if fits else (None, 0)

    def hold(self, lists, pixels, k):
        """Keep lists of k places, of the seeds on these pixels."""
        if lists.nbytes <= self._limit:
            self._lists, self._pixels, self._k = lists, pixels, k


def all_are_few(seeds, pixels):
    """Whether all seeds are used on a scan of so many pixels."""
    return seeds * pixels <= EXACT_PIXEL_SEEDS or seeds <= NUMBERS[0]


def mean_of_nearest(engine, pixels, values, valid, settings, held, threads, progress, cancelled, *, bounded=True):
    """Return the mean of eq. 1 over the nearest seeds, how many these are, and which they are.

    Parameters
    ----------
    engine : NativeEngine or ScipyEngine
    pixels : (S,) int
        Of the seeds.
    values : (S, C) float32
        What is spread.
    valid : (H, W) bool
    settings : Settings
        Its ``nearest`` is a number, or "auto".
    held : HeldLists
        What is known already, and what will be for the next time.
    threads : int
    progress, cancelled : callable
    bounded : bool, optional
        Whether to tell how much the seeds left out could change; it takes most of the time of mixing.

    Returns
    -------
    mean : Mean
    method : dict
        See ``Colorization.method``.
    near : ((S, k) float32, (S, k) int32)
        Distances and seeds.
    lists : Nearest or Listed
        The seeds of all pixels, to be blended with another alpha.
    """
    levels = colorspaces.levels_per_unit(settings.color_space)
    found, method, reported = None, {}, 0.0
    sought = NUMBERS if settings.nearest == "auto" else (settings.nearest,)
    for k in dict.fromkeys(held.places(number, len(pixels)) for number in sought):
        if found is not None:
            _require_memory(engine, k, valid.shape)
        # It is not known yet whether more seeds will be needed.
        end = (reported + 1) / 2 if settings.nearest == "auto" else 1.0
        found = _found(engine, pixels, k, found, held, threads, _part_of(progress, reported, end), cancelled)
        reported, method["nearest"] = end, min(k, len(pixels))
        if settings.nearest == "auto":
            doubled = doubled_levels(found.at(sample_of(valid)), values, settings.alpha, levels)
            method["doubled_levels"] = {"p95": round(doubled, 3)}
            if doubled <= _ENOUGH_LEVELS:
                break
    mean, bound = done_apart(
        engine.control(),
        lambda control: found.blend(values, settings.alpha, bounded=bounded, threads=threads, control=control),
        lambda control: progress(1.0, "Mixing the colors"),
        cancelled,
    )
    if bounded:
        inside = bound[valid] * levels
        largest, percentile = float(inside.max()), float(np.percentile(inside, 99.9))
        method["bound_levels"] = {"max": round(largest, 3), "p99.9": round(percentile, 3)}
    # Where there are fewer seeds than places, the last ones are empty.
    near = tuple(each[:, : len(pixels)] for each in found.at(pixels))
    return mean, method, near, found


def sample_of(valid):
    """Return some pixels with a return, spread evenly over a scan's (H, W) ``valid``: (P,) row * W + column."""
    count = min(_SAMPLE, valid.size)
    # Steps of the golden ratio spread the pixels evenly over rows and columns.
    pixels = ((np.arange(count) * _GOLDEN % 1) * valid.size).astype(np.int64)
    return pixels[valid.ravel()[pixels]]


def doubled_levels(lists, values, alpha, levels_per_unit):
    """Return how much the colors change when the number of nearest seeds is doubled to k.

    Parameters
    ----------
    lists : ((P, k) float32, (P, k) int32)
        Distances and seeds of some pixels.
    values : (S, C) float
        What is spread.
    alpha : float
    levels_per_unit : float

    Returns
    -------
    float
        8-bit levels that 95 of 100 of the pixels change by at most.
    """
    distances, seeds = lists
    if not len(seeds):
        return 0.0
    half = max(1, seeds.shape[1] // 2)
    doubled, _ = weighted_mean(distances, seeds, values, alpha)
    before, _ = weighted_mean(distances[:, :half], seeds[:, :half], values, alpha)
    changes = np.abs(doubled - before).max(axis=1) * levels_per_unit
    return float(np.percentile(changes, _ENOUGH_PERCENTILE))


def _part_of(progress, start, end):
    return lambda done, text: progress(start + (end - start) * done, text)


def _found(engine, pixels, k, known, held, threads, progress, cancelled):
    """The k nearest seeds of every pixel; ``known`` are fewer of them."""
    lists, first = held.take(pixels, k)

    def report(control):
        share = min(1, control.done / (len(pixels) - first))
        nearest = min(k, len(pixels))
        progress(share, Message("{nearest} nearest of {count} seeds", nearest=nearest, count=len(pixels)))

    def search(control):
        if lists is None:
            return engine.nearest(pixels, k, control, threads=threads, known=known)
        engine.extend(lists, pixels, first, control, threads=threads)
        return lists

    found = lists if first == len(pixels) else done_apart(engine.control(), search, report, cancelled)
    held.hold(found, pixels, k)
    return found


def _require_memory(engine, k, shape):
    """Raise a ReflcolorError if the memory for more seeds than expected is missing."""
    _, _, per_nearest = engine.memory
    rows, columns = shape
    require_memory(
        per_nearest * k * rows * columns,
        Message("{nearest} nearest seeds of {rows} rows x {columns} columns", nearest=k, rows=rows, columns=columns),
    )
