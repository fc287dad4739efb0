"""When an operator can run, and what to do when it cannot."""

import bpy

from .photo_list import photo_settings
from .scan_object import COLORIZED, is_light
from .texts import report_text, tip


def nothing_missing(cls, missing):
    """Return whether nothing is missing; if something is, the button's tooltip shows what to do."""
    if missing:
        cls.poll_message_set(missing)
    return not missing


def has_window(cls, context):
    """There is a window, not only a script."""
    windowless = bpy.app.background or context.window is None
    return nothing_missing(cls, tip("Run this in Blender's window") if windowless else None)


def has_scan(cls, context):
    """There is a scan that is meant."""
    return nothing_missing(cls, tip("Import a scan, or select one, first") if scan_object(context) is None else None)


def has_own_scan(cls, context):
    """A scan's object is active, and this file keeps what becomes of its seeds."""
    return has_scan(cls, context) and nothing_missing(cls, foreign_seeds(scan_object(context)))


def has_editable_scan(cls, context):
    """A scan's object is active, and its mesh can be written to."""
    return has_scan(cls, context) and nothing_missing(cls, closed_mesh(scan_object(context)))


def has_whole_scan(cls, context):
    """There is a scan that is meant, with its own mesh and images."""
    return has_scan(cls, context) and nothing_missing(cls, light_mesh(scan_object(context)))


def has_seeds(cls, context):
    """A scan's object is active and has seeds."""
    return has_scan(cls, context) and nothing_missing(cls, no_seeds(scan_object(context)))


def has_scan_to_color(cls, context):
    """The mesh of the active scan can be written to, and it or another selected scan has what colorizing needs."""
    if not has_editable_scan(cls, context):
        return False
    missing = [not_colorable(obj) for obj in scan_objects(context)]
    return not all(missing) or nothing_missing(cls, missing[0])


def has_selected_seeds(cls, context):
    """A scan's object is active and a seed of it is selected."""
    if not (has_own_scan(cls, context) and has_seeds(cls, context)):
        return False
    selected = any(seed.select for seed in scan_object(context).reflcolor.seeds)
    return nothing_missing(cls, None if selected else tip("Select a seed first"))


def has_colors(cls, context):
    """A scan's object is active and was colorized."""
    if not has_scan(cls, context):
        return False
    colorized = COLORIZED in scan_object(context).data.color_attributes
    return nothing_missing(cls, None if colorized else tip("Colorize the scan first"))


def has_photos(cls, context):
    """There is a photo on the list."""
    return nothing_missing(cls, None if photo_settings(context.scene).photos else tip("Load a photo first"))


def foreign_seeds(obj):
    """Return what to do before this file keeps what becomes of a scan's seeds; None if it does."""
    if obj.library is not None:
        return tip("The scan is linked from another file; make it local or a library override first")
    return light_mesh(obj)


def light_mesh(obj):
    """Return what to do where a scan has to be a whole one; None if it is."""
    return tip("This is a light mesh; select the scan itself") if is_light(obj) else None


def closed_mesh(obj):
    """Return what to do before a scan's mesh can be written to; None if it can."""
    if obj.data.library is not None:
        return tip("The mesh is linked from another file; make it local first")
    return tip("Leave Edit Mode first") if obj.mode == "EDIT" else None


def no_seeds(obj):
    """Return what to do if a scan has no seeds, else None."""
    return None if obj.reflcolor.seeds else tip("Add a seed first")


def not_colorable(obj):
    """Return what to do before a scan can be colorized; None if it can."""
    missing = closed_mesh(obj) or foreign_seeds(obj) or no_seeds(obj)
    if missing is None and not any(seed.has_color for seed in obj.reflcolor.seeds):
        return tip("Give a seed its color first")
    return missing


def scan_object(context):
    """Return the active object if it is a scan, else the only scan there is; None where there is none, or several."""
    # A timer's context has none while Blender changes the workspace.
    active = getattr(context, "active_object", None)
    if _is_scan(active):
        return active
    scans = [obj for obj in context.view_layer.objects if _is_scan(obj)]
    return scans[0] if len(scans) == 1 else None


def scan_objects(context):
    """Return the scan that is meant, and after it the others that are selected; none if no scan is meant."""
    active = scan_object(context)
    if active is None:
        return []
    return [active, *(obj for obj in context.selected_objects if obj != active and _is_scan(obj))]


def fitting_scans(context, missing):
    """Return those of `scan_objects` that ``missing(obj)`` has nothing to say of, and a warning for each other one."""
    found = [(obj, missing(obj)) for obj in scan_objects(context)]
    skipped = [
        report_text("{name} was left out: {reason}", name=obj.name, reason=reason) for obj, reason in found if reason
    ]
    return [obj for obj, reason in found if not reason], skipped


def _is_scan(obj):
    return obj is not None and obj.type == "MESH" and obj.reflcolor.rows > 0
