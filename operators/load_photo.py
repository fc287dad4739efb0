"""Load a photo to take colors from."""

from pathlib import Path

import bpy
from bpy.props import CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.files.images import IMAGE_SUFFIXES, read_image
from ..reflcolor_addon.report.report import input_entry
from .scene.image_sides import show_image
from .scene.images import remember_pixels, write_image
from .scene.provenance import record_photo
from .scene.reports import reported
from .scene.texts import shown, told


class REFLCOLOR_OT_load_photo(bpy.types.Operator, ImportHelper):
    """Load ordinary photos, from any camera and any place, to take colors from"""

    bl_idname = "reflcolor.load_photo"
    bl_label = "Load Photo"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=";".join(f"*{suffix}" for suffix in IMAGE_SUFFIXES), options={"HIDDEN"})

    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context, event):
        # Given by a drop or a script; what was picked the last time does not count as given.
        if self.properties.is_property_set("filepath"):
            return self.execute(context)
        return ImportHelper.invoke(self, context, event)

    @reported
    def execute(self, context):
        names = [file.name for file in self.files if file.name]
        for path in [Path(self.directory, name) for name in names] or [Path(self.filepath)]:
            warnings = []
            image = add_photo(context, path, warnings)
            for warning in warnings:
                self.report({"WARNING"}, shown(warning))
            width, height = image.size
            said = told("Loaded {name}: {width} x {height} pixels", name=image.name, width=width, height=height)
            self.report({"INFO"}, said)
        show_image(context, image)
        return {"FINISHED"}


def add_photo(context, path, warnings=None):
    """Load a photo and put it on the scene's list; return its image.

    ``warnings``, a list, gets what a person should know of the file.

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    """
    # Not Blender's own loader: it shows a photo lying on its side where the camera only noted how it was held.
    pixels, entry = read_image(path, warnings), input_entry("photo", path)
    image = write_image(None, path.name, pixels, is_data=False)
    remember_pixels(image, pixels)
    record_photo(image, entry)
    list_photo(context, image)
    return image


def list_photo(context, image):
    """Put an image on the scene's list of photos, where it is not yet, and select it there."""
    settings = context.scene.reflcolor
    listed = [photo.image for photo in settings.photos]
    if image not in listed:
        settings.photos.add().image = image
        listed.append(image)
    settings.active_photo = listed.index(image)


classes = (REFLCOLOR_OT_load_photo,)
