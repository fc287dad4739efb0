"""Colors while seeds are being picked: a coarse result at once, then the full one; only the latest request counts."""

import threading
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..color import colorspaces
from ..color.colorization import Colorization
from ..color.colorizer import Colorizer
from ..color.luminance import CHROMINANCE, lightness
from ..color.tone import toned
from ..errors import Cancelled
from ..scan.normalization import normalize
from ..scan.scan import Scan
from ..threads import in_threads, letting_others_run, thread_count

# The coarse result has about this many pixels; a scan that has few more is colorized at once.
COARSE_PIXELS = 60_000


@dataclass(frozen=True, eq=False)
class LiveResult:
    """What became of one wish.

    Parameters
    ----------
    number : int
        Of the wish, counted from 1.
    rgb : (H, W, 3) uint8
        Colors of every pixel; the gray of the reflectance where there is none. None if ``error`` is given.
    prepared : object
        What ``prepare`` made of ``rgb``.
    colorization : Colorization or None
        The full result; None while it is coarse.
    error : Exception or None
    """

    number: int
    rgb: np.ndarray | None = None
    prepared: object = None
    colorization: Colorization | None = None
    error: Exception | None = None


class LiveColorizer:
    """Colorizes a scan again and again in a thread of its own.

    ``wish(seeds, settings, observed)`` returns at once and makes void whatever was wished before; ``take()`` returns
    what is there by now. The thread ends with ``stop()``.

    Parameters
    ----------
    read_scan : callable
        Called without arguments in the thread; returns the Scan.
    prepare : callable, optional
        Called in the thread with the colors of every result, to make of them what showing them needs.
    arrived : callable, optional
        Called in the thread whenever there is something to take.
    """

    def __init__(self, read_scan, *, prepare=None, arrived=None):
        self._read_scan, self._prepare = read_scan, prepare or (lambda rgb: None)
        self._arrived = arrived or (lambda: None)
        self._condition = threading.Condition()
        self._wish = self._result = None
        self._number = 0
        self._stopped = False
        self._thread = threading.Thread(target=self._run, name="reflcolor live", daemon=True)
        self._thread.start()

    def wish(self, seeds, settings, observed=None):
        """Ask for the colors of Seeds and of what photos saw (`Observed`) with Settings; return the wish's number."""
        with self._condition:
            self._number += 1
            self._wish = self._number, seeds, settings, observed
            self._condition.notify()
            return self._number

    def take(self):
        """Return the newest LiveResult that was not taken yet; None if there is none."""
        with self._condition:
            result, self._result = self._result, None
            return result

    @property
    def latest(self):
        """The number of the latest wish; 0 before the first."""
        return self._number

    def stop(self, *, wait=True):
        """End the thread; with ``wait``, return when it has ended, else it ends by itself, soon."""
        with self._condition:
            self._stopped = True
            self._condition.notify()
        if wait:
            self._thread.join()

    def _run(self):
        scan = None
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._stopped or self._wish is not None)
                if self._stopped:
                    return
                (number, *wanted), self._wish = self._wish, None
            try:
                with letting_others_run():
                    if scan is None:
                        scan = _LiveScan(self._read_scan())
                    self._colorize(scan, number, *wanted)
            except Cancelled:
                continue
            except Exception as error:  # bad input, or a defect: the window distinguishes them
                self._deliver(LiveResult(number, error=error))

    def _colorize(self, scan, number, seeds, settings, observed):
        # A coarse result is quick and always finished: while a seed is dragged there is a new wish all the time.
        rgb = scan.coarse(seeds, settings, observed, lambda: self._stopped)
        if rgb is not None:
            self._deliver(LiveResult(number, rgb, self._prepare(rgb)))
        if len(seeds):
            found = scan.full(seeds, settings, observed, lambda: self._stopped or self._wish is not None)
            self._deliver(LiveResult(number, found.rgb, self._prepare(found.rgb), found))

    def _deliver(self, result):
        with self._condition:
            if self._stopped:
                return
            self._result = result
        self._arrived()


