"""Set up camera and light for a picture of the scan."""

import bpy

from .scene import polls
from .scene.render import look_through_camera, set_up_picture


class REFLCOLOR_OT_set_up_render(bpy.types.Operator):
    """Have renders show the scans only, through a camera that has the whole scan in its picture; F12 renders"""

    bl_idname = "reflcolor.set_up_render"
    bl_label = "Set Up Render"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_scan(cls, context)

    def execute(self, context):
        obj = polls.scan_object(context)
        if not len(obj.data.vertices):
            self.report({"WARNING"}, "The scan has no points to show")
            return {"CANCELLED"}
        set_up_picture(context, obj, context.scene.reflcolor.picture_look)
        if context.area is not None and context.area.type == "VIEW_3D":
            look_through_camera(context, context.area)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_set_up_render,)
