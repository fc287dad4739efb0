"""Delete the selected seeds."""

import bpy

from .scene import polls
from .scene.editors import redraw_editors
from .scene.seed_list import remove_seeds, selected_seeds
from .scene.texts import report_text


class REFLCOLOR_OT_delete_seeds(bpy.types.Operator):
    """Delete the selected seeds"""

    bl_idname = "reflcolor.delete_seeds"
    bl_label = "Delete Seeds"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_selected_seeds(cls, context)

    def execute(self, context):
        obj = polls.scan_object(context)
        doomed = selected_seeds(obj)
        remove_seeds(obj, doomed)
        redraw_editors()
        self.report({"INFO"}, report_text("Deleted {count} seeds", count=len(doomed)))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_delete_seeds,)
