"""Node trees of materials and worlds."""


def node_tree_of(owner):
    """Return the node tree of a new material or world; Blender 4.5 makes it on demand, 5.0 and later always."""
    if owner.node_tree is None:
        owner.use_nodes = True
    return owner.node_tree
