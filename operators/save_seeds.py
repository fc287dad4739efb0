"""Save seeds to a file."""

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper

from .scene import polls
from .scene.reports import reported
from .scene.seed_list import seeds_of
from .scene.texts import report_text


class REFLCOLOR_OT_save_seeds(bpy.types.Operator, ExportHelper):
    """Save the seeds of the scan as a JSON file, for the command line or another scan of the same place"""

    bl_idname = "reflcolor.save_seeds"
    bl_label = "Save Seeds"
    bl_options = {"REGISTER"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return polls.has_seeds(cls, context)

    @reported
    def execute(self, context):
        seeds = seeds_of(polls.scan_object(context))
        seeds.save(self.filepath)
        self.report({"INFO"}, report_text("Saved {count} seeds to {path}", count=len(seeds), path=self.filepath))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_save_seeds,)
