"""Laying a line of seeds of one color by a stroke."""

from ...reflcolor_addon.view.picking import beads, clamped_pixel, clamped_point
from ..scene.editors import redraw_editors, select_only
from ..scene.seed_list import place_seed, remove_seeds, snapped_place
from .pointer import object_named


class StrokeSeeds:
    """One stroke, as `PointerOperator` asks for it: seeds in the picked color, or to be colored by the next click.

    Parameters
    ----------
    context : bpy.types.Context
    side : EditorImage
        The scan's image that the pointer is over.
    place : (x, y)
        Of the region.
    """

    def __init__(self, context, side, place):
        self._object, self._view = side.obj.name, side.view
        self._last = clamped_point(side.view.to_image(place), side.image.size)
        self._count_before, self._photo = len(side.obj.reflcolor.seeds), context.scene.reflcolor.picked_photo
        self._place(context, side.obj, self._last)

    def follow(self, context, place):
        obj = object_named(self._object)
        if obj is None:
            return False
        size = obj.reflcolor.cols, obj.reflcolor.rows
        target = clamped_point(self._view.to_image(place), size)
        for xy in beads(self._last, target, context.scene.reflcolor.stroke_spacing):
            self._last = tuple(xy)
            self._place(context, obj, self._last)
        redraw_editors()
        return True

    def finish(self, context):
        obj = object_named(self._object)
        if not context.scene.reflcolor.picked:
            select_only(obj.reflcolor.seeds, range(self._count_before, len(obj.reflcolor.seeds)))
        redraw_editors()
        return True

    def give_up(self, context):
        obj = object_named(self._object)
        if obj is not None:
            remove_seeds(obj, range(self._count_before, len(obj.reflcolor.seeds)))
            if context.scene.reflcolor.picked:
                context.scene.reflcolor.picked_photo = self._photo
        redraw_editors()

    def _place(self, context, obj, xy):
        row, col = snapped_place(obj, *clamped_pixel(xy, (obj.reflcolor.rows, obj.reflcolor.cols)))
        if not any((seed.row, seed.col) == (row, col) for seed in obj.reflcolor.seeds[self._count_before :]):
            place_seed(context, obj, row, col)
