"""A plain picture of a scan's object: camera, light and render."""

import math
from contextlib import contextmanager

import bpy
from mathutils import Vector

from .nodes import node_tree_of
from .viewpoint import view_of

SIZE = (1280, 800)
# Suns without shadows: a scan has holes and open backs, whose shadows would look like dirt. Each is the share of a
# surface's own color that it gives when facing the light.
_LIGHTS = (("Headlight", None, 0.55), ("Sky", (0.0, 0.0, 1.0), 0.35), ("Side", (-0.6, -0.5, 0.4), 0.25))
# On objects: added for a picture.
_ADDED = "reflcolor_for_render"


def add_camera_and_lights(context, obj):
    """Add a camera that frames a scan's object, and plain lights, to the scene; all is ready to render.

    What was added before, for this or another object, makes room for it.
    """
    scene = context.scene
    for added in [other for other in scene.objects if _ADDED in other]:
        bpy.data.objects.remove(added)
    view = view_of(obj, SIZE[0] / SIZE[1])

    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera[_ADDED] = True
    toward = Vector(view.target - view.position)
    camera.location = view.position
    camera.rotation_euler = toward.to_track_quat("-Z", "Y").to_euler()
    camera.data.angle = math.radians(view.fov_deg)
    camera.data.clip_start, camera.data.clip_end = view.clip
    scene.collection.objects.link(camera)
    scene.camera = camera
    for name, direction, share in _LIGHTS:
        light = bpy.data.objects.new(name, bpy.data.lights.new(name, "SUN"))
        light[_ADDED] = True
        light.data.energy = math.pi * share
        light.data.use_shadow = False
        from_where = -toward if direction is None else Vector(direction)
        light.rotation_euler = (-from_where).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(light)
    _set_up_scene(scene)


def render(context, path):
    """Render the scene to a PNG file."""
    scene = context.scene
    kept, scene.render.filepath = scene.render.filepath, str(path)
    try:
        with _seen_from_the_scanned_side(context):
            bpy.ops.render.render(write_still=True)
    finally:
        scene.render.filepath = kept


def _set_up_scene(scene):
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 16
    scene.cycles.seed = 0
    scene.cycles.max_bounces = 0
    scene.cycles.transparent_max_bounces = 32
    scene.cycles.use_denoising = False
    # Colors as they are; Blender's default view would gray them.
    scene.view_settings.view_transform = "Standard"
    world = bpy.data.worlds.new("Plain")
    scene.world = world
    background = next(node for node in node_tree_of(world).nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1.0)
    world.cycles_visibility.diffuse = False


@contextmanager
def _seen_from_the_scanned_side(context):
    """For one render, make faces transparent from behind, so that one looks into a scanned room."""
    layer = context.view_layer
    material = bpy.data.materials.new("Scanned Side")
    nodes, links = node_tree_of(material).nodes, material.node_tree.links
    nodes.clear()
    color, diffuse, transparent = (
        nodes.new(f"ShaderNode{kind}") for kind in ("VertexColor", "BsdfDiffuse", "BsdfTransparent")
    )
    geometry, mix, output = (nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "MixShader", "OutputMaterial"))
    links.new(color.outputs["Color"], diffuse.inputs["Color"])
    links.new(geometry.outputs["Backfacing"], mix.inputs[0])
    links.new(diffuse.outputs[0], mix.inputs[1])
    links.new(transparent.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    layer.material_override = material
    try:
        yield
    finally:
        layer.material_override = None
        bpy.data.materials.remove(material)
