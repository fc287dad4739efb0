"""Select all seeds, or some by what they are."""

import bpy
from bpy.props import EnumProperty, FloatProperty

from .scene import polls
from .scene.editors import redraw_editors, select_only


class REFLCOLOR_OT_select_all_seeds(bpy.types.Operator):
    """Select all seeds, none, or those of one kind"""

    bl_idname = "reflcolor.select_all_seeds"
    bl_label = "Select All Seeds"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(
        name="Which",
        description="Seeds to select",
        items=(
            ("all", "All", "Every seed"),
            ("none", "None", "No seed"),
            ("found", "Found", "Seeds that were found in photos"),
            ("unsure", "Unsure", "Seeds that were found in photos with less than a given confidence"),
            ("uncolored", "Uncolored", "Seeds that wait for their color"),
        ),
    )
    below: FloatProperty(
        name="Below",
        description="Confidence of unsure seeds is below this",
        subtype="FACTOR",
        default=0.5,
        min=0,
        max=1,
    )

    @classmethod
    def poll(cls, context):
        return polls.has_seeds(cls, context)

    def execute(self, context):
        seeds = polls.scan_object(context).reflcolor.seeds
        wanted = {
            "all": lambda seed: True,
            "none": lambda seed: False,
            "found": lambda seed: seed.reason != "hand",
            "unsure": lambda seed: seed.reason != "hand" and seed.confidence < self.below,
            "uncolored": lambda seed: not seed.has_color,
        }[self.which]
        select_only(seeds, [index for index, seed in enumerate(seeds) if wanted(seed)])
        redraw_editors()
        return {"FINISHED"}


classes = (REFLCOLOR_OT_select_all_seeds,)
