"""Spreads values from seeds over a scan: eq. 1, mixed with kriging, with intermediate results kept for the next
time."""

from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..errors import Cancelled
from ..files.memory import require_memory
from ..geodesic.blending import leave_one_out
from ..geodesic.engines import engine_class, engine_for
from ..geodesic.exact import HeldFields, SeedProgress, add_fields
from ..geodesic.graph import PixelGraph
from ..geodesic.smoothing import smooth
from ..messages import Message
from ..threads import thread_count
from . import colorspaces, nearest_seeds
from .kriging import MAX_SEEDS, Kriging, pixel_features
from .luminance import CHROMINANCE, channels_of, from_one_seed, seed_values
from .mixing import PICKED_GAIN, mixture, nearest_other, picked_by_a_person

# The geodesic distance at which the confidence has fallen to a half: about a quarter of the reflectance's whole range.
_HALF_CONFIDENCE = 64.0
HALF_CONFIDENCE_LEVELS = 5.0
"""The same, in 8-bit levels, for the difference between eq. 1 and kriging and for chrominance outside the gamut."""
_POLL_S = 0.02
# Shares of the progress of a colorization.
_PROPAGATED, SPREAD = 0.75, 0.95
_KRIGING_BYTES = 100
"""Peak bytes per pixel of kriging."""


class Spread(NamedTuple):
    """What spreads from seeds; neither tone nor light changes it."""

    values: np.ndarray
    """(H, W, C) float32: chrominance, and luminance if it is asked for, as `seed_values` has them."""
    confidence: np.ndarray
    """(H, W) float64, 0..1: before it is known what of the color cannot be shown."""
    nearest_seed: np.ndarray
    """(H, W) int32: -1 where no seed reaches."""
    method: dict
    """As in Colorization."""

    @property
    def reached(self):
        """(H, W) bool: where a seed arrives."""
        return self.nearest_seed >= 0


def bytes_of_colorizing(shape, seeds, settings, *, engine=None, threads=None):
    """The peak memory of colorizing a scan, in bytes, without the scan itself.

    Parameters
    ----------
    shape : (H, W)
    seeds : int
        How many.
    settings : Settings
    engine : object or class, optional
        That which will do it; by default the one that loads here.
    threads : int, optional
    """
    always, per_thread, per_nearest = (engine or engine_class()).memory
    pixels, nearest = shape[0] * shape[1], settings.nearest
    if nearest == "auto" and not nearest_seeds.all_are_few(seeds, pixels):
        nearest = nearest_seeds.NUMBERS[0]
    exact = per_thread * (threads or thread_count())
    per_pixel = always + (per_nearest * min(nearest, seeds) if isinstance(nearest, int) else exact)
    return pixels * (per_pixel + (_KRIGING_BYTES if settings.kriging else 0))


