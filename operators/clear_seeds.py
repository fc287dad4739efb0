"""Remove all seeds of a scan, and what photos saw of it."""

import bpy

from .scene import polls
from .scene.photo_colors import keep_observed


class REFLCOLOR_OT_clear_seeds(bpy.types.Operator):
    """Remove all seeds of the scan, and the colors that photos saw of it"""

    bl_idname = "reflcolor.clear_seeds"
    bl_label = "Clear Seeds"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_seeds(cls, context)

    def execute(self, context):
        obj = polls.scan_object(context)
        obj.reflcolor.seeds.clear()
        keep_observed(obj, None)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_clear_seeds,)
