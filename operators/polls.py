"""When an operator can run, and what to do when it cannot."""

import bpy

from .scan_object import COLORIZED
from .texts import tip


def has_window(cls, context):
    """There is a window, not only a script."""
    if bpy.app.background or context.window is None:
        cls.poll_message_set(tip("Run this in Blender's window"))
        return False
    return True


def has_scan(cls, context):
    """A scan's object is active."""
    if scan_object(context) is None:
        cls.poll_message_set(tip("Import a scan, or select one, first"))
        return False
    return True


def has_own_scan(cls, context):
    """A scan's object is active, and this file keeps what becomes of its seeds."""
    if not has_scan(cls, context):
        return False
    if scan_object(context).library is not None:
        cls.poll_message_set(tip("The scan is linked from another file; make it local or a library override first"))
        return False
    return True


def has_editable_scan(cls, context):
    """A scan's object is active, and its mesh can be written to."""
    if not has_scan(cls, context):
        return False
    if scan_object(context).data.library is not None:
        cls.poll_message_set(tip("The mesh is linked from another file; make it local first"))
        return False
    if scan_object(context).mode == "EDIT":
        cls.poll_message_set(tip("Leave Edit Mode first"))
        return False
    return True


def has_seeds(cls, context):
    """A scan's object is active and has seeds."""
    if not has_scan(cls, context):
        return False
    if not scan_object(context).reflcolor.seeds:
        cls.poll_message_set(tip("Add a seed first"))
        return False
    return True


def has_colored_seeds(cls, context):
    """A scan's object is active and a seed of it has a color."""
    if not (has_own_scan(cls, context) and has_seeds(cls, context)):
        return False
    if not any(seed.has_color for seed in scan_object(context).reflcolor.seeds):
        cls.poll_message_set(tip("Give a seed its color first"))
        return False
    return True


def has_selected_seeds(cls, context):
    """A scan's object is active and a seed of it is selected."""
    if not (has_own_scan(cls, context) and has_seeds(cls, context)):
        return False
    if not any(seed.select for seed in scan_object(context).reflcolor.seeds):
        cls.poll_message_set(tip("Select a seed first"))
        return False
    return True


def has_colors(cls, context):
    """A scan's object is active and was colorized."""
    if not has_scan(cls, context):
        return False
    if COLORIZED not in scan_object(context).data.color_attributes:
        cls.poll_message_set(tip("Colorize the scan first"))
        return False
    return True


def has_photos(cls, context):
    """There is a photo on the list."""
    if not context.scene.reflcolor.photos:
        cls.poll_message_set(tip("Load a photo first"))
        return False
    return True


def scan_object(context):
    """Return the active object if it is a scan, else None."""
    active = context.active_object
    is_scan = active is not None and active.type == "MESH" and active.reflcolor.rows > 0
    return active if is_scan else None
