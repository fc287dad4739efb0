"""Do what a click in an Image Editor means."""

import bpy
from bpy.props import EnumProperty

from ..reflcolor_addon.view.picking import clamped_point
from .scene.editor_images import event_side
from .scene.reports import call
from .scene.texts import report_text


class REFLCOLOR_OT_pick(bpy.types.Operator):
    """Click in the reflectance image to place a seed, in a photo to pick its color, on a seed to select it"""

    bl_idname = "reflcolor.pick"
    bl_label = "Pick Seed or Color"
    bl_options = {"INTERNAL"}

    act: EnumProperty(
        name="Act",
        description="What to do at the pointer",
        items=(
            ("pick", "Pick", "Place or select a seed, or pick a color"),
            ("extend", "Extend", "Add a seed to what is selected, or take it off"),
            ("delete", "Delete", "Delete the seed"),
            ("sample", "Sample", "Take the color for the next seeds"),
        ),
    )

    def invoke(self, context, event):
        side, place = event_side(context), (event.mouse_region_x, event.mouse_region_y)
        if side is None:
            self.report({"INFO"}, "Import a scan, and show its reflectance image or a photo here")
            return {"CANCELLED"}
        if context.view_layer.objects.get(side.obj.name) is None:
            self.report({"WARNING"}, report_text("{name} is not in this view layer", name=side.obj.name))
            return {"CANCELLED"}
        side.activate(context)
        hit = side.hit(place) if self.act != "sample" else None
        if self.act == "delete":
            return {"CANCELLED"} if hit is None else call(self, bpy.ops.reflcolor.remove_seed, index=hit)
        if hit is not None:
            extend = self.act == "extend"
            return call(self, bpy.ops.reflcolor.select_seed, index=hit, extend=extend)
        if self.act == "extend":
            return {"CANCELLED"}
        xy = side.view.to_image(place)
        if tuple(xy) != clamped_point(xy, side.image.size):
            # A click beside the image deselects all, as in other editors.
            return (
                call(self, bpy.ops.reflcolor.select_all_seeds, which="none") if side.marks()[0].size else {"CANCELLED"}
            )
        if self.act == "pick" and side.is_scan:
            row, col = side.pixel(place)
            return call(self, bpy.ops.reflcolor.place_seed, row=row, col=col)
        sample = side.is_scan or self.act == "sample"
        return call(self, bpy.ops.reflcolor.pick_color, photo=side.image.name, photo_xy=xy, sample_only=sample)


classes = (REFLCOLOR_OT_pick,)
