"""Method 1 of the paper: from a scan and seeds to a color at every pixel."""

from dataclasses import dataclass, field

import numpy as np

from . import colorspaces
from .blending import Blend
from .errors import Cancelled
from .geodesic import distance_fields
from .graph import PixelGraph
from .memory import require_memory
from .normalization import normalize
from .seeds import Seeds
from .settings import Settings

# The geodesic distance at which the confidence has fallen to a half: about a quarter of the reflectance's whole range.
_HALF_CONFIDENCE = 64.0
# What colorizing takes at its worst moment, with the graph of 8 neighbors and everything blended.
_BYTES_PER_PIXEL = 450


@dataclass(frozen=True, eq=False, kw_only=True)
class Colorization:
    """What colorizing a scan gives.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        sRGB; the gray of the reflectance where no seed reaches, black without a return.
    confidence : (H, W) float32
        1 at a seed, falling with the geodesic distance to the nearest one; 0 where no seed reaches.
    nearest_seed : (H, W) int32
        Index of the seed at the least geodesic distance; -1 where none reaches.
    seeds : Seeds
        The seeds as used: those on pixels without a return are moved.
    warnings : tuple of str
        One line each.
    normalization : dict
        ``{"reflectance": (low, high), "range": (low, high)}``: the raw values that became 0 and 255.
    """

    rgb: np.ndarray
    confidence: np.ndarray
    nearest_seed: np.ndarray
    seeds: Seeds
    warnings: tuple[str, ...] = ()
    normalization: dict = field(default_factory=dict)


def colorize(scan, seeds, settings=None, *, progress=None, cancelled=None):
    """Colorize a scan from seeds: eq. 1, 2, 5 and 6, over all seeds.

    Parameters
    ----------
    scan : Scan
    seeds : Seeds
    settings : Settings, optional
        The paper's by default.
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
        If the memory that is free will not do.
    Cancelled
        If ``cancelled()`` returned True.
    """
    settings = settings or Settings()
    progress = progress or (lambda fraction, text: None)
    cancelled = cancelled or (lambda: False)
    seeds, warnings = seeds.placed_on(scan)
    rows, columns = scan.shape
    require_memory(_BYTES_PER_PIXEL * rows * columns, f"{scan.name}: colorizing {rows} rows x {columns} columns")
    progress(0.0, "Preparing the scan")
    graph, normalization = pixel_graph(scan, settings)
    blend = Blend(scan.shape, settings.alpha)
    chrominance = colorspaces.chrominance(seeds.rgb, settings.color_space)
    for done, distance in enumerate(distance_fields(graph, seeds.rows, seeds.cols), 1):
        if cancelled():
            raise Cancelled
        blend.add(distance, chrominance[done - 1])
        progress(0.95 * done / len(seeds), f"Seed {done} of {len(seeds)}")
    reached = np.isfinite(blend.least)
    gray = np.rint(graph.luminance)
    rgb = colorspaces.merge(graph.luminance, blend.chrominance(), settings.color_space)
    rgb[~reached] = gray[~reached, None]
    unreached = int(np.count_nonzero(scan.valid & ~reached))
    if unreached:
        warnings.append(f"{unreached} pixels are cut off from every seed and keep their gray; add seeds there")
    progress(1.0, "Colorized")
    return Colorization(
        rgb=rgb,
        confidence=np.where(reached, 1 / (1 + blend.least / _HALF_CONFIDENCE), 0).astype(np.float32),
        nearest_seed=blend.nearest_seed,
        seeds=seeds,
        warnings=tuple(warnings),
        normalization=normalization,
    )


def pixel_graph(scan, settings):
    """Return the graph of a scan and the raw limits of its normalization (see ``Colorization``)."""
    luminance, reflectance_limits = normalize(scan.reflectance, scan.valid)
    range_image, range_limits = normalize(scan.range, scan.valid)
    graph = PixelGraph(
        luminance=luminance,
        range_image=range_image,
        valid=scan.valid,
        beta=settings.beta,
        neighbors=settings.neighbors,
        wrap=scan.full_turn,
    )
    return graph, {"reflectance": reflectance_limits, "range": range_limits}
