"""Lay out a workspace to pick seeds in."""

import bpy

from .scene import polls
from .window import seed_picking


class REFLCOLOR_OT_open_seed_picking(bpy.types.Operator):
    """Lay out the reflectance image, a photo and the mesh side by side, in a workspace of its own"""

    bl_idname = "reflcolor.open_seed_picking"
    bl_label = "Open Seed Picking"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return polls.has_window(cls, context) and polls.has_whole_scan(cls, context)

    def execute(self, context):
        seed_picking.open_seed_picking(context, polls.scan_object(context))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_open_seed_picking,)
