"""Bricks to build a scene from: simple solids, and materials with a color for the eye and an albedo for the laser."""

import math

import bpy
import numpy as np


def empty_scene():
    """Start from nothing; return the scene."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene


def hex_color(text):
    """Linear RGB of an sRGB color written as "#rrggbb"."""
    srgb = np.array([int(text[at : at + 2], 16) for at in (1, 3, 5)]) / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def paint(name, color, nir, *, roughness=0.6, metallic=0.0, variation=0.0, grain_per_m=6.0):
    """Return a material of one color, "#rrggbb", and one near-infrared albedo.

    With ``variation`` both drift together by about this share, in clouds of ``grain_per_m``, as those of plaster do.
    """
    material, shader = _principled(name, roughness, metallic)
    if variation == 0:
        shader.inputs["Base Color"].default_value = (*hex_color(color), 1)
        material["nir_albedo"] = nir
        return material
    tree = material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = grain_per_m
    noise.inputs["Detail"].default_value = 4.0
    tree.links.new(_object_coordinates(tree), noise.inputs["Vector"])
    clouds = _map_range(tree, noise.outputs[0], (0.25, 0.75), (1 - variation, 1 + variation))
    tree.links.new(_scaled(tree, (*hex_color(color), 1), clouds), shader.inputs["Base Color"])
    _to_laser(tree, _scaled(tree, (nir, nir, nir, 1), clouds))
    return material


def courses(name, colors, nirs, size_m, *, joint_m=0.004, offset=0.5, axes="XY", roughness=0.6, grain=0.0):
    """Return a material of planks, tiles or bricks.

    Parameters
    ----------
    colors : three "#rrggbb"
        Every piece is a mixture of the first two; the third is the joint.
    nirs : three floats
        Their near-infrared albedos, mixed alike.
    size_m : (length, height) of a piece
    axes : "XY" or "XZ" or "YZ" or "YX"
        Along which object axes length and height lie.
    grain : float
        Share by which wood grain drawn out along a piece drifts.
    """
    material, shader = _principled(name, roughness, 0.0)
    tree = material.node_tree
    split, joined = tree.nodes.new("ShaderNodeSeparateXYZ"), tree.nodes.new("ShaderNodeCombineXYZ")
    tree.links.new(_object_coordinates(tree), split.inputs[0])
    for place, axis in enumerate(axes):
        tree.links.new(split.outputs["XYZ".index(axis)], joined.inputs[place])
    drift = None
    if grain:
        stretched = tree.nodes.new("ShaderNodeVectorMath")
        stretched.operation = "MULTIPLY"
        stretched.inputs[1].default_value = (2.0, 45.0, 1.0)
        noise = tree.nodes.new("ShaderNodeTexNoise")
        noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 1.0, 3.0
        tree.links.new(joined.outputs[0], stretched.inputs[0])
        tree.links.new(stretched.outputs[0], noise.inputs["Vector"])
        drift = _map_range(tree, noise.outputs[0], (0.25, 0.75), (1 - grain, 1 + grain))
    linear = [(*hex_color(color), 1) for color in colors]
    gray = [(nir, nir, nir, 1) for nir in nirs]
    for values, connect in (
        (linear, lambda socket: tree.links.new(socket, shader.inputs["Base Color"])),
        (gray, lambda socket: _to_laser(tree, socket)),
    ):
        brick = tree.nodes.new("ShaderNodeTexBrick")
        brick.offset = offset
        for socket, value in zip(("Color1", "Color2", "Mortar"), values, strict=True):
            brick.inputs[socket].default_value = value
        brick.inputs["Scale"].default_value = 1.0
        brick.inputs["Brick Width"].default_value, brick.inputs["Row Height"].default_value = size_m
        brick.inputs["Mortar Size"].default_value = joint_m
        tree.links.new(joined.outputs[0], brick.inputs["Vector"])
        connect(brick.outputs["Color"] if drift is None else _scaled(tree, brick.outputs["Color"], drift))
    return material


def box(name, center, size, material, *, turn_deg=0.0):
    """Add a box standing upright, turned about Z."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    item = _mesh_object(name, corners, faces, [material])
    item.location, item.rotation_euler = center, (0, 0, math.radians(turn_deg))
    return item


