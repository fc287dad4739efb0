"""Looking at a scan from where the scanner saw it."""

import bpy
import numpy as np
from mathutils import Vector

from ...reflcolor_addon.view.framing import frame, frame_in_region, in_world
from .scan_object import coordinates_of


def view_of(obj, aspect):
    """Return the framing View of the object of a scan for a picture of an aspect (width over height)."""
    return frame(*_points_and_scanner(obj), aspect=aspect)


def show_first(context, count):
    """Turn the 3D Views of the window to the first scans of a file, of which the active object is one."""
    if bpy.app.background or context.window is None:
        return
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        if count == 1:
            look_from_scanner(context, context.active_object, area)
            continue
        region = next(region for region in area.regions if region.type == "WINDOW")
        with context.temp_override(area=area, region=region):
            bpy.ops.view3d.view_all()


def look_from_scanner(context, obj, area):
    """Turn a 3D View so that it shows the whole scan, from near the scanner."""
    if not len(obj.data.vertices):
        return
    space, region = area.spaces.active, next(region for region in area.regions if region.type == "WINDOW")
    sidebar = next(region for region in area.regions if region.type == "UI")
    covered = sidebar.width if space.show_region_ui and context.preferences.system.use_region_overlap else 0
    view = frame_in_region(
        *_points_and_scanner(obj), size=(region.width, region.height), covered=covered, focal_mm=space.lens
    )
    eye = space.region_3d
    eye.view_perspective = "PERSP"
    eye.view_rotation = Vector(view.target - view.position).to_track_quat("-Z", "Y")
    eye.view_distance = view.distance
    eye.view_location = view.target


def _points_and_scanner(obj):
    """(N, 3) float64, the vertices of an object in the world, and (3,), its scanner's place."""
    return in_world(coordinates_of(obj.data), obj.matrix_world), np.array(obj.matrix_world.translation)
