"""Looking at a scan from where the scanner saw it."""

from math import atan, degrees

import bpy
import numpy as np
from mathutils import Vector

from ..reflcolor_addon.framing import frame

# Blender's 3D View has a sensor of twice the usual width, in millimetres.
_VIEW_SENSOR_MM = 72.0


def view_of(objects, aspect):
    """Return the framing View of the objects of scans for a picture of an aspect (width over height).

    Several are looked at from where their scanners stood on an average.
    """
    points = np.concatenate([_points_of(obj) for obj in objects])
    return frame(points, np.mean([obj.matrix_world.translation for obj in objects], axis=0), aspect=aspect)


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
    free = max(1, region.width - covered)
    view = view_of([obj], free / max(1, region.height))
    toward = Vector(view.target - view.position)
    # The lens is that of the region's wider side, what is free of it has less.
    widest = max(region.width, region.height)
    lens, part = (
        degrees(2 * atan(_VIEW_SENSOR_MM / 2 / space.lens * share)) for share in (1, max(free, region.height) / widest)
    )
    eye = space.region_3d
    eye.view_perspective = "PERSP"
    eye.view_rotation = toward.to_track_quat("-Z", "Y")
    eye.view_distance = view.distance_through(part)
    eye.view_location = view.target_beside(eye.view_distance, lens, covered / widest)


def _points_of(obj):
    """(N, 3) float64, the vertices in the world."""
    coordinates = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", coordinates)
    matrix = np.array(obj.matrix_world)
    return coordinates.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
