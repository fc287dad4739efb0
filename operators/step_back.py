"""Do what ESC means while seeds are picked."""

import bpy


class REFLCOLOR_OT_step_back(bpy.types.Operator):
    """Let go of the picked color or, if there is none, leave the preview of Live Update"""

    bl_idname = "reflcolor.step_back"
    bl_label = "Drop Color or Preview"
    bl_options = {"INTERNAL"}

    def invoke(self, context, _event):
        if context.scene.reflcolor.picked:
            return bpy.ops.reflcolor.drop_color("EXEC_DEFAULT", True)
        if context.window_manager.reflcolor.live_update:
            return bpy.ops.reflcolor.leave_preview("EXEC_DEFAULT")
        return {"PASS_THROUGH"}


classes = (REFLCOLOR_OT_step_back,)
