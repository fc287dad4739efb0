"""Have renders show the scans as a camera of their own sees them."""

import bpy

from ..reflcolor_addon.errors import ScanError
from ..reflcolor_addon.progress import part
from .scene import polls
from .scene.properties import scene_picture
from .scene.render import fillable_scans, look_through_camera, set_up_picture
from .scene.scan_object import grid_indices
from .scene.shown_surface import surface_maker
from .scene.texts import report_text
from .window.jobs import JobOperator


class REFLCOLOR_OT_set_up_render(JobOperator, bpy.types.Operator):
    """Have renders show the scans only, through a camera that has the whole scan in its picture; F12 renders"""

    bl_idname = "reflcolor.set_up_render"
    bl_label = "Set Up Render"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Set Up Render"

    @classmethod
    def poll(cls, context):
        return polls.has_scan(cls, context)

    def prepare(self, context):
        obj, self._picture = polls.scan_object(context), scene_picture(context.scene)
        if not len(obj.data.vertices):
            raise ScanError("{name}: the scan has no points to show", name=obj.name)
        self._name = obj.name
        makers = {
            scan.name: surface_maker(scan, drop_mixed=self._picture.drop_mixed)
            for scan in (fillable_scans(context.scene) if self._picture.filled else ())
        }

        def work(progress, cancelled):
            return {
                name: make(part(progress, number, len(makers), name), cancelled)
                for number, (name, make) in enumerate(makers.items())
            }

        return work

    def finish(self, context, surfaces):
        obj = bpy.data.objects.get(self._name)
        if obj is None or not obj.reflcolor.rows:
            self.report({"WARNING"}, report_text("{name} is gone; the render was not set up", name=self._name))
            return
        for name in surfaces:
            # Raises where the mesh cannot take a surface, before anything is changed.
            if scan := bpy.data.objects.get(name):
                grid_indices(scan)
        set_up_picture(context, obj, self._picture, surfaces)
        look_through_camera(context)


classes = (REFLCOLOR_OT_set_up_render,)
