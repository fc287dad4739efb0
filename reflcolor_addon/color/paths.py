"""Eq. 1 over the graph of one scan, with its fields and sums kept for the next time."""

from typing import NamedTuple

import numpy as np

from ..geodesic.engines import engine_for
from ..geodesic.exact import HeldFields, SeedProgress, add_fields
from . import nearest_seeds
from .kriging import MAX_SEEDS


class AlongPaths(NamedTuple):
    """What `Paths.spread` found."""

    mean: object
    """Mean: of eq. 1."""
    method: dict
    """How; see ``Colorization.method``."""
    near: tuple | None
    """((S, k) float32, (S, k) int32): distances and seeds near each seed; None where kriging does not ask for them."""
    again: object
    """A function that returns the mean with another alpha. It holds arrays as large as the result."""


class Paths:
    """Spreads values over one graph again and again; what did not change is not computed anew.

    Parameters
    ----------
    graph : PixelGraph
    memory : int
        Bytes that geodesic fields may take, or lists of nearest seeds. With 0, nothing else is kept, either.
    threads : int
        The number changes no bit of a result.
    growing : bool
        Whether seeds are added to lists; see `HeldLists`.
    bounded : bool
        Whether to tell how much the seeds left out could change.
    """

    def __init__(self, graph, *, memory, threads, growing, bounded):
        self.graph, self.engine = graph, engine_for(graph)
        self._threads, self._fields, self._bounded = threads, HeldFields(memory), bounded
        self._lists = nearest_seeds.HeldLists(memory, growing=growing)
        self._forget_sums()

    @property
    def nbytes(self):
        """Bytes that the fields or lists take now."""
        return self._fields.nbytes + self._lists.nbytes

    def spread(self, pixels, values, settings, progress, cancelled):
        """Return what eq. 1 gives, as `AlongPaths`.

        Parameters
        ----------
        pixels : (S,) int
            Of the seeds, row * W + column.
        values : (S, C) float32
        settings : Settings
            Those of the graph.
        progress, cancelled : callable
        """
        nearest, valid = settings.nearest, self.graph.valid
        method = {"engine": self.engine.name, "note": self.engine.note, "nearest": None}
        few = nearest_seeds.all_are_few(len(pixels), valid.size)
        if nearest is None or (nearest == "auto" and (self.engine.note or few)):
            self._lists.clear()

            def exact(alpha, progress=lambda *_: None):
                return self._exact(pixels, values, alpha, settings.kriging > 0, progress, cancelled)

            mean, near = exact(settings.alpha, progress)
            return AlongPaths(mean, method, near, lambda alpha: exact(alpha)[0])
        self._fields.clear()
        self._forget_sums()
        mean, found, near, lists = nearest_seeds.mean_of_nearest(
            self.engine,
            pixels,
            values,
            valid,
            settings,
            self._lists,
            self._threads,
            progress,
            cancelled,
            bounded=self._bounded,
        )

        def again(alpha):
            return lists.blend(values, alpha, bounded=False, threads=self._threads)[0]

        return AlongPaths(mean, method | found, near, again)

    def _forget_sums(self):
        self._blend, self._blended = None, []

    def _exact(self, pixels, values, alpha, kriging, progress, cancelled):
        """Eq. 1 over all seeds, in their order; fields that are not held are computed in threads, a few ahead."""
        wanted = list(zip(pixels.tolist(), map(tuple, values.tolist()), strict=True))
        done, between = len(self._blended), None
        if kriging and pixels.size <= MAX_SEEDS:
            # Kriging needs the distances between seeds, so every field is visited again.
            self._forget_sums()
            between = np.empty((pixels.size,) * 2, np.float32)
        if self._blend is None or self._alpha != alpha or self._blended != wanted[:done]:
            self._forget_sums()
            self._alpha, done = alpha, 0
            self._blend = self.engine.blend(self._alpha, values.shape[1])
        missing = wanted[done:]
        held = done + sum(self._fields.get(pixel) is not None for pixel, _ in missing)
        report = SeedProgress(progress, len(wanted), held, np.count_nonzero(self.graph.valid), self._threads)

        def added(index, field):
            self._blended.append(missing[index])
            if between is not None:
                between[:, done + index] = field[np.unravel_index(pixels, self.graph.shape)]
            report(len(self._blended))

        try:
            add_fields(
                self.engine,
                self._blend,
                missing,
                threads=self._threads,
                held=self._fields,
                added=added,
                working=lambda settled: report(len(self._blended), settled),
                cancelled=cancelled,
            )
        except BaseException:
            self._forget_sums()
            raise
        keep = self._fields.limit > 0
        mean = self._blend.mean(keep=keep)
        if not keep:
            self._forget_sums()
        return mean, None if between is None else (between, np.broadcast_to(np.arange(pixels.size), between.shape))
