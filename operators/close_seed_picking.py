"""Leave the workspace to pick seeds in."""

import bpy

from .scene import polls
from .scene.texts import tip
from .window import seed_picking


class REFLCOLOR_OT_close_seed_picking(bpy.types.Operator):
    """Go back to the workspace that was there before, and remove this one"""

    bl_idname = "reflcolor.close_seed_picking"
    bl_label = "Close Seed Picking"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return polls.nothing_missing(cls, None if seed_picking.is_open(context) else tip("Open Seed Picking first"))

    def execute(self, context):
        seed_picking.close_seed_picking(context)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_close_seed_picking,)
