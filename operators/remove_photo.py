"""Take a photo off the list."""

import bpy

from .scene import polls
from .scene.photo_list import photo_settings


class REFLCOLOR_OT_remove_photo(bpy.types.Operator):
    """Take the selected photo off the list; the image stays in the file"""

    bl_idname = "reflcolor.remove_photo"
    bl_label = "Remove Photo"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return polls.has_photos(cls, context)

    def execute(self, context):
        settings = photo_settings(context.scene)
        settings.photos.remove(min(settings.active_photo, len(settings.photos) - 1))
        settings.active_photo = max(0, min(settings.active_photo, len(settings.photos) - 1))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_remove_photo,)
