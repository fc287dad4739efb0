"""An image of the photos' resolution on a scan's object."""

import bpy

from .images import packed_pixels, read_pixels, write_packed
from .nodes import show_image_in_material, shown_image
from .scan_object import UV_MAP, own_image

# How files of PNG and JPEG begin.
_EMBEDDABLE = (b"\x89PNG", b"\xff\xd8\xff")


def texture_image(obj):
    """Return the image that renders show on a scan's object; None where they show the colors of its vertices."""
    images = (shown_image(material) for material in obj.data.materials if material is not None)
    return next((image for image in images if image is not None), None)


def texture_file(obj):
    """Return that image as the bytes of a file, PNG or JPEG; None where there is none that can be read."""
    image = texture_image(obj)
    if image is None:
        return None
    if image.packed_file is not None and image.packed_file.data.startswith(_EMBEDDABLE) and not image.is_dirty:
        return image.packed_file.data
    pixels = read_pixels(image)
    return None if pixels is None else packed_pixels(pixels, image.name)


def show_texture(obj, pixels):
    """Lay an image over the grid of an object's scan, kept in the .blend, and show it in renders and exports.

    Parameters
    ----------
    obj : bpy.types.Object
    pixels : (h, w, 3) uint8, bytes, or bpy.types.Image
        See `matching.texture`; or what `packed_pixels` made of it, or an image that there is.
    """
    state, name = obj.reflcolor, f"{obj.name} Texture"
    if isinstance(pixels, bpy.types.Image):
        state.texture_image = pixels
    else:
        packed = pixels if isinstance(pixels, bytes) else packed_pixels(pixels, name)
        state.texture_image = write_packed(own_image(obj, "texture_image"), name, packed, is_data=False)
    for material in filter(None, obj.data.materials):
        show_image_in_material(material, state.texture_image, UV_MAP)
