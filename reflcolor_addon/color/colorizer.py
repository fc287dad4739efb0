"""Method 1 of the paper, holding what a scan has in common from one colorization to the next."""

import numpy as np

from ..errors import Cancelled, ReflcolorError
from ..files.memory import require_memory
from ..geodesic.exact import done_apart
from ..messages import Message
from ..native.library import Control
from ..progress import IsCancelled, Progress
from ..scan.normalization import normalize
from ..scan.scan import Scan, require_scan
from ..seeds.seeds import Seeds, require_seeds
from ..settings import Settings, settings_or_default
from ..threads import thread_count
from . import colorspaces
from .colorization import Colorization
from .luminance import CHROMINANCE, lightness
from .observed import Observed, inferred_only, joined, outranked
from .spreader import HALF_CONFIDENCE_LEVELS, SPREAD, Spreader
from .tone import tone_to_try

_DEFAULT_MEMORY = 1 << 30
# Share of the returns that no seed reaches from which that is worth a warning: a few stray returns never matter.
_FEW_UNREACHED = 0.001
# Share of the progress that is done when the colors are written.
_JOINED = 0.98
# Pixels between two checks for cancellation.
_PAINTED_PIXELS = 1 << 19
_JOIN_BYTES = 150
"""Peak bytes per pixel while observed colors are joined."""


_GUESSED = Message("the colors are guesses: no seed was picked by a person or seen by a photo that was verified")


