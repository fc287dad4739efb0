"""Looking at scans from where the scanner saw them."""

from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Vector

from ...reflcolor_addon.view.framing import View, frame, frame_in_region, in_world
from .scan_object import coordinates_of

# Custom property of light meshes.
_VIEW = "reflcolor_view"


def view_of(obj):
    """Return the framing View of the object of a scan for a picture in the scan's own shape."""
    kept = kept_view(obj)
    return frame(*_points_and_scanners([obj])) if kept is None else kept


def keep_view(obj, coordinates):
    """Keep with a light mesh the View of its scan, which has more vertices, at (N, 3) coordinates."""
    scanner = np.array(obj.matrix_world.translation)
    view = frame(in_world(coordinates, obj.matrix_world), scanner)
    to_local = obj.matrix_world.inverted()
    ends = [tuple(to_local @ Vector(end)) for end in (view.position, view.target)]
    obj.data[_VIEW] = [*ends[0], *ends[1], view.fov_deg, view.aspect]


def kept_view(obj):
    """Return the View that `keep_view` kept, from where the object is now; None where there is none."""
    kept = obj.data.get(_VIEW)
    if kept is None:
        return None
    position, target = (np.array(obj.matrix_world @ Vector(kept[first : first + 3])) for first in (0, 3))
    return View(position=position, target=target, fov_deg=kept[6], aspect=kept[7])


def show_imported(context, objects):
    """Turn the 3D Views of the window to the objects of scans that were just imported, which are selected.

    The first scans of a scene are shown alone, where there is anything else to be seen: the startup file's cube stands
    where most scanners do.
    """
    if bpy.app.background or context.window is None:
        return
    others = [obj for obj in context.view_layer.objects if obj not in objects]
    alone = not any(obj.reflcolor.rows for obj in others)
    for area in context.window.screen.areas:
        if area.type == "VIEW_3D":
            look_from_scanner(context, objects, area)
            if alone or area.spaces.active.local_view is not None:
                show_scans_alone(context, area)


def show_scans_alone(context, area):
    """Have a 3D View show the scans of the scene and nothing else, in Blender's Local View; / brings the rest back."""
    visible = [obj for obj in context.view_layer.objects if obj.visible_get()]
    scans = [obj for obj in visible if obj.reflcolor.rows]
    if area.spaces.active.local_view is None and 0 < len(scans) < len(visible):
        region = next(region for region in area.regions if region.type == "WINDOW")
        with context.temp_override(area=area, region=region), _selected(context, scans[0]):
            bpy.ops.view3d.localview(frame_selected=False)
    if area.spaces.active.local_view is not None:
        for obj in scans:
            obj.local_view_set(area.spaces.active, True)


@contextmanager
def _selected(context, obj):
    """Have an object selected, within the block."""
    before = obj.select_get()
    obj.select_set(True)
    try:
        yield
    finally:
        obj.select_set(before)


def look_from_scanner(context, objects, area):
    """Turn a 3D View so that it shows the whole of one or several scans, from near the scanner or from above."""
    if not any(len(obj.data.vertices) for obj in objects):
        return
    space, region = area.spaces.active, next(region for region in area.regions if region.type == "WINDOW")
    view = frame_in_region(
        *_points_and_scanners(objects),
        size=(region.width, region.height),
        covered=covered_at_edges(context, area),
        focal_mm=space.lens,
    )
    eye = space.region_3d
    eye.view_perspective = "PERSP"
    eye.view_rotation = Vector(view.target - view.position).to_track_quat("-Z", "Y")
    eye.view_distance = view.distance
    eye.view_location = view.target


def covered_at_edges(context, area):
    """Return how many pixels at the left and at the right of a 3D View its toolbar and its sidebar lie over."""
    if not context.preferences.system.use_region_overlap:
        return 0, 0
    space = area.spaces.active
    shown = {"TOOLS": space.show_region_toolbar, "UI": space.show_region_ui}
    widths = {region.type: region.width for region in area.regions if shown.get(region.type)}
    return widths.get("TOOLS", 0), widths.get("UI", 0)


def _points_and_scanners(objects):
    """(N, 3) float64, the vertices of objects in the world, and (K, 3), the places of their scanners."""
    points = np.concatenate([in_world(coordinates_of(obj.data), obj.matrix_world) for obj in objects])
    return points, np.array([obj.matrix_world.translation for obj in objects])
