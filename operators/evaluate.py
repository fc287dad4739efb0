"""Compare a scan's colors with the true ones."""

import bpy
import numpy as np
from bpy.props import StringProperty

from ..reflcolor_addon.color.evaluation import error_map, evaluate
from ..reflcolor_addon.errors import ScanError
from ..reflcolor_addon.scan.object_arrays import on_grid
from .scene import polls
from .scene.images import read_image
from .scene.looks import refresh_look
from .scene.notices import show_result
from .scene.scan_object import COLORIZED, ERROR, SCANNED, add_values, colors_of, grid_indices
from .scene.texts import report_text
from .window.jobs import JobOperator

# Value where no true color is known.
UNKNOWN = -1.0


class REFLCOLOR_OT_evaluate(JobOperator, bpy.types.Operator):
    """Compare the colors with those of the scan itself or of an image, and store the difference at every vertex"""

    bl_idname = "reflcolor.evaluate"
    bl_label = "Evaluate Colors"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Evaluate"

    truth: StringProperty(
        name="True Colors",
        description="Image with one pixel per pixel of the scan; by default the one chosen for the scan, or the colors "
        "that came with it",
    )

    @classmethod
    def poll(cls, context):
        return polls.has_whole_scan(cls, context) and polls.has_colors(cls, context)

    def prepare(self, context):
        obj = polls.scan_object(context)
        self._object_name = obj.name
        place = grid_indices(obj)
        shape = obj.reflcolor.rows, obj.reflcolor.cols
        rgb = on_grid(colors_of(obj, COLORIZED), place, shape)
        known = on_grid(np.ones(len(place[0]), bool), place, shape)
        image = self._image(obj)
        if image is not None:
            truth = _pixels(image, obj)
        elif SCANNED in obj.data.color_attributes:
            truth = on_grid(colors_of(obj, SCANNED), place, shape)
            # Black is what scanners write where they saw no color.
            known &= truth.any(axis=-1)
        else:
            raise ScanError("{name}: the scan came without colors; choose an image of its true colors", name=obj.name)
        return lambda progress, cancelled: (evaluate(rgb, truth, known), error_map(rgb, truth, known)[place])

    def finish(self, context, result):
        figures, errors = result
        obj = bpy.data.objects.get(self._object_name)
        if obj is None or len(obj.data.vertices) != len(errors):
            self.report({"WARNING"}, report_text("{name} is gone; its errors were dropped", name=self._object_name))
            return
        add_values(obj, ERROR, np.nan_to_num(errors, nan=UNKNOWN))
        refresh_look(obj)
        mean, percentile = (figures["as_is"][f"ciede2000_{name}"] for name in ("mean", "p95"))
        said = report_text(
            "{name}: mean CIEDE2000 {mean:.2f}, below {percentile:.2f} at 95 % of {count} vertices; "
            "with the true luminance {alone:.2f}",
            name=obj.name,
            mean=mean,
            percentile=percentile,
            count=figures["pixels"],
            alone=figures["color_alone"]["ciede2000_mean"],
        )
        show_result(self, obj, said, ())

    def _image(self, obj):
        if not self.truth:
            return obj.reflcolor.truth_image
        image = bpy.data.images.get(self.truth)
        if image is None:
            raise ScanError("there is no image {name}; open it first", name=self.truth)
        return image


def _pixels(image, obj):
    state, (width, height) = obj.reflcolor, image.size
    if (width, height) != (state.cols, state.rows):
        raise ScanError(
            "{image}: is {width} x {height} pixels, but the scan {name} has {cols} columns x {rows} rows; "
            "they must be the same",
            image=image.name,
            width=width,
            height=height,
            name=obj.name,
            cols=state.cols,
            rows=state.rows,
        )
    return read_image(image)


classes = (REFLCOLOR_OT_evaluate,)
