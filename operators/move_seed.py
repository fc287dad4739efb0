"""Move a seed of a scan."""

from contextlib import suppress

import bpy

from ..reflcolor_addon.errors import SeedsError
from .scene import polls
from .scene.reports import reported
from .scene.seed_list import SeedChoice, SeedPlace


class REFLCOLOR_OT_move_seed(SeedChoice, SeedPlace, bpy.types.Operator):
    """Move a seed to another pixel of the scan; its color stays"""

    bl_idname = "reflcolor.move_seed"
    bl_label = "Move Seed"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_seeds(cls, context)

    def invoke(self, context, _event):
        obj = polls.scan_object(context)
        with suppress(SeedsError):  # execute() reports it
            seed = obj.reflcolor.seeds[self.chosen(obj)]
            self.row, self.col = seed.row, seed.col
        return context.window_manager.invoke_props_dialog(self)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        seed = obj.reflcolor.seeds[self.chosen(obj)]
        self.check_place(obj)
        seed.row, seed.col = self.row, self.col
        return {"FINISHED"}


classes = (REFLCOLOR_OT_move_seed,)
