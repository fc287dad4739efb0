"""NumPy arrays to and from Blender's images, which store rows from the bottom up."""

from collections import OrderedDict

import bpy
import numpy as np

from ...reflcolor_addon.files.images import eight_bits, png_bytes
from ...reflcolor_addon.srgb import linear_to_srgb8

_MOST_REMEMBERED = 4
_remembered = OrderedDict()


def packed_pixels(pixels, name):
    """Return pixels as the PNG that a .blend keeps; a thread may call it: no bpy.

    Parameters
    ----------
    pixels : (H, W) float32 of 0..1, or (H, W, 3) uint8
    name : str
        Of the image.

    Returns
    -------
    bytes
    """
    if pixels.dtype != np.uint8:
        pixels = (np.clip(pixels, 0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)
    return png_bytes(pixels, name)


def write_packed(image, name, data, *, is_data):
    """Put what `packed_pixels` gave into an image, and keep it in the .blend.

    Blender takes the pixels out of it when they are first needed.

    Parameters
    ----------
    image : bpy.types.Image or None
        Is replaced in place; None: a new one is made.
    name : str
        For a new image.
    data : bytes
    is_data : bool
        Whether the values are no colors.

    Returns
    -------
    bpy.types.Image
    """
    if image is None:
        image = bpy.data.images.new(name, 1, 1, alpha=False, is_data=is_data)
    image.pack(data=data, data_len=len(data))
    # Pixels that were decoded before stay otherwise: the source alone changes nothing where it is a file already.
    image.buffers_free()
    image.source = "FILE"
    return image


def put_pixels(image, name, stored, size, *, is_data=False):
    """Put `stored_pixels` of a (width, height) into an image that is replaced in place, or made if None; return it."""
    if image is None:
        image = bpy.data.images.new(name, *size, alpha=False, is_data=is_data)
    elif tuple(image.size) != tuple(size):
        image.scale(*size)
    image.pixels.foreach_set(stored)
    image.update()
    return image


def stored_pixels(rgb):
    """Return (4 H W,) float32, as Blender stores an image, of (H, W, 3) uint8; touches no bpy."""
    import cv2

    # Live Update waits for it, and four channels at once are far quicker than three of four.
    return np.divide(cv2.cvtColor(cv2.flip(rgb, 0), cv2.COLOR_RGB2RGBA), np.float32(255)).ravel()


def read_image(image):
    """Return the pixels of an image that can be read as (H, W, 3) uint8 sRGB, row 0 at the top."""
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1]
    rgb = pixels[..., :3] if image.channels >= 3 else np.repeat(pixels[..., :1], 3, axis=-1)
    # Blender holds images of more than 8 bits as linear light.
    return linear_to_srgb8(rgb) if image.is_float else np.rint(rgb * 255).astype(np.uint8)


def read_pixel(image, x, y):
    """Return the (r, g, b) of 0..1, as stored, of the image's pixel that contains a point measured from the top left.

    Returns None where the point is outside, or the image cannot be read.
    """
    width, height = image.size
    pixels = read_pixels(image) if 0 <= x <= width and 0 <= y <= height else None
    return None if pixels is None else tuple((pixels[min(int(y), height - 1), min(int(x), width - 1)] / 255).tolist())


def read_pixels(image):
    """Return an image as (H, W, 3) uint8, as stored, row 0 at the top; None where it cannot be read.

    What is invisible is black, as `read_image` has it.

    Blender hands out all pixels of an image or none, which takes long for a photo, so the last ones are remembered.
    """
    key = _memory_key(image)
    if image.is_dirty or key not in _remembered:
        width, height = image.size
        if not image.has_data or not width or image.channels < 3:
            return None
        stored = np.empty(width * height * image.channels, np.float32)
        image.pixels.foreach_get(stored)
        pixels = eight_bits(stored.reshape(height, width, image.channels)[::-1])
        if image.is_dirty:
            return pixels
        _remember(key, pixels)
    _remembered.move_to_end(key)
    return _remembered[key]


def remember_pixels(image, pixels):
    """Remember the pixels of an image that was just made, for `read_pixels`."""
    _remember(_memory_key(image), pixels)


def unregister():
    """Forget the remembered image; called before the extension is unregistered."""
    _remembered.clear()


def _remember(key, pixels):
    _remembered[key] = pixels
    while len(_remembered) > _MOST_REMEMBERED:
        _remembered.popitem(last=False)


def _memory_key(image):
    """A key that changes with the content of an image."""
    # Asking for the size of an image would make Blender decode it.
    size = image.packed_file.size if image.packed_file else tuple(image.size)
    return image.session_uid, size, image.source, image.filepath
