"""Delete the selected seeds with a key, and never anything else."""

import bpy

from .scene import polls
from .scene.reports import call
from .scene.texts import report_text


class REFLCOLOR_OT_delete_picked(bpy.types.Operator):
    """Delete the selected seeds; where none is selected, nothing, lest the scan itself be deleted"""

    bl_idname = "reflcolor.delete_picked"
    bl_label = "Delete Picked Seeds"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        return polls.has_scan(cls, context)

    def invoke(self, context, _event):
        if bpy.ops.reflcolor.delete_seeds.poll():
            return call(self, bpy.ops.reflcolor.delete_seeds)
        self.report({"INFO"}, report_text("Select a seed first"))
        return {"CANCELLED"}


classes = (REFLCOLOR_OT_delete_picked,)
