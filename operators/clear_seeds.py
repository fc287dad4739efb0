"""Remove all seeds of a scan."""

import bpy

from .scene import polls


class REFLCOLOR_OT_clear_seeds(bpy.types.Operator):
    """Remove all seeds of the scan"""

    bl_idname = "reflcolor.clear_seeds"
    bl_label = "Clear Seeds"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_seeds(cls, context)

    def execute(self, context):
        polls.scan_object(context).reflcolor.seeds.clear()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_clear_seeds,)
