"""Copy a message of the list."""

import bpy

from .show_notice import NoticeChoice


class REFLCOLOR_OT_copy_notice(NoticeChoice, bpy.types.Operator):
    """Copy the whole message to the clipboard"""

    bl_idname = "reflcolor.copy_notice"
    bl_label = "Copy Message"
    bl_options = {"REGISTER"}

    def execute(self, context):
        context.window_manager.clipboard = self.notice(context).text
        return {"FINISHED"}


classes = (REFLCOLOR_OT_copy_notice,)
