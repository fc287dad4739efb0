"""Compare a scan's colors with the true ones."""

import bpy
import numpy as np
from bpy.props import StringProperty

from ..reflcolor_addon.errors import ScanError
from ..reflcolor_addon.evaluation import error_map, evaluate
from . import polls
from .images import read_image
from .jobs import JobOperator
from .scan_object import COLORIZED, SCANNED, add_values, colors_of, grid_indices

ERROR = "error"


class REFLCOLOR_OT_evaluate(JobOperator, bpy.types.Operator):
    """Compare the colors with those of the scan itself or of an image, and store each vertex's CIEDE2000 as "error\""""

    bl_idname = "reflcolor.evaluate"
    bl_label = "Evaluate Colors"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Evaluate"

    truth: StringProperty(
        name="True Colors",
        description="Image with one pixel per pixel of the scan; if empty, the colors that came with the scan",
    )

    @classmethod
    def poll(cls, context):
        return polls.has_colors(cls, context)

    def prepare(self, context):
        obj = polls.scan_object(context)
        self._object_name = obj.name
        rows, cols = grid_indices(obj)
        rgb = colors_of(obj, COLORIZED)
        truth = self._image_colors(obj)[rows, cols] if self.truth else _scanned_colors(obj)
        # Black is what scanners write where they saw no color.
        known = np.ones(len(rgb), bool) if self.truth else truth.any(axis=-1)
        # The core takes grids; the vertices are one of a single row.
        grids = rgb[None], truth[None], known[None]
        return lambda progress, cancelled: (evaluate(*grids), error_map(*grids)[0])

    def finish(self, context, result):
        figures, errors = result
        obj = bpy.data.objects.get(self._object_name)
        if obj is None or len(obj.data.vertices) != len(errors):
            self.report({"WARNING"}, f"{self._object_name} is gone; its errors were dropped")
            return
        add_values(obj, ERROR, np.nan_to_num(errors, nan=-1.0))
        mean, percentile = (figures["color_alone"][f"ciede2000_{name}"] for name in ("mean", "p95"))
        self.report(
            {"INFO"},
            f"{obj.name}: CIEDE2000 {mean:.2f} in the mean, below {percentile:.2f} at 95 % of "
            f"{figures['pixels']} vertices (luminance apart)",
        )

    def _image_colors(self, obj):
        image, state = bpy.data.images.get(self.truth), obj.reflcolor
        if image is None:
            raise ScanError(f"there is no image {self.truth}; open it first")
        if tuple(image.size) != (state.cols, state.rows):
            raise ScanError(
                f"{self.truth}: is {image.size[0]} x {image.size[1]} pixels, but the scan {obj.name} has {state.cols} "
                f"columns x {state.rows} rows; they must be the same"
            )
        return read_image(image)


def _scanned_colors(obj):
    if SCANNED not in obj.data.color_attributes:
        raise ScanError(f"{obj.name}: the scan came without colors; choose an image of its true colors")
    return colors_of(obj, SCANNED)


classes = (REFLCOLOR_OT_evaluate,)