class Colorizer:
    """Colorizes one scan repeatedly and reuses what did not change.

    It holds the scan's graph, the geodesic fields of its seeds, the sums of eq. 1, and what came of them last. A seed
    that is added costs one field; one that is moved, one field and a new sum; one that is removed or recolored, a new
    sum; another tone or light, none of these. The result has the same bits as one computed at once.

    Parameters
    ----------
    scan : Scan
    settings : Settings, optional
        The paper's by default.
    memory : int
        Bytes that fields may take; the least recently used ones are dropped and computed again when needed. With 0,
        nothing else is kept, either.
    threads : int, optional
        By default one per processor. The number changes no bit of a result.
    preview : bool, optional
        A seed more costs far less, but with equal distances a few pixels may differ from what `colorize` gives.

    Raises
    ------
    ReflcolorError
        If the memory that is free will not do.

    Examples
    --------
    >>> from reflcolor_addon import Colorizer, Seeds, read_scans
    >>> colorizer = Colorizer(read_scans("garage.ptx")[0])
    >>> first = colorizer.colorize(Seeds([1], [2], [[200, 80, 40]]))
    >>> second = colorizer.colorize(Seeds([1, 15], [2, 20], [[200, 80, 40], [20, 80, 220]]))  # one field more
    >>> int(first.nearest_seed.max()), int(second.nearest_seed.max())
    (0, 1)
    """

    def __init__(
        self,
        scan: Scan,
        settings: Settings | None = None,
        *,
        memory: int = _DEFAULT_MEMORY,
        threads: int | None = None,
        preview: bool = False,
    ) -> None:
        require_scan(scan)
        self.scan = scan
        self.threads = threads or thread_count()
        self._luminance, reflectance_limits = normalize(scan.reflectance, scan.valid)
        self._median = float(np.median(self._luminance[scan.valid])) if scan.valid.any() else 0.0
        range_image, range_limits = normalize(scan.range, scan.valid)
        self._normalization = {"reflectance": reflectance_limits, "range": range_limits}
        self._seen = None
        self.settings = settings_or_default(settings)
        images = self._luminance, range_image
        self._spreader = Spreader(scan, *images, self.settings, memory=memory, threads=self.threads, preview=preview)

    @property
    def held_bytes(self):
        """Bytes that fields and lists of nearest seeds take now."""
        return self._spreader.nbytes

    def colorize(
        self,
        seeds: Seeds,
        settings: Settings | None = None,
        observed: Observed | None = None,
        *,
        progress: Progress | None = None,
        cancelled: IsCancelled | None = None,
    ) -> Colorization:
        """Colorize the scan; parameters, result and errors are those of ``colorize``."""
        progress = progress or (lambda fraction, text: None)
        cancelled = cancelled or (lambda: False)
        require_seeds(seeds)
        seeds, warnings = seeds.placed_on(self.scan)
        spread, more = self.spread(seeds, settings, progress=progress, cancelled=cancelled)
        progress(SPREAD, "Joining what photos saw")
        colored = self.joined(spread, seeds, observed, cancelled=cancelled)
        progress(_JOINED, "Writing the colors")
        unreached = int(np.count_nonzero(self.scan.valid & ~colored.reached))
        if unreached > _FEW_UNREACHED * np.count_nonzero(self.scan.valid):
            more.append(
                Message(
                    "{count} pixels are cut off from every seed and keep their gray; add seeds there", count=unreached
                )
            )
        if seeds.all_guessed:
            warnings.insert(0, _GUESSED)
        tone = tone_to_try(self._median, self.settings.tone)
        if tone is not None and self.settings.light == 0:
            # It comes first, because a list of warnings may be truncated.
            warnings.insert(
                0, Message("the colors are dark because most of the reflectance is; try tone {tone:g}", tone=tone)
            )
        rgb, lost = self._paint(colored.values, colored.reached, cancelled)
        progress(1.0, "Colorized")
        return Colorization(
            rgb=rgb,
            confidence=(colored.confidence / (1 + lost / HALF_CONFIDENCE_LEVELS)).astype(np.float32),
            nearest_seed=spread.nearest_seed.copy(),
            observed=colored.weight,
            photo=colored.photo,
            seeds=seeds,
            warnings=(*warnings, *more),
            normalization=self._normalization,
            method=dict(spread.method),
        )

    def joined(self, spread, seeds, observed, *, cancelled=None):
        """Return what `spread` found as `Colored`, with what photos saw where the settings ask for that.

        Parameters
        ----------
        spread : Spread
            Of these seeds, found just before.
        seeds : Seeds
            On pixels with a return.
        observed : Observed or None
        cancelled : callable, optional

        Raises
        ------
        Cancelled
            If ``cancelled()`` returned True.
        ReflcolorError
            If what photos saw is of another size than the scan.
        """
        if observed is None or not self.settings.photo_colors:
            return inferred_only(spread)
        if observed.weight.shape != self.scan.shape:
            raise ReflcolorError(
                "{scan}: expected observed colors of {expected}, found {found}",
                scan=self.scan.name,
                expected=self.scan.shape,
                found=observed.weight.shape,
            )
        ranks = seeds.of_a_person.tobytes(), self.settings.light > 0
        held = self._seen
        if held is None or held[0] is not spread or held[1] is not observed or held[2] != ranks:
            self._seen = None
            rows, columns = self.scan.shape
            require_memory(
                _JOIN_BYTES * rows * columns, Message("{scan}: joining what photos saw", scan=self.scan.name)
            )

            def work(control):
                ranked = outranked(observed, seeds, self._spreader.graph, self.settings.alpha, control)
                return joined(spread, ranked, seeds, self._spreader.graph, self.settings, control)

            found = done_apart(Control(), work, lambda control: None, cancelled or (lambda: False))
            self._seen = spread, observed, ranks, found
        colored = self._seen[-1]
        if not self._spreader.keeps:
            self._seen = None
        return colored

    def spread(self, seeds, settings=None, *, progress=None, cancelled=None):
        """Spread the seeds' values, without making colors of them; errors are those of ``colorize``.

        Parameters
        ----------
        seeds : Seeds
            On pixels with a return (see ``Seeds.placed_on``).
        settings : Settings, optional
            Those of the last time by default.

        Returns
        -------
        Spread
        list of str
            Warnings.
        """
        self.settings = settings_or_default(settings or self.settings)
        self._spreader.use(self.settings)
        return self._spreader.spread(seeds, progress or (lambda fraction, text: None), cancelled or (lambda: False))

    def _paint(self, values, reached, cancelled):
        """Return the (H, W, 3) uint8 colors and the (H, W) float32 levels of chrominance that they lack."""
        rgb, lost = np.empty((*self.scan.shape, 3), np.uint8), np.empty(self.scan.shape, np.float32)
        rows = max(1, _PAINTED_PIXELS // rgb.shape[1])
        for top in range(0, len(rgb), rows):
            if cancelled():
                raise Cancelled
            strip = slice(top, top + rows)
            luminance = lightness(self._luminance[strip], values[strip], reached[strip], self.settings)
            chroma = values[strip][..., CHROMINANCE]
            rgb[strip] = colorspaces.merge(luminance, chroma, self.settings.color_space)
            lost[strip] = colorspaces.lost_levels(rgb[strip], chroma, self.settings.color_space)
            rgb[strip][~reached[strip]] = np.rint(luminance[~reached[strip]])[:, None]
        return rgb, lost


def colorize(
    scan: Scan,
    seeds: Seeds,
    settings: Settings | None = None,
    observed: Observed | None = None,
    *,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> Colorization:
    """Colorize a scan from seeds: eq. 1, 2, 5 and 6.

    Parameters
    ----------
    scan : Scan
    seeds : Seeds
    settings : Settings, optional
        The paper's by default.
    observed : Observed, optional
        What verified photos saw, as `match_photos` finds it. Where they saw a pixel, and ``settings.photo_colors`` asks
        for it, its color is theirs; only a seed that a person picked or locked tells more.
    progress : callable, optional
        Called as ``progress(fraction, text)`` with a fraction of 0 to 1.
    cancelled : callable, optional
        Asked now and then; when it returns True, the work ends.

    Returns
    -------
    Colorization

    Raises
    ------
    SeedsError
        If there are no seeds, or one is outside the grid.
    ReflcolorError
        If the memory that is free will not do, or ``observed`` has another size.
    Cancelled
        If ``cancelled()`` returned True.

    References
    ----------
    .. [1] S. Oishi, R. Kurazume, Y. Iwashita, T. Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
       Reflectivity", ICRA 2013.
    .. [2] L. Yatziv, G. Sapiro, "Fast image and video colorization using chrominance blending", IEEE Transactions on
       Image Processing 15(5), 2006: the same with ``beta=0``.

    Examples
    --------
    >>> from reflcolor_addon import Seeds, Settings, colorize, read_scans
    >>> scan = read_scans("garage.ptx")[0]
    >>> result = colorize(scan, Seeds([1, 15], [2, 20], [[200, 80, 40], [20, 80, 220]]), Settings(alpha=4))
    >>> result.rgb.shape, result.rgb.dtype, result.confidence.shape
    ((20, 30, 3), dtype('uint8'), (20, 30))
    """
    # The scan is colorized only once, so no field needs to be kept.
    return Colorizer(scan, settings, memory=0).colorize(
        seeds, observed=observed, progress=progress, cancelled=cancelled
    )
