"""Lock the selected seeds, or let them go."""

import bpy
from bpy.props import BoolProperty

from .scene import polls
from .scene.editors import redraw_editors
from .scene.seed_list import selected_seeds


class REFLCOLOR_OT_lock_seeds(bpy.types.Operator):
    """Keep the selected seeds when the photos are matched again"""

    bl_idname = "reflcolor.lock_seeds"
    bl_label = "Lock Seeds"
    bl_options = {"REGISTER", "UNDO"}

    unlock: BoolProperty(name="Unlock", description="Let the selected seeds be replaced")

    @classmethod
    def poll(cls, context):
        return polls.has_selected_seeds(cls, context)

    def execute(self, context):
        obj = polls.scan_object(context)
        for index in selected_seeds(obj):
            obj.reflcolor.seeds[index].locked = not self.unlock
        redraw_editors()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_lock_seeds,)
