"""Makes the object of a scan: mesh, attributes, images and material."""

import bpy
import numpy as np
from mathutils import Matrix

from ...reflcolor_addon.scan.georeference import origin_shift
from ...reflcolor_addon.settings import DEFAULT_PRESET
from .collections import SCANS, own_collection
from .images import packed_pixels, write_packed
from .kept_settings import keep_settings
from .nodes import color_node, node_tree_of
from .scan_object import (
    CENTER,
    GRAY,
    KINDS,
    MAX_INCIDENCE,
    RETURNS,
    SCANNED,
    SHIFT,
    UV_MAP,
    add_colors,
    show_colors,
)


def scan_images(arrays):
    """Return the reflectance and the range image of ObjectArrays as `packed_pixels` gives them; touches no bpy."""
    images = ("Reflectance", arrays.reflectance_image), ("Range", arrays.range_image)
    return [packed_pixels(pixels, f"{arrays.name} {kind}") for kind, pixels in images]


def add_scan_object(context, arrays, images=None):
    """Make the object of a scan, with mesh, attributes, images and material; select it and make it active.

    Parameters
    ----------
    context : bpy.types.Context
    arrays : ObjectArrays
        The arrays of its mesh are let go.
    images : list of bytes, optional
        From `scan_images`, where a thread has made them before.
    """
    mesh = bpy.data.meshes.new(arrays.name)
    _fill_mesh(mesh, arrays)
    scene = context.scene
    keep_settings(DEFAULT_PRESET, [scene])
    pose = arrays.pose.copy()
    shift = origin_shift(pose[:3, 3], scene.get(SHIFT))
    pose[:3, 3] = (pose[:3, 3] - shift) * arrays.units_per_meter
    obj = bpy.data.objects.new(arrays.name, mesh)
    obj.matrix_world = Matrix(pose)
    # Doubles: a shift of six digits does not fit into a float property.
    obj[SHIFT] = scene[SHIFT] = shift.tolist()
    mesh[CENTER], mesh[MAX_INCIDENCE] = arrays.center.tolist(), arrays.max_incidence_deg
    mesh[RETURNS] = len(mesh.vertices)
    state = obj.reflcolor
    state.rows, state.cols = arrays.shape
    state.source = str(arrays.source or "")
    if arrays.reflectance_image is not None:
        reflectance, measured = images or scan_images(arrays)
        state.reflectance_image = write_packed(None, f"{arrays.name} Reflectance", reflectance, is_data=False)
        state.range_image = write_packed(None, f"{arrays.name} Range", measured, is_data=True)
        for image in (state.reflectance_image, state.range_image):
            image.display_aspect = (arrays.pixel_aspect, 1.0)
    add_colors(obj, GRAY, arrays.gray)
    if arrays.scanned is not None:
        add_colors(obj, SCANNED, arrays.scanned)
    mesh.materials.append(_material(arrays.name))
    show_colors(obj, GRAY)
    own_collection(context, SCANS).objects.link(obj)
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    return obj


def _fill_mesh(mesh, arrays):
    """Vertices, faces, UV map and attributes, in bulk."""
    corners = arrays.corners.size
    mesh.vertices.add(arrays.coordinates.size // 3)
    mesh.edges.add(arrays.edges.size // 2)
    mesh.loops.add(corners)
    mesh.polygons.add(corners // arrays.sides)
    # As attributes they are written in one piece, as "co" and "vertex_index" one by one.
    mesh.attributes["position"].data.foreach_set("vector", arrays.taken("coordinates"))
    if corners:
        mesh.attributes[".edge_verts"].data.foreach_set("value", arrays.taken("edges"))
        mesh.attributes[".corner_vert"].data.foreach_set("value", arrays.taken("corners"))
        mesh.attributes[".corner_edge"].data.foreach_set("value", arrays.taken("corner_edges"))
        mesh.polygons.foreach_set("loop_start", np.arange(0, corners, arrays.sides, dtype=np.int32))
    # The edges are given: finding them would make the window stand still for most of an import.
    mesh.update()
    mesh.uv_layers.new(name=UV_MAP).uv.foreach_set("vector", arrays.taken("uv"))
    for name, values in arrays.values.items():
        mesh.attributes.new(name, KINDS[values.dtype.type], "POINT").data.foreach_set("value", values)


def _material(name):
    """A matte material that shows a color attribute."""
    material = bpy.data.materials.new(name)
    nodes, links = node_tree_of(material).nodes, material.node_tree.links
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Roughness"].default_value = 1.0
    shader.inputs["Specular IOR Level"].default_value = 0.0
    color = color_node(material, GRAY)
    color.location = (shader.location.x - 250, shader.location.y)
    links.new(color.outputs["Color"], shader.inputs["Base Color"])
    return material
