"""Node trees of materials and worlds."""


def node_tree_of(owner):
    """Return the node tree of a new material or world; Blender 4.5 makes it on demand, 5.0 and later always."""
    if owner.node_tree is None:
        owner.use_nodes = True
    return owner.node_tree


def color_node(material, name):
    """Add an Attribute node of a mesh's color to a material; return it.

    Not a Color Attribute node, which looks the same but is left out of USD.
    """
    node = node_tree_of(material).nodes.new("ShaderNodeAttribute")
    node.attribute_name = name
    return node


def show_in_material(material, name, instead_of):
    """Let the nodes of a material that show one of some color attributes show another."""
    for node in material.node_tree.nodes if material.node_tree else ():
        if node.type == "ATTRIBUTE" and node.attribute_name in instead_of:
            node.attribute_name = name
        elif node.type == "VERTEX_COLOR" and node.layer_name in instead_of:
            node.layer_name = name
