"""Colors that photos saw, at every pixel of a scan, joined with what is inferred from seeds elsewhere.

Where a photo ends, its colors and the inferred ones differ by what no seed told. That difference is carried on, along
paths, from the border of what was seen: beside the border the inferred colors are the photo's, and farther away they
are the seeds' again. So all pixels at the border have a say, not one in a superpixel, and no edge shows there. Right
beside the border, where what seeds tell differs from pixel to pixel by chance, the photo's colors themselves are
carried on, and what still differs by chance is evened out.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..geodesic.spreading import spread as geodesic_spread
from . import colorspaces
from .luminance import seed_values

# Cost of a path per pixel, in levels of the reflectance; distances at which the difference, and what is carried of the
# colors themselves, have fallen to a half; number of border pixels that are averaged, the exponent of their distances,
# and the size of the window over which each is smoothed.
_STEP, _HALF_WAY, _HALF_WAY_ITSELF = 1.0, 150.0, 48.0
_NEAREST, _ALPHA, _AVERAGED = 8, 2.0, 3
# Weight from which an observed color counts as that of the surface, and is carried on.
_SURE = 0.9
# Pixels over which what was seen fades into what is inferred from it, hardly any of it being left in the last one.
_FADES, _FADED = 1.6, 0.95
# How inferred colors are evened out beside the border: twice, over so many pixels, among those that differ by less than
# so many levels; and pixels from the border at which that has fallen to a half.
_EVENED_PX, _EVENED_LEVELS, _HALF_WAY_EVENED = 3.0, 18.0, 8.0
# Number of places in the photos that a picked color is compared with.
_PLACES = 500
_STRIP_PIXELS = 1 << 18
_BASES = np.array([1 << 16, 1 << 8, 1], np.int32)


@dataclass(frozen=True, eq=False)
class Observed:
    """What photos with verified cameras show of a scan.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        sRGB, of one exposure and white balance for all photos; black where nothing was seen.
    weight : (H, W) float32
        0 where no photo saw the pixel, to 1 where one saw it well.
    photo : (H, W) int16
        Index of the photo that leads there; -1 where none.
    """

    rgb: np.ndarray
    weight: np.ndarray
    photo: np.ndarray

    @property
    def seen(self):
        """(H, W) bool: where a photo saw anything."""
        return self.weight > 0

    def thinned(self, stride):
        """Return those of one pixel in so many rows and columns."""
        kept = np.s_[::stride, ::stride]
        return Observed(self.rgb[kept], self.weight[kept], self.photo[kept])


def packed_rgb(rgb):
    """Return (N,) int32: the three numbers of each (N, 3) uint8 color in one, for attributes that hold one number."""
    return rgb.astype(np.int32) @ _BASES


def unpacked_rgb(packed):
    """Return the (N, 3) uint8 colors that `packed_rgb` packed."""
    return (packed[:, None] // _BASES & 255).astype(np.uint8)


def outranked(observed, seeds, graph, alpha, control=None):
    """Return the `Observed` colors without those that seeds of a person override.

    A seed that was picked or locked colors what is nearer to it, along paths, than to places all over the photos.

    Parameters
    ----------
    observed : Observed
    seeds : Seeds
        On pixels with a return.
    graph : PixelGraph
    alpha : float
        See ``Settings``.
    control : Control, optional
        Can cancel the work.
    """
    picked = _pixels(seeds, seeds.of_a_person & observed.seen[seeds.rows, seeds.cols], graph)
    if not len(picked):
        return observed
    places = np.setdiff1d(_spaced(observed.seen), picked)
    pixels, own = np.concatenate([picked, places]), np.repeat([1.0, 0.0], [len(picked), len(places)])
    # Each pixel of a path has a cost; otherwise a seed on an even wall would reach everywhere.
    around = replace(graph, step_cost=_STEP)
    shares, _ = geodesic_spread(around, pixels, own[:, None], count=_NEAREST, alpha=alpha, control=control)
    weight = observed.weight * (1 - shares[..., 0])
    # Its own pixel has the color that the person gave it.
    weight.reshape(-1)[picked] = 0
    return Observed(observed.rgb, weight, np.where(weight > 0, observed.photo, np.int16(-1)))


class Colored(NamedTuple):
    """The values of every pixel, before colors are made of them."""

    values: np.ndarray
    """(H, W, C) float32, see `luminance.seed_values`."""
    reached: np.ndarray
    """(H, W) bool: where a seed or an observed color arrived."""
    confidence: np.ndarray
    """(H, W) float64, 0..1."""
    weight: np.ndarray
    """(H, W) float32, 0..1: how far the values are observed ones."""
    photo: np.ndarray
    """(H, W) int16: which photo's; -1 where they are inferred."""


