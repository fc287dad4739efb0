"""Place a seed at a pixel of the scan, in the color that was picked before or is picked next."""

import bpy
from bpy.props import BoolProperty

from .scene import polls
from .scene.reports import reported
from .scene.seed_list import SeedPlace, place_seed, snapped_place
from .scene.texts import report_text
from .window.live_update import redraw_seeds


class REFLCOLOR_OT_place_seed(SeedPlace, bpy.types.Operator):
    """Place a seed; it has the picked color, or is given one by the next click in a photo"""

    bl_idname = "reflcolor.place_seed"
    bl_label = "Place Seed"
    bl_options = {"REGISTER", "UNDO"}

    snap: BoolProperty(
        name="Snap", description="Take the nearest pixel that has a return, where this one has none", default=True
    )

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        self.check_place(obj)
        row, col = snapped_place(obj, self.row, self.col) if self.snap else (self.row, self.col)
        place_seed(context, obj, row, col)
        redraw_seeds(obj)
        if (row, col) != (self.row, self.col):
            self.report({"INFO"}, report_text("No return there; placed at row {row}, column {col}", row=row, col=col))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_place_seed,)
