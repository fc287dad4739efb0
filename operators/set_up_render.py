"""Set up camera and light for a picture of the scan."""

import bpy

from .scene import polls
from .scene.render import add_camera_and_lights


class REFLCOLOR_OT_set_up_render(bpy.types.Operator):
    """Add a camera that shows the whole scan, and even light, to the scene, and look through the camera; F12 renders"""

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
        add_camera_and_lights(context, obj)
        if context.area is not None and context.area.type == "VIEW_3D":
            context.area.spaces.active.region_3d.view_perspective = "CAMERA"
        return {"FINISHED"}


classes = (REFLCOLOR_OT_set_up_render,)
