"""Node trees of materials and worlds."""

# Name of the node that shows an image of the photos' resolution.
_TEXTURE = "Photo Texture"


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
    _show_no_image(material)


def show_image_in_material(material, image, uv_map):
    """Let a material show an image, laid over a UV map, instead of what feeds its color."""
    tree = node_tree_of(material)
    shader = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if shader is None:
        return
    node = tree.nodes.get(_TEXTURE)
    if node is None:
        node, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        node.name = node.label = _TEXTURE
        place.uv_map = uv_map
        node.location = shader.location.x - 350, shader.location.y - 200
        place.location = node.location.x - 250, node.location.y
        tree.links.new(place.outputs["UV"], node.inputs["Vector"])
    node.image = image
    tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])


def _show_no_image(material):
    """Let a material that shows such an image show its mesh's colors again."""
    tree = material.node_tree
    node = tree.nodes.get(_TEXTURE) if tree else None
    colors = next((node for node in tree.nodes if node.type in ("ATTRIBUTE", "VERTEX_COLOR")), None) if node else None
    if colors is not None:
        for link in list(node.outputs["Color"].links):
            tree.links.new(colors.outputs["Color"], link.to_socket)
