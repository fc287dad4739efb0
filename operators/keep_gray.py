"""Have the next seeds keep the scan gray."""

import bpy

from .scene import polls
from .scene.editors import redraw_editors, select_only
from .scene.seed_colors import give_color
from .scene.seed_list import selected_seeds

NEUTRAL = (0.5, 0.5, 0.5)


class REFLCOLOR_OT_keep_gray(bpy.types.Operator):
    """Have the selected seeds, or those that are placed next, keep the scan gray around them"""

    bl_idname = "reflcolor.keep_gray"
    bl_label = "Keep Gray"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    def execute(self, context):
        seeds = polls.scan_object(context).reflcolor.seeds
        selected = [] if context.scene.reflcolor.picked else selected_seeds(polls.scan_object(context))
        for index in selected:
            give_color(seeds[index], NEUTRAL, None, (0, 0))
        if selected:
            select_only(seeds, [])
        else:
            context.scene.reflcolor.picked_color = NEUTRAL
        redraw_editors()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_keep_gray,)
