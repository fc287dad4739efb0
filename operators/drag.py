"""Do what a drag in an Image Editor means."""

import bpy

from .image_sides import event_side
from .pointer import pressed_at


class REFLCOLOR_OT_drag(bpy.types.Operator):
    """Drag a seed to move it; drag elsewhere in the reflectance image to lay a line of seeds"""

    bl_idname = "reflcolor.drag"
    bl_label = "Move Seeds or Stroke"
    bl_options = {"INTERNAL"}

    def invoke(self, context, event):
        side = event_side(context)
        if side is None:
            return {"PASS_THROUGH"}
        if side.hit(pressed_at(context.region, event)) is not None:
            return bpy.ops.reflcolor.drag_seeds("INVOKE_DEFAULT", True)
        return bpy.ops.reflcolor.stroke_seeds("INVOKE_DEFAULT", True) if side.is_scan else {"CANCELLED"}


classes = (REFLCOLOR_OT_drag,)
