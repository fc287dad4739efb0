"""Copy where a scan's colors are from."""

import bpy

from .scene import polls
from .scene.provenance import provenance_text
from .scene.texts import tip


class REFLCOLOR_OT_copy_provenance(bpy.types.Operator):
    """Copy the whole report on the scan's colors, as JSON, to the clipboard"""

    bl_idname = "reflcolor.copy_provenance"
    bl_label = "Copy Provenance"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        if not polls.has_scan(cls, context):
            return False
        missing = tip("Colorize the scan first") if provenance_text(polls.scan_object(context)) is None else None
        return polls.nothing_missing(cls, missing)

    def execute(self, context):
        context.window_manager.clipboard = provenance_text(polls.scan_object(context))
        self.report({"INFO"}, "Copied the report to the clipboard")
        return {"FINISHED"}


classes = (REFLCOLOR_OT_copy_provenance,)