def lathe(name, base, profile, materials, *, segments=64, smooth=True):
    """Add a solid of revolution about the vertical through ``base``.

    Parameters
    ----------
    profile : list of (radius, height, slot)
        From bottom to top; ``slot`` is the material of the ring that ends there.
    """
    turn = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(segments, z)]) for r, z, _ in profile]
    faces, slots = [tuple(range(segments))[::-1]], [profile[0][2]]
    for ring in range(1, len(profile)):
        for i in range(segments):
            j, low, high = (i + 1) % segments, (ring - 1) * segments, ring * segments
            faces.append((low + i, low + j, high + j, high + i))
            slots.append(profile[ring][2])
    faces.append(tuple(range((len(profile) - 1) * segments, len(profile) * segments)))
    slots.append(profile[-1][2])
    item = _mesh_object(name, np.concatenate(rings), faces, materials)
    item.data.polygons.foreach_set("material_index", slots)
    item.data.polygons.foreach_set("use_smooth", [smooth and len(face) == 4 for face in faces])
    item.location = base
    return item


def ball(name, center, radii, material, *, segments=32, turn_deg=0.0):
    """Add an ellipsoid."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)[1:-1]
    item = lathe(name, center, [(np.cos(a), np.sin(a), 0) for a in angles], [material], segments=segments)
    item.scale, item.rotation_euler = radii, (0, 0, math.radians(turn_deg))
    return item


def rod(name, start, end, radius, material, *, end_radius=None, segments=24):
    """Add a round rod, tapering where ``end_radius`` says so."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = np.linalg.norm(end - start)
    item = lathe(name, start, [(radius, 0, 0), (end_radius or radius, length, 0)], [material], segments=segments)
    along = (end - start) / length
    item.rotation_euler = (0, math.acos(np.clip(along[2], -1, 1)), math.atan2(along[1], along[0]))
    return item


def panel(name, corners, material):
    """Add a flat polygon."""
    return _mesh_object(name, np.asarray(corners, float), [tuple(range(len(corners)))], [material])


def area_light(name, position, target, size_m, watts, color="#ffffff"):
    """Add a square lamp."""
    data = bpy.data.lights.new(name, "AREA")
    data.energy, data.size, data.color = watts, size_m, hex_color(color)
    return _aimed(name, data, position, target)


def sun(name, direction, strength, *, angle_deg=0.5, color="#ffffff"):
    """Add sunlight that falls along ``direction``."""
    data = bpy.data.lights.new(name, "SUN")
    data.energy, data.angle, data.color = strength, math.radians(angle_deg), hex_color(color)
    return _aimed(name, data, (0, 0, 10), np.add((0, 0, 10), direction))


def sky(color, strength):
    """Surround the scene with even light."""
    world = bpy.data.worlds.new("sky")
    if world.node_tree is None:
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*hex_color(color), 1)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = world


def _principled(name, roughness, metallic):
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Roughness"].default_value, shader.inputs["Metallic"].default_value = roughness, metallic
    return material, shader


def _object_coordinates(tree):
    return tree.nodes.new("ShaderNodeTexCoord").outputs["Object"]


def _map_range(tree, socket, source, target):
    node = tree.nodes.new("ShaderNodeMapRange")
    for place, value in enumerate((*source, *target), 1):
        node.inputs[place].default_value = value
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0]


def _scaled(tree, color, factor):
    """A color (socket or value) times a number (socket)."""
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = "SCALE"
    if isinstance(color, tuple):
        node.inputs[0].default_value = color[:3]
    else:
        tree.links.new(color, node.inputs[0])
    tree.links.new(factor, node.inputs["Scale"])
    return node.outputs[0]


def _to_laser(tree, socket):
    output = tree.nodes.new("ShaderNodeOutputAOV")
    output.aov_name = "nir_albedo"
    # A gray color's first component is its value.
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(socket, split.inputs[0])
    tree.links.new(split.outputs[0], output.inputs["Value"])


def _mesh_object(name, vertices, faces, materials):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces)
    for material in materials:
        mesh.materials.append(material)
    mesh.update()
    item = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(item)
    return item


def _aimed(name, data, position, target):
    item = bpy.data.objects.new(name, data)
    way = np.subtract(target, position)
    along = way / np.linalg.norm(way)
    item.location = position
    # A lamp shines along its -Z.
    item.rotation_euler = (0, math.acos(np.clip(-along[2], -1, 1)), math.atan2(-along[1], -along[0]))
    bpy.context.scene.collection.objects.link(item)
    return item
