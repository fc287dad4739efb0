"""Colorize the selected scans, each from its seeds."""

import bpy

from ..reflcolor_addon.color.colorizer import colorize
from ..reflcolor_addon.progress import in_turn
from .scene import polls
from .scene.colorized_object import show_colorization
from .scene.notices import tell, tell_together
from .scene.provenance import record_provenance, window_report
from .scene.scan_object import grid_indices, scan_reader
from .scene.seed_list import seeds_of
from .scene.setting_properties import COLORIZE_NAMES, ColorizeSettings, core_settings
from .scene.texts import told
from .window import live_update
from .window.jobs import JobOperator


class REFLCOLOR_OT_colorize(JobOperator, ColorizeSettings, bpy.types.Operator):
    """Spread the colors of each selected scan's seeds over all of it, along paths of like reflectance and range"""

    bl_idname = "reflcolor.colorize"
    bl_label = "Colorize"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Colorize"

    @classmethod
    def poll(cls, context):
        return polls.has_scan_to_color(cls, context)

    def prepare(self, context):
        scans, self._left_out = polls.fitting_scans(context, polls.not_colorable)
        self._settings = core_settings(self, context.scene.reflcolor, COLORIZE_NAMES)
        # By names, not objects: they may be gone, or be others after an undo, when the work is done.
        self._seeds = {obj.name: seeds_of(obj) for obj in scans}
        return in_turn({obj.name: colorizing(obj, self._seeds[obj.name], self._settings) for obj in scans})

    def finish(self, context, results):
        done = []
        for (name, seeds), result in zip(self._seeds.items(), results, strict=True):
            obj = bpy.data.objects.get(name)
            if obj is None or (obj.reflcolor.rows, obj.reflcolor.cols) != result.rgb.shape[:2]:
                self.report({"WARNING"}, told("{name} is gone; its colors were dropped", name=name))
                continue
            # Raises where the mesh cannot take them, before any is changed.
            grid_indices(obj)
            done.append((obj, seeds, result))
        for obj, seeds, result in done:
            show_colorization(obj, result)
            record_provenance(obj, window_report(obj, result, self._settings, seeds))
            said = told("Colorized {name} from {count} seeds", name=obj.name, count=len(result.seeds))
            tell(self, obj, said, result.warnings, seeds, one_of_several=len(results) > 1)
        objects = [obj for obj, *_ in done]
        names = ", ".join(obj.name for obj in objects)
        together = told("Colorized {count} scans: {names}", count=len(objects), names=names)
        tell_together(self, objects, together, self._left_out)


def colorizing(obj, seeds, settings):
    """Return ``work(progress, cancelled)`` that gives the Colorization of an object: the preview's, where it has it."""
    previewed = live_update.finished(obj, settings)
    if previewed is not None:
        return lambda progress, cancelled: previewed
    read_scan = scan_reader(obj)
    return lambda progress, cancelled: colorize(read_scan(), seeds, settings, progress=progress, cancelled=cancelled)


classes = (REFLCOLOR_OT_colorize,)