def inferred_only(spread):
    """Return a `Spread` as `Colored` without photos."""
    shape = spread.nearest_seed.shape
    weight, photo = np.zeros(shape, np.float32), np.full(shape, -1, np.int16)
    return Colored(spread.values, spread.reached, spread.confidence, weight, photo)


def joined(spread, observed, seeds, graph, settings, control=None):
    """Return the observed values and, elsewhere, the inferred ones brought near to them.

    Parameters
    ----------
    spread : Spread
        What seeds tell.
    observed : Observed
        See `outranked`.
    seeds : Seeds
        On pixels with a return.
    graph : PixelGraph
    settings : Settings
    control : Control, optional
        Can cancel the work.

    Returns
    -------
    Colored
    """
    fading = _fading(observed, graph)
    continued, arrived = _continued(spread, observed, fading, seeds, graph, settings, control)
    if arrived.any():
        _even_out(continued, observed, seeds, graph, settings)
    values = np.empty_like(spread.values)
    # Where nothing else arrived, even a badly observed color is kept.
    weight = np.where(spread.reached | arrived, fading, observed.seen).astype(np.float32)
    rows = max(1, _STRIP_PIXELS // values.shape[1])
    for top in range(0, len(values), rows):
        strip = slice(top, top + rows)
        inferred = continued[strip]
        own = seed_values(observed.rgb[strip].reshape(-1, 3), settings).reshape(inferred.shape)
        values[strip] = inferred + weight[strip][..., None] * (own - inferred)
    confidence = observed.weight + (1 - observed.weight) * spread.confidence
    return Colored(values, spread.reached | arrived | observed.seen, confidence, weight, observed.photo)


def _fading(observed, graph):
    """(H, W) float32: the share of what was seen in a pixel's color, less in the last few pixels before its border."""
    distance = _distance(graph.valid & ~observed.seen, math.ceil(_FADED + _FADES) + 1, graph.wrap)
    # With no edge at either end.
    near = np.clip((distance - np.float32(_FADED)) / np.float32(_FADES), 0, 1)
    # Up to a half the weight itself; from three quarters on the whole color: an inferred one is less true there.
    share = np.clip(2 * observed.weight - np.float32(0.5), observed.weight, 1)
    return share * near * near * (3 - 2 * near)


def _continued(spread, observed, fading, seeds, graph, settings, control):
    """(H, W, C) float32: the inferred values, brought near to the observed ones beyond the border of what was seen;
    and (H, W) bool where something arrived from there."""
    import cv2

    sure = (fading >= _SURE) & (observed.weight >= _SURE)
    rest = graph.valid & ~sure
    border = sure & (cv2.dilate(rest.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    pixels = np.flatnonzero(border)
    if not len(pixels):
        return spread.values, np.zeros(sure.shape, bool)
    # Nothing is changed at a color given by a person.
    anchors = _pixels(seeds, seeds.of_a_person & rest[seeds.rows, seeds.cols], graph)
    inferred = spread.values.reshape(-1, spread.values.shape[-1])
    own = np.concatenate([_averaged(observed, pixels, settings), inferred[anchors]])
    pixels = np.concatenate([pixels, anchors])
    around = replace(graph, valid=rest | border, step_cost=_STEP)
    both = np.concatenate([own, own - inferred[pixels]], axis=1)
    carried, distance = geodesic_spread(around, pixels, both, count=_NEAREST, alpha=_ALPHA, control=control)
    carried, differences = np.split(carried, 2, axis=-1)
    arrived = np.isfinite(distance)
    distance = np.where(arrived, distance, np.float32(0))
    gain = np.where(arrived, 1 / (1 + distance / np.float32(_HALF_WAY)), 0)
    itself = np.where(arrived, 1 / (1 + (distance / np.float32(_HALF_WAY_ITSELF)) ** 2), 0)
    # Without any seed there is only the border.
    itself[arrived & ~spread.reached] = 1
    continued = spread.values + gain[..., None] * differences
    continued += itself[..., None] * (carried - continued)
    return continued, arrived


def _even_out(values, observed, seeds, graph, settings):
    """Even out (H, W, C) values, in place, beside the border of what was seen."""
    import cv2

    height, width, channels = values.shape
    radius = round(1.5 * _EVENED_PX)
    margin = min(2 * radius, width)
    # What is far from every value takes part in none; and the filter wants three channels.
    even = np.zeros((height, width + 2 * margin, 3), np.float32)
    even[..., :channels] = np.pad(
        np.where(graph.valid[..., None], values, np.float32(-255)),
        ((0, 0), (margin, margin), (0, 0)),
        mode="wrap" if graph.wrap else "edge",
    )
    levels = _EVENED_LEVELS / colorspaces.levels_per_unit(settings.color_space)
    for _ in range(2):
        even = cv2.bilateralFilter(even, 2 * radius + 1, levels, _EVENED_PX)
    even = even[:, margin : margin + width, :channels]
    distance = _distance(observed.seen, 4 * math.ceil(_HALF_WAY_EVENED), graph.wrap)
    share = 1 / (1 + np.square(distance / np.float32(_HALF_WAY_EVENED)))
    # A color given by a person stays as it is.
    share.reshape(-1)[_pixels(seeds, seeds.of_a_person, graph)] = 0
    values += share[..., None] * (even - values)


def _distance(mask, margin, wrap):
    """(H, W) float32: pixels to the nearest one of a mask, over the edge of a full turn as far as a margin."""
    import cv2

    margin = min(margin, mask.shape[1])
    sides = ((margin, margin), (margin, margin))
    mask = np.pad(mask, (sides[0], (0, 0)))
    mask = np.pad(mask, ((0, 0), sides[1]), mode="wrap" if wrap else "constant")
    return cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5)[margin:-margin, margin:-margin]


def _pixels(seeds, chosen, graph):
    """(P,) int, ``row * width + column``, of the chosen seeds, each once."""
    return np.unique(np.ravel_multi_index((seeds.rows[chosen], seeds.cols[chosen]), graph.shape))


def _averaged(observed, pixels, settings):
    """(P, C) float32: the observed values around pixels, so that no speck is carried far."""
    import cv2

    seen = (observed.weight >= _SURE).astype(np.float32)
    size = (_AVERAGED, _AVERAGED)
    share = cv2.blur(seen, size)
    rgb = cv2.blur(observed.rgb * seen[..., None], size) / np.maximum(share, np.float32(1e-6))[..., None]
    return seed_values(rgb.reshape(-1, 3)[pixels], settings)


def _spaced(seen):
    """Pixels of a mask, one in each of about `_PLACES` squares of the grid."""
    rows, cols = np.nonzero(seen)
    side = max(1.0, np.sqrt(len(rows) / _PLACES))
    square = (rows / side).astype(np.int64) * seen.shape[1] + (cols / side).astype(np.int64)
    # The middle pixel of each square, in reading order.
    order = np.argsort(square, kind="stable")
    first = np.flatnonzero(np.diff(square[order], prepend=-1))
    middle = (first + np.append(first[1:], len(order))) // 2
    chosen = order[middle]
    return rows[chosen] * seen.shape[1] + cols[chosen]
