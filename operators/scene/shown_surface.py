"""The surface of a scan as pictures show it: the scan's own, with small holes filled and smooth outlines.

A modifier joins it to the scan's mesh, in renders only unless a person turns it on in viewports, too; the mesh itself,
and all that is measured on it, stays as it is. What is added has the attribute ``filled`` of 1.
"""

from contextlib import contextmanager

import bpy
import numpy as np

from ...reflcolor_addon.scan.grid_mesh import MAX_INCIDENCE_DEG
from ...reflcolor_addon.view.shown_surface import shown_surface
from .picture_material import SMOOTH_NORMAL
from .scan_object import (
    CENTER,
    MAX_INCIDENCE,
    SHOWN_IN_RENDERS,
    UV_MAP,
    add_values,
    grid_indices,
    scan_reader,
    vertex_of_pixels,
)

MODIFIER = "Shown Surface"
FILLED, MIXED = "filled", "mixed"
_SOURCE = "source"
# Custom property of node groups: whether the holes left by mixed returns are filled.
_WITHOUT_MIXED = "reflcolor_without_mixed"
_SMOOTHINGS = 4


def surface_maker(obj, *, drop_mixed):
    """Return ``make(progress, cancelled)``, which gives the ShownSurface of a scan's object and touches no bpy.

    Raises
    ------
    ScanError
        As `scan_reader`.
    """
    read, incidence = scan_reader(obj), obj.data.get(MAX_INCIDENCE, MAX_INCIDENCE_DEG)
    return lambda progress, cancelled: shown_surface(
        read(), drop_mixed=drop_mixed, max_incidence_deg=incidence, progress=progress, cancelled=cancelled
    )


def add_surface(obj, surface, *, drop_mixed):
    """Have renders show a ShownSurface on a scan's object; one that was there makes room.

    ``drop_mixed`` tells how the surface was made.
    """
    remove_surface(obj)
    add_values(obj, MIXED, surface.mixed[grid_indices(obj)].astype(np.int32))
    vertex = vertex_of_pixels(obj)
    added = bpy.data.objects.new(f"{obj.name} {MODIFIER}", _mesh(obj, surface, vertex))
    modifier = obj.modifiers.new(MODIFIER, "NODES")
    modifier.node_group = _nodes(added)
    modifier.node_group[_WITHOUT_MIXED] = drop_mixed
    modifier.show_viewport = False
    obj.modifiers.move(len(obj.modifiers) - 1, 0)


def has_surface(obj, *, drop_mixed):
    """Whether `switch_surface` can show a scan with its holes filled, and without mixed returns if they are dropped."""
    modifier = obj.modifiers.get(MODIFIER)
    if modifier is None or modifier.node_group is None:
        return False
    return not drop_mixed or bool(modifier.node_group.get(_WITHOUT_MIXED))


def remove_surface(obj):
    """Have renders show the scan's mesh as it is."""
    modifier = obj.modifiers.get(MODIFIER)
    if modifier is None:
        return
    group = modifier.node_group
    obj.modifiers.remove(modifier)
    if group is None or group.users:
        return
    added = next((node.inputs["Object"].default_value for node in group.nodes if node.type == "OBJECT_INFO"), None)
    bpy.data.node_groups.remove(group)
    if added is not None and not added.users:
        bpy.data.meshes.remove(added.data)


def apply_surface(context, obj, *, smooth):
    """Make what renders show of a scan its object's mesh; nothing is left of the scan's own.

    ``smooth`` tells whether anything reads the smooth normals.
    """
    modifier = obj.modifiers.get(MODIFIER)
    if modifier is None:
        return
    if not modifier.show_render:
        remove_surface(obj)
        return
    for node in modifier.node_group.nodes:
        if node.bl_idname == "GeometryNodeStoreNamedAttribute" and node.inputs["Name"].default_value == SMOOTH_NORMAL:
            node.mute = not smooth
    modifier.show_viewport = True
    depsgraph = context.evaluated_depsgraph_get()
    measured = obj.data
    obj.data = bpy.data.meshes.new_from_object(
        obj.evaluated_get(depsgraph), preserve_all_data_layers=True, depsgraph=depsgraph
    )
    remove_surface(obj)
    bpy.data.meshes.remove(measured)


@contextmanager
def as_measured(objects):
    """Within the block, viewports show the measured surface of scans' objects alone."""
    modifiers = [obj.modifiers[MODIFIER] for obj in objects if MODIFIER in obj.modifiers]
    shown = [modifier for modifier in modifiers if modifier.show_viewport]
    for modifier in shown:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in shown:
            modifier.show_viewport = True


def switch_surface(obj, *, shown, drop_mixed):
    """Have renders show what was added to a scan, or not; and with it mixed returns, or not."""
    modifier = obj.modifiers.get(MODIFIER)
    if modifier is None or modifier.node_group is None:
        return
    modifier.show_render = shown
    for node in modifier.node_group.nodes:
        if node.type == "DELETE_GEOMETRY":
            node.mute = not drop_mixed


