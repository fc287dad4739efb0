"""Load seeds from a file."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.files.photo_files import photos_of
from ..reflcolor_addon.seeds.seeds import Seeds
from ..reflcolor_addon.seeds.seeds_file import find_photo
from .scene import polls
from .scene.notices import show_result
from .scene.photo_colors import keep_observed
from .scene.photos import add_photos, photo_file
from .scene.provenance import record_seeds_file
from .scene.reports import reported
from .scene.scan_object import scan_of
from .scene.seed_list import append_seeds
from .scene.texts import report_text


class REFLCOLOR_OT_load_seeds(bpy.types.Operator, ImportHelper):
    """Load seeds for the scan from a JSON file"""

    bl_idname = "reflcolor.load_seeds"
    bl_label = "Load Seeds"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    replace: BoolProperty(name="Replace", description="Remove the seeds that are there before", default=True)

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    def invoke(self, context, event):
        if self.properties.is_property_set("filepath"):
            return self.execute(context)
        return ImportHelper.invoke(self, context, event)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        seeds = Seeds.load(self.filepath)
        _, warnings = seeds.placed_on(scan_of(obj))
        for name in dict.fromkeys(filter(None, seeds.photos)):
            path = find_photo(name, Path(self.filepath), ())
            if path is not None and name not in bpy.data.images:
                add_photos(context, photo_file(photos_of(path), path))
        if self.replace:
            obj.reflcolor.seeds.clear()
            keep_observed(obj, None)
        append_seeds(obj, seeds)
        record_seeds_file(obj, self.filepath, others=not self.replace)
        show_result(self, obj, report_text("Loaded {count} seeds", count=len(seeds)), warnings, seeds)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_load_seeds,)
