"""Do what a click on the mesh in the 3D View means."""

import bpy
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector

from ..reflcolor_addon.view.picking import corner_nearest, nearest_within
from .scene import polls
from .scene.editor_images import HIT_RADIUS
from .scene.reports import call, reported
from .scene.scan_object import seed_vertices
from .scene.seed_arrays import seed_arrays
from .scene.texts import report_text


class REFLCOLOR_OT_pick_in_view(bpy.types.Operator):
    """Click on the mesh to place a seed at the vertex there, on a seed to select it"""

    bl_idname = "reflcolor.pick_in_view"
    bl_label = "Pick Seed on Mesh"
    bl_options = {"INTERNAL"}

    delete: bpy.props.BoolProperty(name="Delete", description="Delete the seed at the pointer")

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    def invoke(self, context, event):
        self._at = event.mouse_region_x, event.mouse_region_y
        return self._pick(context)

    @reported
    def _pick(self, context):
        obj, place = polls.scan_object(context), self._at
        hit = _seed_at(context, obj, place)
        if self.delete:
            return {"CANCELLED"} if hit is None else call(self, bpy.ops.reflcolor.remove_seed, index=hit)
        if hit is not None:
            return call(self, bpy.ops.reflcolor.select_seed, index=hit)
        vertex = _vertex_at(context, obj, place)
        if vertex is None:
            self.report({"INFO"}, report_text("Click on {name}", name=obj.name))
            return {"CANCELLED"}
        pixel = {name: obj.data.attributes[f"grid_{name}"].data[vertex].value for name in ("row", "col")}
        return call(self, bpy.ops.reflcolor.place_seed, **pixel)


def _seed_at(context, obj, place):
    seeds = seed_arrays(obj)
    places, known = seed_vertices(obj, seeds.rows, seeds.cols)
    region, view = context.region, context.region_data
    shown = [
        (index, point)
        for index in np.flatnonzero(known)
        if (point := view3d_utils.location_3d_to_region_2d(region, view, Vector(places[index]))) is not None
    ]
    radius = HIT_RADIUS * context.preferences.system.ui_scale
    found = nearest_within([point for _, point in shown], place, radius)
    return None if found is None else int(shown[found][0])


def _vertex_at(context, obj, place):
    """The vertex nearest to where the pointer's ray meets the object's faces; None where it misses them."""
    evaluated = obj.evaluated_get(context.evaluated_depsgraph_get())
    to_object = obj.matrix_world.inverted()
    origin = view3d_utils.region_2d_to_origin_3d(context.region, context.region_data, place)
    direction = view3d_utils.region_2d_to_vector_3d(context.region, context.region_data, place)
    found, spot, _, face = evaluated.ray_cast(to_object @ origin, to_object.to_3x3() @ direction)
    if not found or len(evaluated.data.polygons) != len(obj.data.polygons):
        return None
    corners = list(obj.data.polygons[face].vertices)
    return corners[corner_nearest([obj.data.vertices[corner].co for corner in corners], spot)]


classes = (REFLCOLOR_OT_pick_in_view,)
