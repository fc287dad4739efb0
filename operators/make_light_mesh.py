"""Make a light mesh of a scan: few faces that show what its many show."""

from dataclasses import replace

import bpy
import numpy as np
from bpy.props import IntProperty

from ..reflcolor_addon.batch.memory import require_light_mesh
from ..reflcolor_addon.matching import grid_texture
from ..reflcolor_addon.scan.georeference import shifted
from ..reflcolor_addon.scan.grid_mesh import MAX_INCIDENCE_DEG
from ..reflcolor_addon.view.fewer_faces import FEWEST_FACES, MOST_FACES, few_faces_missed, light_mesh
from .scene import polls
from .scene.decimation import decimate
from .scene.images import packed_pixels
from .scene.light_object import add_light_copy, known_of
from .scene.photo_texture import texture_image
from .scene.properties import scene_picture
from .scene.scan_object import MAX_INCIDENCE, SHIFT, scan_reader, shown_in_renders
from .scene.texts import report_text, shown
from .window.jobs import JobOperator


class REFLCOLOR_OT_make_light_mesh(JobOperator, bpy.types.Operator):
    """Make a copy of the scan with few faces, whose colors are an image, and hide the scan itself"""

    bl_idname = "reflcolor.make_light_mesh"
    bl_label = "Make Light Mesh"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Make Light Mesh"

    faces: IntProperty(
        name="Faces",
        description="How many triangles the copy has at most",
        default=200_000,
        min=FEWEST_FACES,
        max=MOST_FACES,
        soft_max=2_000_000,
    )

    @classmethod
    def poll(cls, context):
        return polls.has_editable_scan(cls, context) and polls.has_whole_scan(cls, context)

    def invoke(self, context, event):
        return self.ask(context, event)

    def prepare(self, context):
        obj = polls.scan_object(context)
        self._object_name, self._image = obj.name, texture_image(obj)
        read, faces, picture = scan_reader(obj), self.faces, scene_picture(context.scene)
        self._colors, self._values = known_of(obj)
        shown_rgb = self._colors[shown_in_renders(obj)]
        options = {
            "filled": picture.filled,
            "drop_mixed": picture.drop_mixed,
            "max_incidence_deg": obj.data.get(MAX_INCIDENCE, MAX_INCIDENCE_DEG),
        }
        shift, own_image, name = np.array(obj.get(SHIFT, (0, 0, 0))), self._image, obj.name

        def work(progress, cancelled):
            scan = read()
            require_light_mesh(scan, faces)
            scan = replace(scan, name=f"{name} Light", pose=shifted(scan.pose, shift))
            light = light_mesh(scan, faces, decimate, **options, progress=progress, cancelled=cancelled)
            return light, None if own_image else packed_pixels(grid_texture(scan, shown_rgb), name)

        return work

    def finish(self, context, result):
        light, packed = result
        obj = bpy.data.objects.get(self._object_name)
        if obj is None:
            self.report({"WARNING"}, report_text("{name} is gone; its light mesh was dropped", name=self._object_name))
            return
        copy = add_light_copy(context, obj, light, self._colors, self._values, self._image or packed)
        if len(light.triangles) > self.faces:
            self.report({"WARNING"}, shown(few_faces_missed(copy.name, light, self.faces)))
        said = report_text(
            "{name} has {faces} faces instead of {whole}; {scan} is hidden",
            name=copy.name,
            faces=len(light.triangles),
            whole=light.whole,
            scan=obj.name,
        )
        self.report({"INFO"}, said)


classes = (REFLCOLOR_OT_make_light_mesh,)
