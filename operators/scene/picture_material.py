"""How a scan's material looks in a picture: its colors exactly as they are, or in even light; see-through from behind.

Light is a formula of the material's, not of lamps: without noise, and the same whatever lamps the scene has.

The nodes for this end in outputs of their own for Cycles and EEVEE. The material's first output, which exporters read,
stays as it is.
"""

from ...reflcolor_addon.view.picture import LIT
from .nodes import node_tree_of

SMOOTH_NORMAL = "smooth_normal"
# Custom property of nodes that were made for pictures.
_MADE = "reflcolor_picture"
# Share of a surface's color that shows whichever way it faces; the rest depends on the angle to the light.
_AMBIENT_SHARE = 0.45


def give_look(material, look, toward_light):
    """Give a material the look of pictures; what was made for another look makes room.

    Parameters
    ----------
    material : bpy.types.Material
    look : {"archive", "lit"}
        As in `Picture`.
    toward_light : (3,) float
        Unit vector in the world.
    """
    tree = node_tree_of(material)
    for node in [node for node in tree.nodes if _MADE in node]:
        tree.nodes.remove(node)
    surface = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if surface is None:
        return
    # Otherwise Cycles would treat every face as a lamp, which costs much time and memory.
    material.cycles.emission_sampling = "NONE"
    make = _Maker(tree, surface.location)
    glow, geometry = make.node("Emission", 0), make.node("NewGeometry", 1)
    make.color(surface.inputs["Base Color"], glow.inputs["Color"])
    if look == LIT:
        facing = make.node("VectorMath", 2, operation="DOT_PRODUCT")
        facing.inputs[1].default_value = toward_light
        make.link(_normal(make, geometry), facing.inputs[0])
        front = make.calculated("MAXIMUM", 3, facing.outputs["Value"], 0.0)
        light = make.calculated("MULTIPLY_ADD", 4, front, 1 - _AMBIENT_SHARE, _AMBIENT_SHARE)
        make.link(light, glow.inputs["Strength"])
    # One looks through the back of a wall into a scanned room.
    clear, mix = make.node("BsdfTransparent", 5), make.node("MixShader", 6)
    make.link(geometry.outputs["Backfacing"], mix.inputs[0])
    make.link(glow.outputs[0], mix.inputs[1])
    make.link(clear.outputs[0], mix.inputs[2])
    for row, engine in enumerate(("CYCLES", "EEVEE"), 7):
        output = make.node("OutputMaterial", row, target=engine, is_active_output=False)
        make.link(mix.outputs[0], output.inputs["Surface"])


def _normal(make, geometry):
    """The output that gives the smooth normal of a shown surface, or the mesh's own where there is none."""
    smooth = make.node("Attribute", 9, attribute_name=SMOOTH_NORMAL)
    turned = make.node("VectorTransform", 10, vector_type="NORMAL", convert_from="OBJECT", convert_to="WORLD")
    make.link(smooth.outputs["Vector"], turned.inputs[0])
    length = make.node("VectorMath", 11, operation="LENGTH")
    make.link(turned.outputs[0], length.inputs[0])
    known = make.calculated("GREATER_THAN", 12, length.outputs["Value"], 0.1)
    chosen = make.node("Mix", 13, data_type="VECTOR")
    own, other = (socket for socket in chosen.inputs if socket.enabled and socket.type == "VECTOR")
    make.link(known, next(socket for socket in chosen.inputs if socket.enabled and socket.type == "VALUE"))
    make.link(geometry.outputs["Normal"], own)
    make.link(turned.outputs[0], other)
    return next(socket for socket in chosen.outputs if socket.enabled)


class _Maker:
    """Makes marked nodes of a tree, below a place."""

    def __init__(self, tree, place):
        self._tree, self._place = tree, place

    def node(self, kind, row, **settings):
        node = self._tree.nodes.new(f"ShaderNode{kind}")
        node[_MADE] = True
        for name, value in settings.items():
            setattr(node, name, value)
        node.location = self._place.x, self._place.y - 700 - 160 * row
        return node

    def link(self, output, socket):
        self._tree.links.new(output, socket)

    def calculated(self, operation, row, first, *numbers):
        """The output of a node that calculates with another output and with numbers."""
        node = self.node("Math", row, operation=operation)
        self.link(first, node.inputs[0])
        for place, number in enumerate(numbers, 1):
            node.inputs[place].default_value = number
        return node.outputs[0]

    def color(self, given, socket):
        """Give a socket what another is given: a link, or a color of its own."""
        if given.is_linked:
            self.link(given.links[0].from_socket, socket)
        else:
            socket.default_value = given.default_value
