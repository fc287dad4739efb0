"""Where the colors of a .blend are from, for the command line."""

import bpy

from ...reflcolor_addon.errors import ReflcolorError
from .provenance import provenance_text


def read_provenance(path):
    """Return (name, report as JSON or None) of every object in a .blend that is a scan, by name.

    Raises
    ------
    ReflcolorError
        If the file cannot be read.
    """
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    try:
        # Linked, not opened: none of its scripts run, and Blender prints nothing.
        with bpy.data.libraries.load(str(path), link=True) as (there, wanted):
            wanted.objects = list(there.objects)
    except OSError as error:
        raise ReflcolorError(
            "{file}: Blender could not read it; expected a file saved by Blender", file=path
        ) from error
    scans = [obj for obj in wanted.objects if obj is not None and (obj.reflcolor.rows or provenance_text(obj))]
    return [(obj.name, provenance_text(obj)) for obj in scans]
