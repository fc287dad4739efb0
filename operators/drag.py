"""Do what a drag in an Image Editor means."""

import bpy

from ..reflcolor_addon.view.picking import clamped_point
from .scene.editor_images import event_side
from .window.drag_seeds import DragSeeds
from .window.pointer import PointerOperator
from .window.stroke_seeds import StrokeSeeds


class REFLCOLOR_OT_drag(PointerOperator, bpy.types.Operator):
    """Move the seed that is dragged, with all that are selected if it is, or lay a line of seeds where there is none"""

    bl_idname = "reflcolor.drag"
    bl_label = "Move Seeds or Stroke"
    bl_options = {"UNDO", "BLOCKING", "INTERNAL"}
    hint = "Move Seeds or Stroke"

    def begin(self, context, place):
        side = event_side(context)
        if side is None:
            return None
        hit, xy = side.hit(place), side.view.to_image(place)
        if hit is None and (not side.is_scan or tuple(xy) != clamped_point(xy, side.image.size)):
            return None
        side.activate(context)
        return StrokeSeeds(context, side, place) if hit is None else DragSeeds(side, hit, place)


classes = (REFLCOLOR_OT_drag,)
