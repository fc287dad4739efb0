"""Turn Live Update off."""

import bpy

from .scene import polls
from .scene.texts import tip
from .window import live_update


class REFLCOLOR_OT_leave_preview(bpy.types.Operator):
    """Turn Live Update off, and show the colors that were there before"""

    bl_idname = "reflcolor.leave_preview"
    bl_label = "Leave Preview"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        on = context.window_manager.reflcolor.live_update
        return polls.nothing_missing(cls, None if on else tip("Turn Live Update on first"))

    def execute(self, context):
        context.window_manager.reflcolor.live_update = False
        return {"FINISHED"}


class ReflcolorWindow(bpy.types.PropertyGroup):
    """State of the window, not of the file: it is neither saved nor undone"""

    live_update: bpy.props.BoolProperty(
        name="Live Update",
        description="Color the scan anew whenever a seed or a setting changes, as a preview; "
        "Colorize keeps it, ESC or turning this off brings back what was there",
        options={"SKIP_SAVE"},
        update=lambda self, _context: live_update.switch(self.live_update),
    )


classes = (ReflcolorWindow, REFLCOLOR_OT_leave_preview)
pointers = ((bpy.types.WindowManager, "reflcolor", ReflcolorWindow),)
