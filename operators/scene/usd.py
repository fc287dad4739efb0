"""Scans into USD by Blender's exporter, with colors that every viewer of USD shows."""

from contextlib import contextmanager

import bpy

from .nodes import show_image_again, show_in_material, shown_image
from .scan_object import SHOWN_IN_RENDERS, add_colors, colors_of, shown_in_renders
from .shown_surface import as_measured

# The color that viewers show without a material, and that the preview surface reads.
_DISPLAY_COLOR = "displayColor"


def write_usd(context, objects, path):
    """Write scans' objects into a USD file.

    Colors are ``displayColor``, linear as USD has them, and the material's preview surface reads them there.

    Parameters
    ----------
    context : bpy.types.Context
    objects : sequence of bpy.types.Object
        Whose meshes can be written to.
    path : path-like
        Absolute; its suffix is .usd, .usda or .usdc.
    """
    selected, active = context.selected_objects, context.view_layer.objects.active
    with _displayed(objects), as_measured(objects), _selected(context, objects, selected, active):
        bpy.ops.wm.usd_export(
            filepath=str(path),
            check_existing=False,
            selected_objects_only=True,
            evaluation_mode="VIEWPORT",
            export_materials=True,
            generate_preview_surface=True,
            export_custom_properties=False,
            root_prim_path="/root",
        )


@contextmanager
def _displayed(objects):
    """Within the block the colors that renders show have the name that USD gives to what is displayed."""
    shown = [(obj, shown_in_renders(obj)) for obj in objects]
    materials = {material for obj in objects for material in obj.data.materials if material is not None}
    with_image = [material for material in materials if shown_image(material) is not None]
    for obj, name in shown:
        add_colors(obj, _DISPLAY_COLOR, colors_of(obj, name))
        for material in filter(None, obj.data.materials):
            show_in_material(material, _DISPLAY_COLOR, instead_of=SHOWN_IN_RENDERS)
    try:
        yield
    finally:
        for obj, name in shown:
            for material in filter(None, obj.data.materials):
                show_in_material(material, name, instead_of=(_DISPLAY_COLOR,))
            obj.data.attributes.remove(obj.data.attributes[_DISPLAY_COLOR])
        for material in with_image:
            show_image_again(material)


@contextmanager
def _selected(context, objects, selected, active):
    """Within the block only some objects are selected."""
    for obj in selected:
        obj.select_set(False)
    for obj in objects:
        obj.select_set(True)
    try:
        yield
    finally:
        for obj in objects:
            obj.select_set(obj in selected)
        for obj in selected:
            obj.select_set(True)
        context.view_layer.objects.active = active
