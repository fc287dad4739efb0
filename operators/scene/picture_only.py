"""Leaves of a scene what its picture shows, so that a render takes less memory and time."""

from ...reflcolor_addon.files.memory import give_back
from .picture_material import SMOOTH_NORMAL
from .render import render
from .shown_surface import MIXED, apply_surface

# Attributes that say how faces are shaded.
_SHADING = {"material_index", "sharp_edge", "sharp_face"}
# Pixels of a tile's side: Cycles keeps one tile in memory, and those that are finished in its temporary folder.
_TILE = 512


def leave_picture_only(context, objects):
    """Leave of scans' objects only what the render of a scene reads; it is of no other use any more.

    The picture is the same to the bit.

    Parameters
    ----------
    context : bpy.types.Context
    objects : list of bpy.types.Object
        Set up by `set_up_picture`.
    """
    for obj in objects:
        read = _read_by_materials(obj.data) | _SHADING
        _strip(obj.data, read | {MIXED})
        context.view_layer.update()
        give_back()
        apply_surface(context, obj, smooth=SMOOTH_NORMAL in read)
        _strip(obj.data, read)
    # Blender keeps what it evaluated until then.
    context.view_layer.update()
    give_back()


def render_in_tiles(context, path):
    """Render as `render` does, the same pixels, in less memory; without tiles where they cannot be kept."""
    cycles, shown = context.scene.cycles, context.scene.render
    cycles.use_auto_tile, cycles.tile_size = True, _TILE
    try:
        render(context, path)
    except RuntimeError:
        # Cycles may have no room for tiles; whatever else is wrong is raised again.
        cycles.tile_size = max(shown.resolution_x, shown.resolution_y)
        render(context, path)


def _read_by_materials(mesh):
    """Names of the attributes and UV maps that the materials of a mesh read."""
    trees = [material.node_tree for material in mesh.materials if material is not None and material.node_tree]
    nodes = [node for tree in trees for node in tree.nodes]
    named = {node.attribute_name for node in nodes if node.type == "ATTRIBUTE"}
    return named | {node.uv_map for node in nodes if node.type == "UVMAP"}


def _strip(mesh, kept):
    for name in [each.name for each in mesh.attributes if not each.is_required and each.name not in kept]:
        mesh.attributes.remove(mesh.attributes[name])
