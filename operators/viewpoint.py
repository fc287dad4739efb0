"""Looking at a scan from where the scanner saw it."""

from math import atan, degrees

import numpy as np
from mathutils import Vector

from ..reflcolor_addon.framing import frame

# Blender's 3D View has a sensor of twice the usual width, in millimetres.
_VIEW_SENSOR_MM = 72.0


def view_of(obj, aspect):
    """Return the framing View of a scan's object for a picture of an aspect (width over height)."""
    coordinates = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", coordinates)
    matrix = np.array(obj.matrix_world)
    points = coordinates.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return frame(points, matrix[:3, 3], aspect=aspect)


def look_from_scanner(context, obj, area):
    """Turn a 3D View so that it shows the whole scan, from near the scanner."""
    if not len(obj.data.vertices):
        return
    space, region = area.spaces.active, next(region for region in area.regions if region.type == "WINDOW")
    sidebar = next(region for region in area.regions if region.type == "UI")
    covered = sidebar.width if space.show_region_ui and context.preferences.system.use_region_overlap else 0
    free = max(1, region.width - covered)
    view = view_of(obj, free / max(1, region.height))
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
