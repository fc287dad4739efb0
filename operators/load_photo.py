"""Load a photo to take colors from."""

from dataclasses import replace
from pathlib import Path

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.files.photo_files import PHOTO_SUFFIXES, photos_of
from ..reflcolor_addon.messages import Message
from .scene import polls
from .scene.editor_images import show_image
from .scene.photos import add_photos, photo_file
from .scene.texts import report_text, shown
from .window.folders import open_in, was_picked
from .window.jobs import JobOperator


class REFLCOLOR_OT_load_photo(JobOperator, bpy.types.Operator, ImportHelper):
    """Load ordinary photos, or those inside an E57, from any camera and any place, to take colors from"""

    bl_idname = "reflcolor.load_photo"
    bl_label = "Load Photo"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Load Photo"

    filter_glob: StringProperty(default=";".join(f"*{suffix}" for suffix in PHOTO_SUFFIXES), options={"HIDDEN"})

    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    swap_red_blue: BoolProperty(
        name="Swap Red and Blue",
        description="For photos whose colors come in wrong because a program stored blue where red belongs",
        options={"SKIP_SAVE"},
    )

    def invoke(self, context, event):
        # Set by drag and drop or a script; the files picked last time do not count.
        if self.properties.is_property_set("filepath"):
            return self.start(context)
        open_in(self, _scan_folder(context))
        return self.browse(ImportHelper, context, event)

    def prepare(self, context):
        was_picked(self)
        paths = [Path(self.directory, file.name) for file in self.files if file.name] or [Path(self.filepath)]
        swapped = self.swap_red_blue

        def work(progress, cancelled):
            files, warnings = [], []
            for number, path in enumerate(paths):
                if progress is not None:
                    progress(number / len(paths), Message("Loading {file}", file=path.name))
                photos = photos_of(path, warnings, cancelled=cancelled)
                if swapped:
                    photos = [replace(photo, rgb=photo.rgb[..., ::-1]) for photo in photos]
                files.append(photo_file(photos, path, cancelled=cancelled))
            return files, warnings

        return work

    def finish(self, context, result):
        files, warnings = result
        images = [image for file in files for image in add_photos(context, file)]
        for warning in warnings:
            self.report({"WARNING"}, shown(warning))
        for image, photo in zip(images, (photo for file in files for photo in file.photos), strict=True):
            height, width = photo.rgb.shape[:2]
            said = report_text("Loaded {name}: {width} x {height} pixels", name=image.name, width=width, height=height)
            self.report({"INFO"}, said)
        show_image(context, images[-1])


def _scan_folder(context):
    """The folder of the scan's file, where its photos often are; None where there is no scan."""
    obj = polls.scan_object(context)
    return Path(obj.reflcolor.source).parent if obj is not None and obj.reflcolor.source else None


classes = (REFLCOLOR_OT_load_photo,)
