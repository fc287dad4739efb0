"""A picture of scans and of nothing else: camera, light and render."""

import math

import bpy
from mathutils import Vector

from ...reflcolor_addon.view.framing import picture_size
from .collections import PICTURE, own_collection
from .nodes import node_tree_of
from .picture_material import AMBIENT_SHARE, LIT, UNLIT, give_look
from .viewpoint import view_of

# On objects: added for a picture; left out of pictures, which the person had not done.
_ADDED, _LEFT_OUT = "reflcolor_for_render", "reflcolor_left_out"
# Linear light: dark enough for white walls to stand out from, light enough for dark floors.
_BACKGROUND = (0.045, 0.047, 0.05, 1.0)
# From the left above the viewer.
_SUN_FROM = (-0.4, 0.5, 1.0)


def set_up_picture(context, obj, look=UNLIT):
    """Have the scene's renders show its scans only, as a camera of their own sees one of them.

    Nothing is deleted: what else is in the scene is left out of renders, camera and light are in a collection of their
    own, and the world that was there is kept in the file. What was set up before makes room.

    Parameters
    ----------
    context : bpy.types.Context
    obj : bpy.types.Object
        The scan to frame.
    look : {UNLIT, LIT}
        Colors exactly as they are, or in even light.
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
    if look == LIT:
        # Without shadows: a scan has holes and open backs, whose shadows would look like dirt.
        sun = _add(context, "Laser Scan Light", bpy.data.lights.new("Laser Scan Light", "SUN"))
        sun.data.energy = math.pi * (1 - AMBIENT_SHARE)
        sun.data.angle, sun.data.use_shadow = 0.0, False
        sun.rotation_euler = (camera.rotation_euler.to_matrix() @ Vector(_SUN_FROM)).to_track_quat("Z", "Y").to_euler()
    _leave_out_all_but_scans(scene)
    for scan in (other for other in scene.objects if other.reflcolor.rows):
        for material in filter(None, scan.data.materials):
            give_look(material, look)
    scene.render.resolution_x, scene.render.resolution_y = picture_size(view.aspect)
    _set_up_scene(scene)


def look_through_camera(context, area):
    """Have a 3D View look through the scene's camera, in Local View, too, where it has a camera of its own."""
    space = area.spaces.active
    space.camera = context.scene.camera
    space.region_3d.view_perspective = "CAMERA"
    if space.local_view is not None:
        for obj in context.scene.objects:
            if _ADDED in obj:
                obj.local_view_set(space, True)


def render(context, path):
    """Render the scene to a PNG file."""
    scene = context.scene
    kept, scene.render.filepath = scene.render.filepath, str(path)
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        scene.render.filepath = kept


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
    scene.cycles.samples = 32
    scene.cycles.seed = 0
    scene.cycles.max_bounces = 0
    scene.cycles.transparent_max_bounces = 32
    scene.cycles.use_denoising = False
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
    background.inputs["Color"].default_value = _BACKGROUND
    # Seen, but no light.
    world.cycles_visibility.diffuse = False
