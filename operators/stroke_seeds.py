"""Lay a line of seeds of one color by a stroke."""

import bpy

from ..reflcolor_addon.picking import beads, clamped_point
from .editors import redraw_editors, select_only
from .image_sides import event_side
from .place_seed import place_seed
from .pointer import PointerOperator, object_named
from .seed_list import remove_seeds, snapped_place


class REFLCOLOR_OT_stroke_seeds(PointerOperator, bpy.types.Operator):
    """Lay a line of seeds in the picked color, or all to be colored by the next click in a photo"""

    bl_idname = "reflcolor.stroke_seeds"
    bl_label = "Stroke of Seeds"
    bl_options = {"UNDO", "BLOCKING"}
    hint = "Stroke of Seeds"

    def begin(self, context, place):
        side = event_side(context)
        if side is None or not side.is_scan:
            return False
        xy = side.view.to_image(place)
        if tuple(xy) != clamped_point(xy, side.image.size):
            return False
        context.view_layer.objects.active = side.obj
        self._object, self._view, self._last = side.obj.name, side.view, xy
        self._count_before, self._photo = len(side.obj.reflcolor.seeds), context.scene.reflcolor.picked_photo
        self._place(context, side.obj, xy)
        return True

    def follow(self, context, place):
        obj = object_named(self._object)
        if obj is None:
            self.lost = True
            return
        size = obj.reflcolor.cols, obj.reflcolor.rows
        target = clamped_point(self._view.to_image(place), size)
        for xy in beads(self._last, target, context.scene.reflcolor.stroke_spacing):
            self._last = tuple(xy)
            self._place(context, obj, self._last)

    def finish(self, context):
        obj = object_named(self._object)
        if obj is None or len(obj.reflcolor.seeds) == self._count_before:
            return False
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
        rows, cols = obj.reflcolor.rows, obj.reflcolor.cols
        row, col = snapped_place(obj, min(int(xy[1]), rows - 1), min(int(xy[0]), cols - 1))
        if not any((seed.row, seed.col) == (row, col) for seed in obj.reflcolor.seeds[self._count_before :]):
            place_seed(context, obj, row, col)


classes = (REFLCOLOR_OT_stroke_seeds,)
