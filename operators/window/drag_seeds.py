"""Dragging seeds in the reflectance image, or the points that their colors are from in a photo."""

import bpy

from ...reflcolor_addon.view.picking import clamped_pixel, clamped_point
from ..scene.editors import redraw_editors
from ..scene.images import read_pixel
from ..scene.quiet import write_quietly
from ..scene.seed_arrays import FOUND_BY
from ..scene.seed_list import choose_seed, selected_seeds, snapped_place
from .pointer import object_named


class DragSeeds:
    """One drag of the selected seeds, as `PointerOperator` asks for it.

    Parameters
    ----------
    side : EditorImage
        What the pointer is over.
    hit : int
        The seed that was taken hold of.
    place : (x, y)
        Of the region.
    """

    def __init__(self, side, hit, place):
        seeds = side.obj.reflcolor.seeds
        if not seeds[hit].select:
            choose_seed(side.obj, hit)
        here = side.marks()[1]
        self._object, self._image, self._is_scan = side.obj.name, side.image.name, side.is_scan
        self._view, self._start = side.view, side.view.to_image(place)
        self._before = {index: _state(seeds[index]) for index in selected_seeds(side.obj) if here[index]}

    def follow(self, _context, place):
        obj, image = object_named(self._object), bpy.data.images.get(self._image)
        if obj is None or image is None or max(self._before) >= len(obj.reflcolor.seeds):
            return False
        x, y = self._view.to_image(place)
        dx, dy = x - self._start[0], y - self._start[1]
        shape = obj.reflcolor.rows, obj.reflcolor.cols
        for index, (row, col, xy, *_) in self._before.items():
            seed = obj.reflcolor.seeds[index]
            if self._is_scan:
                row, col = clamped_pixel((col + 0.5 + dx, row + 0.5 + dy), shape)
                write_quietly(seed, row=row, col=col)
            else:
                point = clamped_point((xy[0] + dx, xy[1] + dy), image.size)
                color = read_pixel(image, *point)
                write_quietly(seed, photo_xy=point, **({} if color is None else {"color": color, "has_color": True}))
        redraw_editors()
        return True

    def finish(self, _context):
        obj = object_named(self._object)
        for index in self._before:
            seed = obj.reflcolor.seeds[index]
            if self._is_scan:
                row, col = snapped_place(obj, seed.row, seed.col)
                write_quietly(seed, row=row, col=col)
            # The user now decides where it belongs.
            write_quietly(seed, reason=FOUND_BY.index("hand"), confidence=1.0)
        redraw_editors()
        return True

    def give_up(self, _context):
        obj = object_named(self._object)
        for index, (row, col, xy, color, has_color) in self._before.items() if obj is not None else ():
            if index < len(obj.reflcolor.seeds):
                seed = obj.reflcolor.seeds[index]
                write_quietly(seed, row=row, col=col, photo_xy=xy, color=color, has_color=has_color)
        redraw_editors()


def _state(seed):
    return seed.row, seed.col, tuple(seed.photo_xy), tuple(seed.color), seed.has_color
