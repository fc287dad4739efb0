"""Take seeds from the colors that came with a scan."""

import bpy
from bpy.props import IntProperty

from ..reflcolor_addon.seeds.scan_colors import MOST_SEEDS, seeds_from_color
from .match_photos import take_over_seeds
from .scene import polls
from .scene.reports import reported
from .scene.scan_object import SCANNED, scan_of
from .scene.texts import report_text, tip
from .window.live_update import redraw_seeds


class REFLCOLOR_OT_seeds_from_color(bpy.types.Operator):
    """Take seeds, spread evenly, from the colors that came with the scan; hand-picked and locked ones stay"""

    bl_idname = "reflcolor.seeds_from_color"
    bl_label = "Seeds from Scan's Colors"
    bl_options = {"REGISTER", "UNDO"}

    count: IntProperty(
        name="Count", description="How many seeds to take", default=200, min=1, soft_max=2000, max=MOST_SEEDS
    )

    @classmethod
    def poll(cls, context):
        if not polls.has_own_scan(cls, context):
            return False
        colored = SCANNED in polls.scan_object(context).data.color_attributes
        return polls.nothing_missing(cls, None if colored else tip("The scan came without colors"))

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        seeds = seeds_from_color(scan_of(obj, colors=SCANNED), self.count)
        take_over_seeds(obj, seeds)
        redraw_seeds(obj)
        self.report(
            {"INFO"}, report_text("Took {count} seeds from the colors of {name}", count=len(seeds), name=obj.name)
        )
        return {"FINISHED"}


classes = (REFLCOLOR_OT_seeds_from_color,)
