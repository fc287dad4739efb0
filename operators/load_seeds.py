"""Load seeds from a file."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.files.photo_files import photos_of
from ..reflcolor_addon.messages import Message
from ..reflcolor_addon.seeds.seeds import Seeds
from ..reflcolor_addon.seeds.seeds_file import find_photo
from .scene import polls
from .scene.notices import show_result
from .scene.photo_colors import keep_observed
from .scene.photos import add_photos, photo_file
from .scene.provenance import record_seeds_file
from .scene.scan_object import scan_reader
from .scene.seed_list import append_seeds
from .scene.texts import report_text
from .window.jobs import JobOperator


class REFLCOLOR_OT_load_seeds(JobOperator, bpy.types.Operator, ImportHelper):
    """Load seeds for the scan from a JSON file"""

    bl_idname = "reflcolor.load_seeds"
    bl_label = "Load Seeds"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Load Seeds"

    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    replace: BoolProperty(name="Replace", description="Remove the seeds that are there before", default=True)

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    def invoke(self, context, event):
        if self.properties.is_property_set("filepath"):
            return self.start(context)
        return self.browse(ImportHelper, context, event)

    def prepare(self, context):
        obj = polls.scan_object(context)
        path, read_scan = Path(self.filepath), scan_reader(obj)
        self._name = obj.name
        known = set(bpy.data.images.keys())

        def work(progress, cancelled):
            seeds = Seeds.load(path)
            _, warnings = seeds.placed_on(read_scan())
            names = [name for name in dict.fromkeys(filter(None, seeds.photos)) if name not in known]
            found = [photo for photo in (find_photo(name, path, ()) for name in names) if photo is not None]
            photos = []
            for number, photo in enumerate(found):
                if progress is not None:
                    progress(number / len(found), Message("Loading {file}", file=photo.name))
                photos.append(photo_file(photos_of(photo, cancelled=cancelled), photo, cancelled=cancelled))
            return seeds, warnings, photos

        return work

    def finish(self, context, result):
        seeds, warnings, photos = result
        obj = bpy.data.objects.get(self._name)
        if obj is None or not obj.reflcolor.rows:
            self.report({"WARNING"}, report_text("{name} is gone; its seeds were dropped", name=self._name))
            return
        for file in photos:
            add_photos(context, file)
        if self.replace:
            obj.reflcolor.seeds.clear()
            keep_observed(obj, None)
        append_seeds(obj, seeds)
        record_seeds_file(obj, self.filepath, others=not self.replace)
        show_result(self, obj, report_text("Loaded {count} seeds", count=len(seeds)), warnings, seeds)


classes = (REFLCOLOR_OT_load_seeds,)
