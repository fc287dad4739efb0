"""Place a seed at a pixel of the scan, in the color that was picked before or is picked next."""

import bpy
from bpy.props import BoolProperty

from . import polls
from .editors import select_only
from .live_update import redraw_seeds
from .quiet import point_to, write_quietly
from .reports import reported
from .seed_list import SeedPlace, append_seed, snapped_place
from .texts import told


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
            self.report({"INFO"}, told("No return there; placed at row {row}, column {col}", row=row, col=col))
        return {"FINISHED"}


def place_seed(context, obj, row, col):
    """Add a seed in the picked color; without one it waits for its color, selected."""
    settings = context.scene.reflcolor
    if not settings.picked:
        color = settings.bl_rna.properties["picked_color"].default_array[:]
        write_quietly(append_seed(obj, row, col, color), has_color=False)
        return
    append_seed(obj, row, col, settings.picked_color, settings.picked_photo, settings.picked_xy)
    select_only(obj.reflcolor.seeds, [])
    # The point of the photo is that of one place only; the color may be that of many.
    point_to(settings, picked_photo=None)


classes = (REFLCOLOR_OT_place_seed,)
