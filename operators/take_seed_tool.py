"""Take the Seeds tool, to place seeds by clicks."""

import bpy

from .scene import polls
from .window.tools import take_tools


class REFLCOLOR_OT_take_seed_tool(bpy.types.Operator):
    """Take the Seeds tool: a click on the scan, in its image or on its mesh, places a seed in the tool's color"""

    bl_idname = "reflcolor.take_seed_tool"
    bl_label = "Place Seeds"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return polls.has_window(cls, context) and polls.has_own_scan(cls, context)

    def execute(self, context):
        take_tools(context.window)
        self.report({"INFO"}, "Click on the scan to place a seed")
        return {"FINISHED"}


classes = (REFLCOLOR_OT_take_seed_tool,)
