"""Show the reflectance image of a scan."""

import bpy

from .scene import polls
from .scene.editor_images import show_image


class REFLCOLOR_OT_open_reflectance(bpy.types.Operator):
    """Show the scan's reflectance in an Image Editor of this window, or in a new window if it has none"""

    bl_idname = "reflcolor.open_reflectance"
    bl_label = "Open Reflectance Image"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return polls.has_whole_scan(cls, context)

    def execute(self, context):
        image = polls.scan_object(context).reflcolor.reflectance_image
        if image is None:
            self.report({"ERROR"}, "The reflectance image was deleted; undo that, or import the scan again")
            return {"CANCELLED"}
        if not show_image(context, image) and context.window is not None:
            bpy.ops.wm.window_new()
            context.window_manager.windows[-1].screen.areas[0].type = "IMAGE_EDITOR"
            context.window_manager.windows[-1].screen.areas[0].spaces.active.image = image
        return {"FINISHED"}


classes = (REFLCOLOR_OT_open_reflectance,)
