"""Add a seed to a scan."""

import bpy
from bpy.props import FloatVectorProperty, StringProperty

from ..reflcolor_addon.errors import SeedsError
from .scene import polls
from .scene.images import read_pixel
from .scene.reports import reported
from .scene.seed_list import SeedPlace, append_seed
from .scene.texts import NO_COLOR


class REFLCOLOR_OT_add_seed(SeedPlace, bpy.types.Operator):
    """Add a pixel of the scan whose color is known, given directly or by a point of a photo"""

    bl_idname = "reflcolor.add_seed"
    bl_label = "Add Seed"
    bl_options = {"REGISTER", "UNDO"}

    color: FloatVectorProperty(
        name="Color",
        description="Color of the scan at this pixel",
        subtype="COLOR_GAMMA",
        min=0,
        max=1,
        size=3,
        default=(0.5, 0.5, 0.5),
    )
    photo: StringProperty(
        name="Photo",
        description="Name of a loaded photo; its color at Point is taken if given",
        options={"SKIP_SAVE"},
    )
    photo_xy: FloatVectorProperty(
        name="Point", description="Place in the photo, in pixels from its top left corner", size=2
    )

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    def invoke(self, context, _event):
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("row", "col", "color"):
            layout.prop(self, name)
        layout.prop_search(self, "photo", bpy.data, "images")
        if self.photo:
            layout.prop(self, "photo_xy")

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        self.check_place(obj)
        photo, color = bpy.data.images.get(self.photo) if self.photo else None, self.color
        if self.photo:
            color = read_pixel(photo, *self.photo_xy) if photo is not None else None
            if color is None:
                x, y = self.photo_xy
                raise SeedsError(NO_COLOR, photo=self.photo, x=x, y=y)
        append_seed(obj, self.row, self.col, color, photo, self.photo_xy)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_add_seed,)
