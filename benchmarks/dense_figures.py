"""Figures of colors that photos saw: of one picture against the truth, and of plain projection."""

import numpy as np

from reflcolor_addon.color.evaluation import error_map
from reflcolor_addon.matching.opened_photos import opened_photos
from reflcolor_addon.matching.transfer.occlusion import DepthBuffer
from reflcolor_addon.matching.transfer.surface import GridSurface
from reflcolor_addon.matching.transfer.views import colors_at, sighted
from reflcolor_addon.srgb import linear_to_srgb8, srgb8_to_linear

# What the range may differ by between neighbors of one surface, as a logarithm.
_ONE_SURFACE = 0.03


def projected(pair, matching):
    """Return the colors that photos project onto the scan by a depth buffer alone, and where they do."""
    scan, surface = pair.scan, GridSurface(pair.scan)
    rgb, shown = np.zeros((*scan.shape, 3), np.uint8), np.zeros(scan.shape, bool)
    for photo, found in zip(opened_photos(pair.photos), matching.photos, strict=True):
        if not found.verified:
            continue
        model, sight = found.model, sighted(found.model, surface)
        inside = ((sight.xy >= 0) & (sight.xy < [model.width, model.height])).all(axis=-1)
        if model.kind == "pose":
            buffer = DepthBuffer.of(model, sight.xy, sight.depth, surface.quads)
            slope = np.full(np.count_nonzero(inside), 0.01, np.float32) * sight.depth[inside]
            inside[inside] = buffer.sees(sight.xy[inside], sight.depth[inside], slope)
        inside &= ~shown
        rgb[inside] = colors_at(photo, sight.xy[inside], np.ones(np.count_nonzero(inside), np.float32))
        shown |= inside
    return rgb, shown


def error(rgb, truth, where):
    """Mean CIEDE2000; not a number where nothing is to be compared."""
    return float(error_map(rgb, truth, where)[where].mean()) if where.any() else np.nan


def lit(rgb, truth, where):
    """The colors with three gains of linear light, which bring the middle of each channel's ratios to 1."""
    sound = where & ((rgb >= 12) & (rgb <= 245) & (truth >= 12) & (truth <= 245)).all(axis=-1)
    if not sound.any():
        return rgb
    gains = np.median(srgb8_to_linear(truth[sound]) / srgb8_to_linear(rgb[sound]), axis=0)
    return linear_to_srgb8(np.clip(srgb8_to_linear(rgb) * gains, 0, 1))


def step(rgb, seen, scan, known):
    """Mean distance in CIELAB between neighbors of one surface of which one was seen and the other was not."""
    along, _ = steps(rgb, seen, scan, known)
    return along.mean() if len(along) else np.nan


def steps(rgb, seen, scan, known):
    """Distances in CIELAB between neighbors of which one was seen and the other was not: those of one surface, and
    those across a jump in range."""
    from skimage.color import rgb2lab

    lab, logarithm = rgb2lab(rgb), np.log(np.maximum(scan.range, 1e-6))
    along, across = [], []
    for axis in (0, 1):
        length = rgb.shape[axis]
        parts = [
            [np.take(image, index, axis) for image in (seen, known)] for index in (range(length - 1), range(1, length))
        ]
        border = (parts[0][0] != parts[1][0]) & parts[0][1] & parts[1][1]
        smooth = np.abs(np.diff(logarithm, axis=axis)) < _ONE_SURFACE
        distance = np.linalg.norm(np.diff(lab, axis=axis), axis=-1)
        along.append(distance[border & smooth])
        across.append(distance[border & ~smooth])
    return np.concatenate(along), np.concatenate(across)