def _mesh(obj, surface, vertex):
    """The mesh of what is added, in the coordinates of the scan's own."""
    mesh = bpy.data.meshes.new(f"{obj.name} {MODIFIER}")
    center = np.array(obj.data.get(CENTER, (0, 0, 0)))
    local = (surface.points - center) / bpy.context.scene.unit_settings.scale_length
    mesh.vertices.add(len(local))
    mesh.loops.add(len(surface.corners))
    mesh.polygons.add(len(surface.sizes))
    if len(surface.sizes):
        mesh.attributes["position"].data.foreach_set("vector", local.astype(np.float32).ravel())
        mesh.attributes[".corner_vert"].data.foreach_set("value", surface.corners)
        mesh.polygons.foreach_set("loop_start", surface.starts)
    mesh.update(calc_edges=True)
    mesh.uv_layers.new(name=UV_MAP).uv.foreach_set("vector", surface.uv.ravel())
    source = np.maximum(vertex[surface.source], 0).astype(np.int32)
    mesh.attributes.new(_SOURCE, "INT", "POINT").data.foreach_set("value", source)
    for material in obj.data.materials:
        mesh.materials.append(material)
    return mesh


def _nodes(added):
    """Geometry nodes that leave out the mixed vertices of a mesh, and join what is added, in the mesh's own colors."""
    tree = bpy.data.node_groups.new(added.name, "GeometryNodeTree")
    tree.is_modifier = True
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    make = _Maker(tree)
    given, result = make.node("NodeGroupInput"), make.node("NodeGroupOutput")
    measured = make.node("GeometryNodeDeleteGeometry", domain="POINT")
    make.link(make.named(MIXED, "INT"), measured.inputs["Selection"])
    info = make.node("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = added
    shown = info.outputs["Geometry"]
    # The roughness of a scan's measured surface would show in the light as speckles.
    smooth = make.node("GeometryNodeBlurAttribute", data_type="FLOAT_VECTOR")
    make.link(make.node("GeometryNodeInputNormal").outputs[0], _open(smooth.inputs, "Value"))
    _open(smooth.inputs, "Iterations").default_value = _SMOOTHINGS
    normal = _open(smooth.outputs, "Value")
    source = make.named(_SOURCE, "INT")
    whole = make.stored(given.outputs[0], SMOOTH_NORMAL, "FLOAT_VECTOR", normal)
    make.link(whole, measured.inputs["Geometry"])
    for name, data_type in ((SMOOTH_NORMAL, "FLOAT_VECTOR"), *((name, "FLOAT_COLOR") for name in SHOWN_IN_RENDERS)):
        sample = make.node("GeometryNodeSampleIndex", data_type=data_type, domain="POINT")
        make.link(whole, _open(sample.inputs, "Geometry"))
        make.link(make.named(name, data_type), _open(sample.inputs, "Value"))
        make.link(source, _open(sample.inputs, "Index"))
        kept = "BYTE_COLOR" if data_type == "FLOAT_COLOR" else data_type
        shown = make.stored(shown, name, kept, _open(sample.outputs, "Value"))
    shown = make.stored(shown, FILLED, "INT", 1)
    joined = make.node("GeometryNodeJoinGeometry")
    # The last link comes first, so that the scan's own vertices keep their numbers.
    make.link(shown, joined.inputs[0])
    make.link(measured.outputs[0], joined.inputs[0])
    make.link(joined.outputs[0], result.inputs[0])
    return tree


class _Maker:
    """Makes and links the nodes of a tree."""

    def __init__(self, tree):
        self._tree = tree

    def node(self, kind, **settings):
        node = self._tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        node.location = 200 * len(self._tree.nodes), 0
        return node

    def link(self, output, socket):
        self._tree.links.new(output, socket)

    def named(self, name, data_type):
        """The output of a node that reads an attribute."""
        node = self.node("GeometryNodeInputNamedAttribute", data_type=data_type)
        node.inputs["Name"].default_value = name
        return _open(node.outputs, "Attribute")

    def stored(self, geometry, name, data_type, value):
        """The output of a node that writes an attribute of points, from another output or a number."""
        node = self.node("GeometryNodeStoreNamedAttribute", data_type=data_type, domain="POINT")
        node.inputs["Name"].default_value = name
        self.link(geometry, node.inputs["Geometry"])
        socket = _open(node.inputs, "Value")
        if isinstance(value, int):
            socket.default_value = value
        else:
            self.link(value, socket)
        return node.outputs[0]


def _open(sockets, name):
    """The socket of that name that the node's type of data makes available."""
    return next(socket for socket in sockets if socket.name == name and socket.enabled)
