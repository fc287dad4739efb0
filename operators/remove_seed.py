"""Remove a seed of a scan."""

import bpy

from .scene import polls
from .scene.reports import reported
from .scene.seed_list import SeedChoice, remove_seeds


class REFLCOLOR_OT_remove_seed(SeedChoice, bpy.types.Operator):
    """Remove a seed of the scan"""

    bl_idname = "reflcolor.remove_seed"
    bl_label = "Remove Seed"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_seeds(cls, context)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        remove_seeds(obj, [self.chosen(obj)])
        return {"FINISHED"}


classes = (REFLCOLOR_OT_remove_seed,)
