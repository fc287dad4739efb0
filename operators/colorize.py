"""Colorize the selected scans, each from its seeds."""

import bpy

from ..reflcolor_addon.batch.pipeline import colorize_jobs
from ..reflcolor_addon.batch.scan_job import ScanJob
from ..reflcolor_addon.report.report import versions
from .scene import polls
from .scene.colorized_object import ColorizedArrays, show_colorization
from .scene.images import packed_pixels
from .scene.notices import show_result, show_results
from .scene.photo_colors import observed_cameras, observed_reader, use_cameras
from .scene.provenance import record_provenance, window_report
from .scene.scan_object import grid_indices, scan_reader
from .scene.seed_list import seeds_of
from .scene.setting_properties import COLORIZE_NAMES, ColorizeArguments, core_settings, keep_used_settings
from .scene.texts import report_text
from .window import live_update
from .window.jobs import JobOperator


class REFLCOLOR_OT_colorize(JobOperator, ColorizeArguments, bpy.types.Operator):
    """Spread the colors of each selected scan's seeds over all of it, along paths of like reflectance and range"""

    bl_idname = "reflcolor.colorize"
    bl_label = "Colorize"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Colorize"

    @classmethod
    def poll(cls, context):
        return polls.has_scan_to_color(cls, context)

    def prepare(self, context):
        scans, self._skipped = polls.fitting_scans(context, polls.not_colorable)
        self._settings = core_settings(self, context.scene, COLORIZE_NAMES)
        # Jobs hold names, not objects: after an undo, objects may be gone or be different ones.
        jobs = [_job(obj, self._settings) for obj in scans]
        self._cameras = {obj.name: observed_cameras(obj) for obj in scans}
        places = {obj.name: grid_indices(obj) for obj in scans}

        def work(progress, cancelled):
            colorize_jobs(jobs, self._settings, progress=progress, cancelled=cancelled)
            # For the report, which is made while the window waits: the first time, they are looked for.
            versions()
            return [(job, *_ready(job, places[job.name])) for job in jobs]

        return work

    def finish(self, context, results):
        keep_used_settings(self, context.scene, COLORIZE_NAMES)
        done = []
        for job, *ready in results:
            obj = bpy.data.objects.get(job.name)
            if obj is None or (obj.reflcolor.rows, obj.reflcolor.cols) != job.colorization.rgb.shape[:2]:
                self.report({"WARNING"}, report_text("{name} is gone; its colors were dropped", name=job.name))
                continue
            # Raises if a mesh cannot take them, before any mesh is changed.
            grid_indices(obj)
            done.append((obj, job, ready))
        for obj, job, ready in done:
            result = job.colorization
            show_colorization(obj, result, *ready)
            use_cameras(obj, self._cameras[job.name])
            record_provenance(obj, window_report(obj, result, self._settings, job.seeds))
            said = report_text("Colorized {name} from {count} seeds", name=obj.name, count=len(result.seeds))
            show_result(self, obj, said, result.warnings, job.seeds, one_of_several=len(results) > 1)
        objects = [obj for obj, _, _ in done]
        names = ", ".join(obj.name for obj in objects)
        together = report_text("Colorized {count} scans: {names}", count=len(objects), names=names)
        show_results(self, objects, together, self._skipped)


def _job(obj, settings):
    """The job of an object's scan; it is done already where the preview has its colors."""
    return ScanJob(
        name=obj.name,
        scan=scan_reader(obj),
        seeds=seeds_of(obj),
        observed=observed_reader(obj),
        colorization=live_update.finished(obj, settings),
    )


def _ready(job, place):
    """What can be made in the thread of that which `show_colorization` writes."""
    return ColorizedArrays.of(job.colorization, place), packed_pixels(job.colorization.rgb, job.name)


classes = (REFLCOLOR_OT_colorize,)
