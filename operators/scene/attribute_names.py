"""Attribute names of files that earlier versions saved: PLY and others refuse the blanks that were in them."""

import bpy
from bpy.app.handlers import persistent

from .nodes import show_in_material

_PRESENT = {
    "Reflectance Gray": "Reflectance_Gray",
    "Scanned Color": "Scanned_Color",
    "Confidence Map": "Confidence_Map",
    "Nearest Seed Map": "Nearest_Seed_Map",
    "Range Map": "Range_Map",
    "Error Map": "Error_Map",
    "Scan Grid": "Scan_Grid",
}


def rename_attributes(objects):
    """Give the attributes of scans among some objects their present names, and the nodes that show them.

    Linked meshes, too: that lasts as long as the file is open, and is done again when it is opened again.
    """
    for mesh in {obj.data for obj in objects if obj.type == "MESH" and obj.reflcolor.rows}:
        for old, new in _PRESENT.items():
            attribute = mesh.attributes.get(old)
            if attribute is not None and new not in mesh.attributes:
                attribute.name = new
        for material in filter(None, mesh.materials):
            for old, new in _PRESENT.items():
                show_in_material(material, new, instead_of=(old,))


@persistent
def _file_was_loaded(_path):
    rename_attributes(bpy.data.objects)


@persistent
def _data_were_imported(context):
    rename_attributes(item.id for item in context.import_items if isinstance(item.id, bpy.types.Object))


handlers = (
    (bpy.app.handlers.load_post, _file_was_loaded),
    (bpy.app.handlers.blend_import_post, _data_were_imported),
)
