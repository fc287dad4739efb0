"""A picture of scans and of nothing else: camera, look and render."""

import math
from pathlib import Path

import bpy
from mathutils import Vector

from ...reflcolor_addon.files.png_text import without_text
from ...reflcolor_addon.view.framing import camera_in_region, picture_size
from ...reflcolor_addon.view.picture import BACKGROUND, LIGHT_FROM
from .collections import PICTURE, own_collection
from .nodes import node_tree_of
from .picture_material import give_look
from .polls import closed_mesh, light_mesh
from .scan_object import is_joined
from .shown_surface import add_surface, has_surface, remove_surface, switch_surface
from .viewpoint import covered_at_edges, view_of

# Custom properties of objects: added for a picture; hidden in pictures, but not by the user.
_ADDED, _LEFT_OUT = "reflcolor_for_render", "reflcolor_left_out"


def set_up_picture(context, obj, picture, surfaces):
    """Have the scene's renders show its scans only, as a camera of their own sees one of them.

    Nothing is deleted: what else is in the scene is left out of renders, the camera is in a collection of its own, and
    the world that was there is kept in the file. What was set up before makes room.

    Parameters
    ----------
    context : bpy.types.Context
    obj : bpy.types.Object
        The scan to frame.
    picture : Picture
    surfaces : dict of str to ShownSurface
        By the name of each scan's object; scans without one are shown as they are measured.
    """
    scene = context.scene
    for added in [other for other in scene.objects if _ADDED in other]:
        bpy.data.objects.remove(added)
    view = view_of(obj)
    toward = Vector(view.target - view.position)
    camera = _add(context, "Laser Scan Camera", bpy.data.cameras.new("Laser Scan Camera"))
    camera.location = view.position
    camera.rotation_euler = toward.to_track_quat("-Z", "Y").to_euler()
    camera.data.angle = math.radians(view.fov_deg)
    camera.data.clip_start, camera.data.clip_end = view.clip
    scene.camera = camera
    _leave_out_all_but_scans(scene)
    for scan in scans_of(scene):
        if scan.library is None:
            remove_surface(scan)
        if scan.name in surfaces:
            add_surface(scan, surfaces[scan.name], drop_mixed=picture.drop_mixed)
    follow_picture(scene, picture)
    scene.render.resolution_x, scene.render.resolution_y = picture_size(view.aspect)
    _set_up_scene(scene)


def follow_picture(scene, picture):
    """Where the scene is set up for pictures, have its scans shown as a Picture says."""
    if not _is_set_up(scene):
        return
    toward_light = scene.camera.rotation_euler.to_matrix() @ Vector(LIGHT_FROM).normalized()
    for scan in scans_of(scene):
        switch_surface(scan, shown=picture.filled, drop_mixed=picture.drop_mixed)
        for material in scan.data.materials:
            if material is not None and material.library is None:
                give_look(material, picture.look, toward_light)


def lacks_surface(scene, picture):
    """Whether the scene is set up for pictures, but without what a Picture would have them show of its scans."""
    return (
        _is_set_up(scene)
        and picture.filled
        and not all(has_surface(scan, drop_mixed=picture.drop_mixed) for scan in fillable_scans(scene))
    )


def scans_of(scene):
    """Return the objects of the scene's scans."""
    return [obj for obj in scene.objects if obj.reflcolor.rows]


def fillable_scans(scene):
    """Return those of the scene's scans whose own mesh can be written to; the others are shown as they are."""
    return [
        obj
        for obj in scans_of(scene)
        if closed_mesh(obj) is None
        and light_mesh(obj) is None
        and not (obj.library or is_joined(obj))
        and len(obj.data.vertices)
    ]


def _is_set_up(scene):
    return scene.camera is not None and _ADDED in scene.camera


def look_through_camera(context):
    """Have the window's largest 3D View look through the scene's camera."""
    views = [area for area in context.window.screen.areas if area.type == "VIEW_3D"] if context.window else []
    if not views:
        return
    area = max(views, key=lambda area: area.width * area.height)
    space, region = area.spaces.active, next(region for region in area.regions if region.type == "WINDOW")
    # In Local View a 3D View has its own camera.
    space.camera = context.scene.camera
    eye, shown = space.region_3d, context.scene.render
    eye.view_perspective = "CAMERA"
    eye.view_camera_zoom, eye.view_camera_offset = camera_in_region(
        (region.width, region.height), covered_at_edges(context, area), shown.resolution_x / shown.resolution_y
    )
    if space.local_view is not None:
        for obj in context.scene.objects:
            if _ADDED in obj:
                obj.local_view_set(space, True)


def render(context, path):
    """Render the scene to a PNG file, the same bytes each time."""
    scene = context.scene
    kept, scene.render.filepath = scene.render.filepath, str(path)
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        scene.render.filepath = kept
    # Blender and Cycles write dates and times into it.
    Path(path).write_bytes(without_text(Path(path).read_bytes()))


def _add(context, name, data):
    obj = bpy.data.objects.new(name, data)
    obj[_ADDED] = True
    own_collection(context, PICTURE).objects.link(obj)
    return obj


def _leave_out_all_but_scans(scene):
    for obj in scene.objects:
        if not obj.reflcolor.rows and _ADDED not in obj and not obj.hide_render:
            obj.hide_render = obj[_LEFT_OUT] = True


def _set_up_scene(scene):
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 16
    scene.cycles.seed = 0
    # A table of samples takes less time than computing them, and the picture is no noisier.
    scene.cycles.sampling_pattern = "TABULATED_SOBOL"
    scene.cycles.max_bounces = 0
    scene.cycles.transparent_max_bounces = 32
    scene.cycles.use_denoising = False
    # Of so few samples none can be saved.
    scene.cycles.use_adaptive_sampling = False
    # Colors as they are; Blender's default view would gray them.
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    scene.view_settings.exposure, scene.view_settings.gamma = 0, 1
    world = next((world for world in bpy.data.worlds if _ADDED in world), None)
    if world is None:
        world = bpy.data.worlds.new("Laser Scan Background")
        world[_ADDED] = True
    if scene.world is not None and scene.world != world:
        # Blender does not save a world that nothing uses.
        scene.world.use_fake_user = True
    scene.world = world
    background = next(node for node in node_tree_of(world).nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*BACKGROUND, 1.0)
    # Visible, but without light.
    world.cycles_visibility.diffuse = False
