"""The legend of a map, drawn in the corner of the 3D View."""

import math
from functools import lru_cache

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ...reflcolor_addon.view.colormaps import UNKNOWN, gradient, region_colors
from ..scene import polls
from ..scene.looks import LEGEND, LOOKS, shown_look
from ..scene.texts import label

# In pixels at a UI scale of 1.
_WIDTH, _BAR, _MARGIN, _PAD, _TEXT = 220, 14, 20, 10, 12
_STEPS = 64
_REGIONS_SHOWN = 12
_PLATE, _INK = (0.05, 0.05, 0.05, 0.72), (1.0, 1.0, 1.0, 1.0)
_handles = []


def register():
    _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def unregister():
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def legend_of(obj):
    """Return what the legend of an object's map says, or None where it shows no map.

    Returns
    -------
    dict
        ``title``; ``colors``, a list of (r, g, b) of 0..1 from left to right, even (``smooth``) or in steps;
        ``labels``, under the bar from left to right; ``unknown``, what the gray of no value means, or None.
    """
    identifier = shown_look(obj)
    stored = obj.data.get(LEGEND)
    if identifier is None or LOOKS[identifier].values is None or stored is None or len(stored) != 3:
        return None
    look, (low, high, unknown) = LOOKS[identifier], stored
    if look.gradient is None:
        count = int(high)
        colors, smooth = _region_colors(min(count, _REGIONS_SHOWN)), False
        shown = min(count, _REGIONS_SHOWN)
        last = f"{count}" if shown == count else label("{shown} of {count}", shown=shown, count=count)
        labels = (label(look.region, number=1), last)
    else:
        colors, smooth = _gradient_colors(look.gradient), True
        labels = tuple(number(value, high - low) for value in (low, (low + high) / 2, high))
    title = f"{label(look.title)} ({look.unit})" if look.unit else label(look.title)
    gray = label(look.unknown)
    return {"title": title, "colors": colors, "smooth": smooth, "labels": labels, "unknown": gray if unknown else None}


def number(value, span):
    """Return a value as text, with as many decimals as the range of values needs."""
    decimals = 2 if span <= 0 else min(max(0, 2 - math.floor(math.log10(span))), 6)
    return f"{value:.{decimals}f}"


@lru_cache
def _gradient_colors(name):
    steps = gradient(name)[:: 256 // _STEPS] / 255
    return [tuple(color) for color in steps.tolist()]


@lru_cache
def _region_colors(count):
    return [tuple(color) for color in (region_colors(range(count)) / 255).tolist()]


def _draw():
    context = bpy.context
    obj, space = polls.scan_object(context), context.space_data
    if obj is None or not space.overlay.show_overlays or not obj.visible_get():
        return
    if space.shading.type != "SOLID" or space.shading.color_type != "VERTEX":
        return
    legend = legend_of(obj)
    if legend is not None:
        _draw_legend(legend, _right_edge(context.area, context.region), context.preferences.system.ui_scale)


def _right_edge(area, region):
    """Where the part of the region that no sidebar lies over ends."""
    covered = [
        other.x - region.x
        for other in area.regions
        if other.type == "UI" and other.width > 1 and other.alignment == "RIGHT" and other.x < region.x + region.width
    ]
    return min([region.width, *covered])


def _draw_legend(legend, right_edge, scale):
    width, bar, pad, size = (value * scale for value in (_WIDTH, _BAR, _PAD, _TEXT))
    line = size * 1.5
    left, bottom = right_edge - width - _MARGIN * scale, _MARGIN * scale
    lines = 3 if legend["unknown"] else 2
    gpu.state.blend_set("ALPHA")
    _rectangle(left - pad, bottom - pad, left + width + pad, bottom + lines * line + bar + pad, _PLATE)
    floor = bottom
    if legend["unknown"]:
        _rectangle(left, floor, left + bar, floor + size, (*(level / 255 for level in UNKNOWN), 1.0))
        _text(legend["unknown"], left + bar + pad, floor + size * 0.1, size)
        floor += line
    _labels(legend["labels"], left, left + width, floor + size * 0.1, size)
    floor += line
    _bar(legend["colors"], legend["smooth"], left, floor - size * 0.3, width, bar)
    _text(legend["title"], left, floor + bar + size * 0.2, size)
    gpu.state.blend_set("NONE")


def _rectangle(left, bottom, right, top, color):
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    corners = [(left, bottom), (right, bottom), (left, top), (right, top)]
    shader.uniform_float("color", color)
    batch_for_shader(shader, "TRI_STRIP", {"pos": corners}).draw(shader)


def _bar(colors, smooth, left, bottom, width, height):
    """Colors side by side: smooth from one to the next, or each over its own stretch."""
    count = len(colors)
    places, inks = [], []
    for index, color in enumerate(colors):
        share = (index / (count - 1), index / (count - 1)) if smooth else (index / count, (index + 1) / count)
        for x in share[:1] if smooth else share:
            places += [(left + width * x, bottom), (left + width * x, bottom + height)]
            inks += [(*color, 1.0)] * 2
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch_for_shader(shader, "TRI_STRIP", {"pos": places, "color": inks}).draw(shader)


def _labels(labels, left, right, bottom, size):
    """Texts under the bar: the first at its left end, the last at its right end, others between."""
    blf.size(0, size)
    for index, text in enumerate(labels):
        share = index / (len(labels) - 1)
        _text(text, left + (right - left - blf.dimensions(0, text)[0]) * share, bottom, size)


def _text(text, left, bottom, size):
    blf.size(0, size)
    blf.color(0, *_INK)
    blf.position(0, left, bottom, 0)
    blf.draw(0, text)
