"""How a scan's material looks in a picture: its colors exactly as they are, or in even light; see-through from behind.

The nodes for this end in outputs of their own for Cycles and EEVEE. The material's first output, which exporters read,
stays as it is.
"""

from .nodes import node_tree_of

UNLIT, LIT = "UNLIT", "LIT"
# On nodes: made for pictures.
_MADE = "reflcolor_picture"
# Of a surface's color, what it shows whatever the light; a sun gives it the rest where it faces it.
AMBIENT_SHARE = 0.45


def give_look(material, look):
    """Give a material the look of pictures, UNLIT or LIT; what was made for another look makes room."""
    tree = node_tree_of(material)
    for node in [node for node in tree.nodes if _MADE in node]:
        tree.nodes.remove(node)
    surface = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if surface is None:
        return
    make = _Maker(tree, surface.location)
    glow = make.node("Emission", 0)
    make.color(surface.inputs["Base Color"], glow.inputs["Color"])
    shown = glow
    if look == LIT:
        glow.inputs["Strength"].default_value = AMBIENT_SHARE
        matte, shown = make.node("BsdfDiffuse", 1), make.node("AddShader", 2)
        make.color(surface.inputs["Base Color"], matte.inputs["Color"])
        make.link(glow.outputs[0], shown.inputs[0])
        make.link(matte.outputs[0], shown.inputs[1])
    # One looks through the back of a wall into a scanned room.
    sides, clear, mix = make.node("NewGeometry", 3), make.node("BsdfTransparent", 4), make.node("MixShader", 5)
    make.link(sides.outputs["Backfacing"], mix.inputs[0])
    make.link(shown.outputs[0], mix.inputs[1])
    make.link(clear.outputs[0], mix.inputs[2])
    for row, engine in enumerate(("CYCLES", "EEVEE"), 6):
        output = make.node("OutputMaterial", row)
        output.target, output.is_active_output = engine, False
        make.link(mix.outputs[0], output.inputs["Surface"])


class _Maker:
    """Makes marked nodes of a tree, below a place."""

    def __init__(self, tree, place):
        self._tree, self._place = tree, place

    def node(self, kind, row):
        node = self._tree.nodes.new(f"ShaderNode{kind}")
        node[_MADE] = True
        node.location = self._place.x, self._place.y - 700 - 160 * row
        return node

    def link(self, output, socket):
        self._tree.links.new(output, socket)

    def color(self, given, socket):
        """Give a socket what another is given: a link, or a color of its own."""
        if given.is_linked:
            self.link(given.links[0].from_socket, socket)
        else:
            socket.default_value = given.default_value
