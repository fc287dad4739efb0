"""Files that are dropped on an editor: scans and seeds on the 3D View, photos and seeds on the Image Editor."""

import bpy

from ...reflcolor_addon.files.images import IMAGE_SUFFIXES
from ...reflcolor_addon.files.readers import SCAN_SUFFIXES
from ..scene import polls

# Blender only looks at the last suffix of a file.
_SCANS, _SEEDS = ";".join(sorted({f".{suffix.rpartition('.')[2]}" for suffix in SCAN_SUFFIXES})), ".json"


class REFLCOLOR_FH_scan(bpy.types.FileHandler):
    """Imports the scans that are dropped on a 3D View"""

    bl_idname = "REFLCOLOR_FH_scan"
    bl_label = "Laser Scan"
    bl_import_operator = "reflcolor.import_scan"
    bl_file_extensions = _SCANS

    @classmethod
    def poll_drop(cls, context):
        return _over(context, "VIEW_3D")


class REFLCOLOR_FH_photo(bpy.types.FileHandler):
    """Loads the photos that are dropped on an Image Editor while a scan is active; else Blender opens them"""

    bl_idname = "REFLCOLOR_FH_photo"
    bl_label = "Photo for a Laser Scan"
    bl_import_operator = "reflcolor.load_photo"
    bl_file_extensions = ";".join(IMAGE_SUFFIXES)

    @classmethod
    def poll_drop(cls, context):
        return _over(context, "IMAGE_EDITOR") and polls.scan_object(context) is not None


class REFLCOLOR_FH_seeds(bpy.types.FileHandler):
    """Loads seeds that are dropped on an editor for the scan that is active"""

    bl_idname = "REFLCOLOR_FH_seeds"
    bl_label = "Seeds of a Laser Scan"
    bl_import_operator = "reflcolor.load_seeds"
    bl_export_operator = "reflcolor.save_seeds"
    bl_file_extensions = _SEEDS

    @classmethod
    def poll_drop(cls, context):
        return _over(context, "VIEW_3D", "IMAGE_EDITOR") and polls.scan_object(context) is not None


def _over(context, *kinds):
    return context.area is not None and context.area.type in kinds


classes = (REFLCOLOR_FH_scan, REFLCOLOR_FH_photo, REFLCOLOR_FH_seeds)
