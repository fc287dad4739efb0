"""Spreads values from seeds over a scan: eq. 1, mixed with kriging, with intermediate results kept for the next
time."""

from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..errors import Cancelled
from ..files.memory import require_memory
from ..geodesic.blending import leave_one_out
from ..geodesic.engines import engine_class
from ..geodesic.graph import PixelGraph
from ..geodesic.smoothing import smooth
from ..messages import Message
from ..threads import thread_count
from . import colorspaces, nearest_seeds
from .kriging import MAX_SEEDS, Kriging, pixel_features
from .luminance import CHROMINANCE, channels_of, from_one_seed, seed_values
from .mixing import PICKED_GAIN, mixture, nearest_other, picked_by_a_person, unsmoothed_share
from .paths import Paths

# The geodesic distance at which the confidence has fallen to a half: about a quarter of the reflectance's whole range.
_HALF_CONFIDENCE = 64.0
HALF_CONFIDENCE_LEVELS = 5.0
"""The same, in 8-bit levels, for the difference between eq. 1 and kriging and for chrominance outside the gamut."""
_POLL_S = 0.02
# Shares of the progress of a colorization.
_SMOOTHED, _PROPAGATED, SPREAD = 0.5, 0.75, 0.95
# Peak bytes per pixel of kriging, and of what was found already while paths are sought once more.
_KRIGING_BYTES, _UNSMOOTHED_BYTES = 100, 40


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
    if settings.kriging:
        per_pixel += _KRIGING_BYTES + (_UNSMOOTHED_BYTES if settings.smoothing else 0)
    return pixels * per_pixel


