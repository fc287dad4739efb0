"""Lay an image with the detail of the photos over a colorized scan."""

import bpy
import numpy as np
from bpy.props import IntProperty

from ..reflcolor_addon.matching import LARGEST, Shot, texture
from ..reflcolor_addon.matching.photo_image import PhotoImage
from ..reflcolor_addon.scan.object_arrays import on_grid
from .scene import polls
from .scene.images import read_pixels
from .scene.photo_colors import camera_image, cameras_of
from .scene.photo_texture import show_texture
from .scene.scan_object import COLORIZED, OBSERVED, PHOTO, colors_of, grid_indices, scan_reader, values_of
from .scene.texts import report_text
from .window.jobs import JobOperator


class REFLCOLOR_OT_make_texture(JobOperator, bpy.types.Operator):
    """Make an image with the detail of the photos, and show it on the scan instead of the colors of its vertices"""

    bl_idname = "reflcolor.make_texture"
    bl_label = "Make Texture"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Make Texture"

    pixels: IntProperty(
        name="Pixels",
        description="Pixels along the longer side of the image",
        default=4096,
        min=64,
        max=LARGEST,
        subtype="PIXEL",
    )

    @classmethod
    def poll(cls, context):
        return (
            polls.has_editable_scan(cls, context)
            and polls.has_whole_scan(cls, context)
            and polls.has_colors(cls, context)
        )

    def prepare(self, context):
        obj = polls.scan_object(context)
        self._object_name = obj.name
        place, shape = grid_indices(obj), (obj.reflcolor.rows, obj.reflcolor.cols)
        rgb = on_grid(colors_of(obj, COLORIZED), place, shape)
        observed, photo = np.zeros(shape, np.float32), np.full(shape, -1, np.int32)
        if OBSERVED in obj.data.attributes and PHOTO in obj.data.attributes:
            observed = on_grid(values_of(obj, OBSERVED, np.float32), place, shape)
            photo = on_grid(values_of(obj, PHOTO, np.int32), place, shape, empty=-1)
        cameras = cameras_of(obj)
        read_scan, pixels = scan_reader(obj), self.pixels
        shots = [_shot(camera, camera_image(obj, number)) for number, camera in enumerate(cameras)]
        leading = {number for number in np.unique(photo[observed > 0]).tolist() if number >= 0}
        there = {number for number, shot in enumerate(shots) if shot is not None}
        names = {number: camera[0] for number, camera in enumerate(cameras) if camera is not None}
        self._missing = [
            names.get(number) or report_text("photo {number}", number=number + 1) for number in sorted(leading - there)
        ]

        def work(progress, cancelled):
            return texture(read_scan(), rgb, observed, photo, shots, pixels, progress=progress, cancelled=cancelled)

        return work

    def finish(self, context, pixels):
        obj = bpy.data.objects.get(self._object_name)
        if obj is None:
            self.report({"WARNING"}, report_text("{name} is gone; its colors were dropped", name=self._object_name))
            return
        show_texture(obj, pixels)
        rows, columns = pixels.shape[:2]
        if self._missing:
            lost = report_text(
                "without the detail of {photos}: not among the images any more", photos=", ".join(self._missing)
            )
            self.report({"WARNING"}, lost)
        said = report_text(
            "{name} has a texture of {columns} x {rows} pixels", name=obj.name, columns=columns, rows=rows
        )
        self.report({"INFO"}, said)


def _shot(camera, image):
    """The Shot of a photo that was recognized and is still there, else None."""
    pixels = None if camera is None or image is None else read_pixels(image)
    return None if pixels is None else Shot(PhotoImage(camera[0], pixels), camera[1])


classes = (REFLCOLOR_OT_make_texture,)
