"""Load a photo to take colors from."""

from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.image_files import IMAGE_SUFFIXES, read_image
from ..reflcolor_addon.report import input_entry
from .images import show_image, write_image
from .provenance import record_photo
from .reports import reported


class REFLCOLOR_OT_load_photo(bpy.types.Operator, ImportHelper):
    """Load an ordinary photo, from any camera and any place, to take colors from"""

    bl_idname = "reflcolor.load_photo"
    bl_label = "Load Photo"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=";".join(f"*{suffix}" for suffix in IMAGE_SUFFIXES), options={"HIDDEN"})

    @reported
    def execute(self, context):
        image = add_photo(context, Path(self.filepath))
        show_image(context, image)
        self.report({"INFO"}, f"Loaded {image.name}: {image.size[0]} x {image.size[1]} pixels")
        return {"FINISHED"}


def add_photo(context, path):
    """Load a photo and put it on the scene's list; return its image.

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    """
    # Not Blender's own loader: it shows a photo lying on its side where the camera only noted how it was held.
    pixels, entry = read_image(path), input_entry("photo", path)
    image = write_image(None, path.name, pixels, is_data=False)
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