class _LiveScan:
    """A scan with its two colorizers: of all its pixels, and of one in so many."""

    def __init__(self, scan):
        self._scan = scan
        self._luminance, _ = normalize(scan.reflectance, scan.valid)
        # One for each thread that paints.
        edges = np.linspace(0, scan.shape[0], thread_count() + 1).astype(int)
        self._strips = [slice(top, bottom) for top, bottom in pairwise(edges)]
        self._stride = int(np.ceil(np.sqrt(scan.valid.size / COARSE_PIXELS)))
        self._kept = np.s_[:: self._stride, :: self._stride]
        self._fine = self._coarse = None

    def full(self, seeds, settings, observed, cancelled):
        """Return the Colorization of all pixels."""
        if self._fine is None:
            self._fine = Colorizer(self._scan, settings)
        return self._fine.colorize(seeds, settings, observed, cancelled=cancelled)

    def coarse(self, seeds, settings, observed, cancelled):
        """Return colors of all pixels by the chrominance of a few; None where that is no gain. Gray without seeds."""
        if len(seeds) == 0:
            return np.repeat(np.rint(toned(self._luminance, settings.tone)).astype(np.uint8)[..., None], 3, axis=-1)
        if self._stride == 1 or (self._coarse is None and not self._scan.valid[:: self._stride, :: self._stride].any()):
            return None
        if self._coarse is None:
            self._coarse = Colorizer(self._fewer_pixels(), settings, preview=True)
        rows, cols = seeds.rows // self._stride, seeds.cols // self._stride
        fewer, _ = replace(seeds, rows=rows, cols=cols).placed_on(self._coarse.scan)
        spread, _ = self._coarse.spread(fewer, settings, cancelled=cancelled)
        colored = self._coarse.joined(spread, fewer, None if observed is None else observed.thinned(self._stride))
        rgb = (self._of_seeds if settings.light == 1 else self._of_both)(colored, settings)
        rgb[~self._scan.valid] = 0
        if settings.light == 1 and colored.weight.any():
            # Observed colors exist at the full size already.
            weight = self._enlarged(colored.weight)[..., None] * observed.seen[..., None]
            rgb = np.rint(rgb + weight * (observed.rgb.astype(np.float32) - rgb)).astype(np.uint8)
        return rgb

    def _of_seeds(self, colored, settings):
        """(H, W, 3) uint8 where nothing of the reflectance is in the colors: those of the few pixels, enlarged."""
        few = _merged(self._luminance[self._kept], colored.values, colored.reached, settings)
        rgb = self._enlarged(_continued(few, colored.reached))
        gray = self._scan.valid & (self._enlarged(colored.reached.astype(np.float32)) == 0)
        rgb[gray] = np.rint(toned(self._luminance[gray], settings.tone))[:, None]
        return rgb

    def _of_both(self, colored, settings):
        """(H, W, 3) uint8 with the reflectance of every pixel."""
        # Enlarged together with their mask, so that pixels beside missing values are not mixed with them.
        reached = colored.reached[..., None].astype(np.float32)
        values, share = self._enlarged(colored.values * reached), self._enlarged(reached)
        rgb = np.empty((*self._scan.shape, 3), np.uint8)

        def paint(strip):
            own = values[strip] / np.maximum(share[strip], np.finfo(np.float32).tiny)[..., None]
            rgb[strip] = _merged(self._luminance[strip], own, share[strip] > 0, settings)

        for _ in in_threads(paint, self._strips):
            pass
        return rgb

    def _enlarged(self, image):
        """The image of a few pixels at the size of all."""
        import cv2

        height, width = self._scan.shape
        larger = cv2.resize(image, None, fx=self._stride, fy=self._stride, interpolation=cv2.INTER_LINEAR)
        return larger[:height, :width]

    def _fewer_pixels(self):
        kept, scan = self._kept, self._scan
        return Scan(
            name=scan.name, points=scan.points[kept], reflectance=scan.reflectance[kept], valid=scan.valid[kept]
        )


def _merged(reflectance, values, reached, settings):
    """(H, W, 3) uint8 of the reflectance and what seeds tell."""
    gray = lightness(reflectance, values, reached, settings)
    return colorspaces.merge(gray, values[..., CHROMINANCE], settings.color_space)


def _continued(rgb, reached):
    """(H, W, 3) uint8: around what was reached, the mean of the colors beside it."""
    import cv2

    share = cv2.blur(reached.astype(np.float32), (3, 3))
    mean = cv2.blur(rgb * reached[..., None].astype(np.float32), (3, 3))
    mean /= np.maximum(share, np.finfo(np.float32).tiny)[..., None]
    return np.where(reached[..., None], rgb, np.rint(mean)).astype(np.uint8)