class Spreader:
    """Spreads the values of seeds over one scan again and again; what did not change is not computed anew.

    It holds the scan's graph, the geodesic fields of its seeds, the sums of eq. 1, and what came of them last.

    Parameters
    ----------
    scan : Scan
    luminance, range_image : (H, W) float
        Of the scan, normalized to 0..255.
    settings : Settings
    memory : int
        Bytes that fields may take. With 0, nothing else is kept, either.
    threads : int
        The number changes no bit of a result.
    """

    def __init__(self, scan, luminance, range_image, settings, *, memory, threads):
        self.scan, self.threads = scan, threads
        self._luminance, self._range_image = luminance, range_image
        self._fields = HeldFields(memory)
        self._held = None
        self.settings = None
        self.use(settings)

    @property
    def nbytes(self):
        """Bytes that the fields take now."""
        return self._fields.nbytes

    @property
    def keeps(self):
        """Whether anything is kept for the next time."""
        return self._fields.limit > 0

    @property
    def graph(self):
        """The `PixelGraph` of the scan."""
        return self._graph

    def use(self, settings):
        """Take over settings; what they make void is dropped."""
        before, self.settings = self.settings, settings
        if before is None or before.smoothing != settings.smoothing:
            self._smoothed = smooth(self._luminance, self.scan.valid, settings.smoothing, wrap=self.scan.full_turn)
            self._features = None
        elif (before.beta, before.neighbors) == (settings.beta, settings.neighbors):
            return
        self._graph = PixelGraph(
            luminance=self._smoothed,
            range_image=self._range_image,
            valid=self.scan.valid,
            beta=settings.beta,
            neighbors=settings.neighbors,
            wrap=self.scan.full_turn,
        )
        self._engine = engine_for(self._graph)
        self._fields.clear()
        self._forget_sums()

    def spread(self, seeds, progress, cancelled):
        """Return what `Colorizer.spread` does, with the settings in use."""
        self._require_memory(len(seeds))
        progress(0.0, "Preparing the scan")
        warnings, kriging = [], self.settings.kriging
        if kriging and len(seeds) > MAX_SEEDS:
            kriging = 0.0
            warnings.append(
                Message(
                    "kriging is left out: it takes {most} seeds at most, found {count}",
                    most=MAX_SEEDS,
                    count=len(seeds),
                )
            )
        # The tone, the share of the seeds' luminance, and observed colors do not change what is spread.
        asked = replace(self.settings, tone=1.0, light=float(self.settings.light > 0), photo_colors=False)
        wanted = seeds.rows.tobytes(), seeds.cols.tobytes(), seeds.rgb.tobytes(), asked
        if self._held is None or self._held[0] != wanted:
            self._held = None
            pixels = np.ravel_multi_index((seeds.rows, seeds.cols), self.scan.shape)
            values = seed_values(seeds.rgb, self.settings)
            self._held = wanted, self._spread_from(pixels, values, kriging, progress, cancelled)
        spread = self._held[1]
        if not self.keeps:
            self._held = None
        return spread, warnings

    def _spread_from(self, pixels, values, kriging, progress, cancelled):
        """Return the Spread of seeds on these pixels."""
        propagated = _PROPAGATED if kriging else SPREAD
        if kriging and self._features is None:
            # Computed in parallel with the paths; after a cancellation nobody waits for it.
            pool = ThreadPoolExecutor(1, "reflcolor")
            self._features = pool.submit(pixel_features, self.scan, self._smoothed)
            pool.shutdown(wait=False)
        mean, method, near, again = self._propagate(
            pixels, values, lambda done, text: progress(propagated * done, text), cancelled
        )
        alpha = self.settings.alpha
        if kriging:
            apart = nearest_other(*near)
            picked = picked_by_a_person(self._directions(pixels), apart, mean.least[self.scan.valid])
            if picked > 0:
                alpha *= PICKED_GAIN**picked
                mean = again(alpha)
        # It holds arrays as large as the result.
        del again
        reached = np.isfinite(mean.least)
        spread, confidence = mean.values, np.where(reached, 1 / (1 + mean.least / _HALF_CONFIDENCE), 0)
        if kriging:
            estimate, kriging_residuals = self._krige(pixels, values, progress, cancelled)
            path_residuals = values - leave_one_out(*near, values, alpha)
            unit = colorspaces.levels_per_unit(self.settings.color_space)
            confidence /= 1 + np.hypot(*(estimate - spread)[CHROMINANCE]) * unit / HALF_CONFIDENCE_LEVELS
            for part, name in zip(channels_of(self.settings), ("kriging", "kriging_of_luminance"), strict=False):
                mixed = mixture(kriging_residuals[:, part], path_residuals[:, part], apart, kriging, picked)
                share = mixed.share(mean.least)
                spread[part] += share * (estimate[part] - spread[part])
                method[name] = round(float(share[reached].mean()), 3)
        if self.settings.light > 0 and len(pixels) == 1:
            own = float(self._luminance.ravel()[pixels[0]])
            spread[2] = from_one_seed(spread[2], self._luminance, own, self.settings)
        return Spread(np.moveaxis(spread, 0, -1), confidence, mean.nearest_seed, method)

    def _directions(self, pixels):
        """(S, 3): unit vectors; 0 at the scanner's own place."""
        points = self.scan.points.reshape(-1, 3)[pixels]
        return points / np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-12)

    def _forget_sums(self):
        self._blend, self._blended = None, []

    def _require_memory(self, seeds):
        rows, columns = self.scan.shape
        needed = bytes_of_colorizing(self.scan.shape, seeds, self.settings, engine=self._engine, threads=self.threads)
        require_memory(
            needed,
            Message(
                "{scan}: colorizing {rows} rows x {columns} columns", scan=self.scan.name, rows=rows, columns=columns
            ),
        )

    def _propagate(self, pixels, values, progress, cancelled):
        """Return the mean of eq. 1, how it was found, what lies near the seeds, and a function of another alpha.

        What lies near is as in the engine's ``nearest``; the function returns the mean with that alpha.
        """
        nearest = self.settings.nearest
        method = {"engine": self._engine.name, "note": self._engine.note, "nearest": None}
        few = nearest_seeds.all_are_few(len(pixels), self.scan.valid.size)
        if nearest is None or (nearest == "auto" and (self._engine.note or few)):
            mean, near = self._exact(pixels, values, self.settings.alpha, progress, cancelled)
            return mean, method, near, lambda alpha: self._exact(pixels, values, alpha, lambda *_: None, cancelled)[0]
        mean, found, near, lists = nearest_seeds.mean_of_nearest(
            self._engine, pixels, values, self.scan.valid, self.settings, self.threads, progress, cancelled
        )
        return mean, method | found, near, lambda alpha: lists.blend(values, alpha)[0]

    def _exact(self, pixels, values, alpha, progress, cancelled):
        """Eq. 1 over all seeds, in their order; fields that are not held are computed in threads, a few ahead."""
        wanted = list(zip(pixels.tolist(), map(tuple, values.tolist()), strict=True))
        done, between = len(self._blended), None
        if self.settings.kriging and pixels.size <= MAX_SEEDS:
            # Kriging needs the distances between seeds, so every field is visited again.
            self._forget_sums()
            between = np.empty((pixels.size,) * 2, np.float32)
        if self._blend is None or self._alpha != alpha or self._blended != wanted[:done]:
            self._forget_sums()
            self._alpha, done = alpha, 0
            self._blend = self._engine.blend(self._alpha, values.shape[1])
        missing = wanted[done:]
        held = done + sum(self._fields.get(pixel) is not None for pixel, _ in missing)
        report = SeedProgress(progress, len(wanted), held, np.count_nonzero(self.scan.valid), self.threads)

        def added(index, field):
            self._blended.append(missing[index])
            if between is not None:
                between[:, done + index] = field[np.unravel_index(pixels, self.scan.shape)]
            report(len(self._blended))

        try:
            add_fields(
                self._engine,
                self._blend,
                missing,
                threads=self.threads,
                held=self._fields,
                added=added,
                working=lambda settled: report(len(self._blended), settled),
                cancelled=cancelled,
            )
        except BaseException:
            self._forget_sums()
            raise
        mean = self._blend.mean(keep=self.keeps)
        if not self.keeps:
            self._forget_sums()
        return mean, None if between is None else (between, np.broadcast_to(np.arange(pixels.size), between.shape))

    def _krige(self, pixels, values, progress, cancelled):
        """Return the (C, H, W) float32 values estimated by kriging, 0 where not valid, and residuals of the seeds."""
        progress(_PROPAGATED, "Estimating by kriging")
        while not wait([self._features], _POLL_S).done:
            if cancelled():
                raise Cancelled
        if self._features.exception() is not None:
            failed, self._features = self._features, None
            failed.result()
        features = self._features.result()
        kriging = Kriging(features[pixels], values, channels_of(self.settings))
        estimate = np.zeros((self.scan.valid.size, values.shape[1]), np.float32)
        inside = np.flatnonzero(self.scan.valid)

        def fill(chunk):
            estimate[inside[chunk]] = kriging.estimate(features[inside[chunk]])

        chunks = kriging.chunks(inside.size)
        with ThreadPoolExecutor(self.threads, "reflcolor") as pool:
            running = [pool.submit(fill, chunk) for chunk in chunks]
            try:
                for done, chunk in enumerate(running, 1):
                    if cancelled():
                        raise Cancelled
                    chunk.result()
                    progress(_PROPAGATED + (SPREAD - _PROPAGATED) * done / len(chunks), "Estimating by kriging")
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        estimate = np.moveaxis(estimate.reshape(*self.scan.shape, -1), -1, 0)
        return estimate, kriging.residuals
