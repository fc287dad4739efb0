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


def shown_image(material):
    """Return the image that a material shows instead of its mesh's colors; None where it shows those."""
    image, _ = _image_and_colors(material)
    return image.image if image is not None and image.outputs["Color"].is_linked else None


def show_image_again(material):
    """Let a material that was switched to its mesh's colors show its image again."""
    image, colors = _image_and_colors(material)
    _relink(material, colors, image)


def _show_no_image(material):
    """Let a material that shows such an image show its mesh's colors again."""
    image, colors = _image_and_colors(material)
    _relink(material, image, colors)


def _image_and_colors(material):
    """The nodes of a material's image and of its mesh's colors; None where it has none."""
    nodes = material.node_tree.nodes if material.node_tree else {}
    colors = next((node for node in nodes.values() if node.type in ("ATTRIBUTE", "VERTEX_COLOR")), None)
    return nodes.get(_TEXTURE), colors


def _relink(material, before, after):
    """Let one node's color go wherever that of another went."""
    if before is None or after is None:
        return
    for link in list(before.outputs["Color"].links):
        material.node_tree.links.new(after.outputs["Color"], link.to_socket)
