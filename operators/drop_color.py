"""Let go of the picked color."""

import bpy

from .scene import polls
from .scene.editors import redraw_editors
from .scene.texts import tip


class REFLCOLOR_OT_drop_color(bpy.types.Operator):
    """Let go of the picked color; the next seed waits for its own"""

    bl_idname = "reflcolor.drop_color"
    bl_label = "Drop Color"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.nothing_missing(cls, None if context.scene.reflcolor.picked else tip("Pick a color first"))

    def execute(self, context):
        settings = context.scene.reflcolor
        settings.picked, settings.picked_photo = False, None
        redraw_editors()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_drop_color,)
