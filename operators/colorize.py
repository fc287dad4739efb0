"""Colorize a scan from its seeds."""

import bpy

from ..reflcolor_addon.colorize import colorize
from . import live_update, polls
from .colorized_object import show_colorization
from .jobs import JobOperator
from .notices import tell
from .properties import COLORIZE_NAMES, ColorizeSettings, core_settings
from .provenance import record_provenance, window_report
from .scan_object import scan_reader
from .seed_list import seeds_of
from .texts import told


class REFLCOLOR_OT_colorize(JobOperator, ColorizeSettings, bpy.types.Operator):
    """Spread the colors of the seeds over the whole scan, along paths of like reflectance and range"""

    bl_idname = "reflcolor.colorize"
    bl_label = "Colorize"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Colorize"

    @classmethod
    def poll(cls, context):
        return polls.has_editable_scan(cls, context) and polls.has_colored_seeds(cls, context)

    def prepare(self, context):
        obj = polls.scan_object(context)
        # A name, not the object: it may be gone, or be another one after an undo, when the work is done.
        self._object_name = obj.name
        settings = core_settings(self, context.scene.reflcolor, COLORIZE_NAMES)
        seeds = seeds_of(obj)
        self._seeds, self._settings = seeds, settings
        previewed = live_update.finished(obj, settings)
        if previewed is not None:
            return lambda progress, cancelled: previewed
        read_scan = scan_reader(obj)
        return lambda progress, cancelled: colorize(
            read_scan(), seeds, settings, progress=progress, cancelled=cancelled
        )

    def finish(self, context, result):
        obj = bpy.data.objects.get(self._object_name)
        if obj is None or (obj.reflcolor.rows, obj.reflcolor.cols) != result.rgb.shape[:2]:
            self.report({"WARNING"}, told("{name} is gone; its colors were dropped", name=self._object_name))
            return
        show_colorization(obj, result)
        record_provenance(obj, window_report(obj, result, self._settings, self._seeds))
        said = told("Colorized {name} from {count} seeds", name=obj.name, count=len(result.seeds))
        tell(self, obj, said, result.warnings, self._seeds)


classes = (REFLCOLOR_OT_colorize,)
