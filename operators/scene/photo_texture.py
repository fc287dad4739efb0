"""An image of the photos' resolution on a scan's object."""

from .images import write_image
from .nodes import show_image_in_material
from .scan_object import UV_MAP, own_image


def show_texture(obj, pixels):
    """Lay an image over the grid of an object's scan, kept in the .blend, and show it in renders and exports.

    Parameters
    ----------
    obj : bpy.types.Object
    pixels : (h, w, 3) uint8
        See `matching.texture`.
    """
    state = obj.reflcolor
    state.texture_image = write_image(own_image(obj, "texture_image"), f"{obj.name} Texture", pixels, is_data=False)
    for material in filter(None, obj.data.materials):
        show_image_in_material(material, state.texture_image, UV_MAP)
