"""Select a seed."""

import bpy
from bpy.props import BoolProperty

from .scene import polls
from .scene.editors import redraw_editors
from .scene.quiet import write_quietly
from .scene.reports import reported
from .scene.seed_list import SeedChoice, choose_seed


class REFLCOLOR_OT_select_seed(SeedChoice, bpy.types.Operator):
    """Select a seed; the next click in a photo gives it its color"""

    bl_idname = "reflcolor.select_seed"
    bl_label = "Select Seed"
    bl_options = {"REGISTER", "UNDO"}

    extend: BoolProperty(name="Extend", description="Keep what is selected; a selected seed is deselected")

    @classmethod
    def poll(cls, context):
        return polls.has_seeds(cls, context)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        index = self.chosen(obj)
        settings, seed = context.scene.reflcolor, obj.reflcolor.seeds[index]
        settings.picked, settings.picked_photo = False, None
        if self.extend:
            write_quietly(seed, select=not seed.select)
        else:
            choose_seed(obj, index)
        redraw_editors()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_select_seed,)