class Spreader:
    """Spreads the values of seeds over one scan again and again; what did not change is not computed anew.

    It holds the paths over the smoothed reflectance with what they keep, and what came of the seeds last.

    Parameters
    ----------
    scan : Scan
    luminance, range_image : (H, W) float
        Of the scan, normalized to 0..255.
    settings : Settings
    memory : int
        Bytes that fields, or lists of nearest seeds, may take, of each kind of paths. With 0, nothing else is kept,
        either.
    threads : int
        The number changes no bit of a result.
    preview : bool
        As for the `Colorizer`.
    """

    def __init__(self, scan, luminance, range_image, settings, *, memory, threads, preview):
        self.scan, self.threads, self._preview = scan, threads, preview
        self._luminance, self._range_image = luminance, range_image
        self._memory, self._held = memory, None
        self.settings = None
        self.use(settings)

    @property
    def nbytes(self):
        """Bytes that fields and lists of nearest seeds take now."""
        return sum(paths.nbytes for paths in (self._paths, self._unsmoothed_paths) if paths is not None)

    @property
    def keeps(self):
        """Whether anything is kept for the next time."""
        return self._memory > 0

    @property
    def graph(self):
        """The `PixelGraph` of the scan, smoothed."""
        return self._paths.graph

    def use(self, settings):
        """Take over settings; what they make void is dropped."""
        before, self.settings = self.settings, settings
        if before is None or before.smoothing != settings.smoothing:
            self._smoothed = smooth(self._luminance, self.scan.valid, settings.smoothing, wrap=self.scan.full_turn)
            self._features = None
        elif (before.beta, before.neighbors) == (settings.beta, settings.neighbors):
            return
        self._paths = self._paths_over(self._smoothed, bounded=not self._preview)
        self._unsmoothed_paths = None

    def _paths_over(self, luminance, *, bounded):
        """The `Paths` over a (H, W) luminance."""
        graph = PixelGraph(
            luminance=luminance,
            range_image=self._range_image,
            valid=self.scan.valid,
            beta=self.settings.beta,
            neighbors=self.settings.neighbors,
            wrap=self.scan.full_turn,
        )
        return Paths(graph, memory=self._memory, threads=self.threads, growing=self._preview, bounded=bounded)

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
        by_person = float(seeds.of_a_person.mean())
        wanted = seeds.rows.tobytes(), seeds.cols.tobytes(), seeds.rgb.tobytes(), by_person, asked
        if self._held is None or self._held[0] != wanted:
            self._held = None
            pixels = np.ravel_multi_index((seeds.rows, seeds.cols), self.scan.shape)
            values = seed_values(seeds.rgb, self.settings)
            self._held = wanted, self._spread_from(pixels, values, by_person, kriging, progress, cancelled)
        spread = self._held[1]
        if not self.keeps:
            self._held = None
        return spread, warnings

    def _spread_from(self, pixels, values, by_person, kriging, progress, cancelled):
        """Return the Spread of seeds on these pixels, so great a share of which a person picked or locked."""
        if kriging and self._features is None:
            # Computed in parallel with the paths; after a cancellation nobody waits for it.
            pool = ThreadPoolExecutor(1, "reflcolor")
            self._features = pool.submit(pixel_features, self.scan, self._smoothed)
            pool.shutdown(wait=False)
        # Some seeds need paths over the reflectance as it is, too.
        twice = kriging and self.settings.smoothing > 0
        propagated = _SMOOTHED if twice else _PROPAGATED if kriging else SPREAD
        mean, method, near, again = self._paths.spread(
            pixels, values, self.settings, lambda done, text: progress(propagated * done, text), cancelled
        )
        alpha, picked = self.settings.alpha, 0.0
        if kriging:
            apart = nearest_other(*near)
            # The program's own are spaced evenly, however they look.
            picked = by_person * picked_by_a_person(self._directions(pixels), apart, mean.least[self.scan.valid])
            if picked > 0:
                alpha *= PICKED_GAIN**picked
                mean = again(alpha)
            path_residuals = values - leave_one_out(*near, values, alpha)
        # It holds arrays as large as the result.
        del again
        spread = mean.values
        if twice and picked > 0:
            chroma = values[:, CHROMINANCE]
            unsmoothed, nearby = self._unsmoothed(pixels, chroma, alpha, progress, cancelled)
            residuals = path_residuals[:, CHROMINANCE], chroma - leave_one_out(*nearby, chroma, alpha)
            # Luminance is left as it is: it changes within surfaces, too, and noise does it more harm.
            spread[CHROMINANCE] += unsmoothed_share(mean.weight, picked, *residuals) * (
                unsmoothed - spread[CHROMINANCE]
            )
        reached = np.isfinite(mean.least)
        confidence = np.where(reached, 1 / (1 + mean.least / _HALF_CONFIDENCE), 0)
        if kriging:
            estimate, kriging_residuals = self._krige(pixels, values, progress, cancelled)
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

    def _unsmoothed(self, pixels, values, alpha, progress, cancelled):
        """(C, H, W) float32: what paths give over the reflectance as it is; and what lies near each seed along them."""

        def report(done, text):
            progress(_SMOOTHED + (_PROPAGATED - _SMOOTHED) * done, text)

        settings = replace(self.settings, alpha=alpha)
        paths = self._unsmoothed_paths or self._paths_over(self._luminance, bounded=False)
        if self.keeps:
            self._unsmoothed_paths = paths
        found = paths.spread(pixels, values, settings, report, cancelled)
        return found.mean.values, found.near

    def _directions(self, pixels):
        """(S, 3): unit vectors; 0 at the scanner's own place."""
        points = self.scan.points.reshape(-1, 3)[pixels]
        return points / np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-12)

    def _require_memory(self, seeds):
        rows, columns = self.scan.shape
        needed = bytes_of_colorizing(
            self.scan.shape, seeds, self.settings, engine=self._paths.engine, threads=self.threads
        )
        require_memory(
            needed,
            Message(
                "{scan}: colorizing {rows} rows x {columns} columns", scan=self.scan.name, rows=rows, columns=columns
            ),
        )

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

        chunks = kriging.chunks(inside.size, self.threads)
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
