"""NumPy arrays to and from Blender's images, which store rows from the bottom up."""

import bpy
import numpy as np

from ..reflcolor_addon.virtual_camera import linear_to_srgb8


def write_image(image, name, pixels, *, is_data, keep=True):
    """Put pixels into an image; ``image`` is replaced in place, or made if None.

    Parameters
    ----------
    image : bpy.types.Image or None
    name : str
        For a new image.
    pixels : (H, W) float32 of 0..1, or (H, W, 3) uint8
    is_data : bool
        Whether the values are no colors.
    keep : bool
        Whether it is kept in the .blend.

    Returns
    -------
    bpy.types.Image
    """
    height, width = pixels.shape[:2]
    if image is None:
        image = bpy.data.images.new(name, width, height, alpha=False, is_data=is_data)
    elif tuple(image.size) != (width, height):
        image.scale(width, height)
    rgba = np.ones((height, width, 4), np.float32)
    if pixels.dtype == np.uint8:
        np.divide(pixels[::-1], np.float32(255), out=rgba[..., :3])
    else:
        rgba[..., :3] = pixels[::-1, :, None]
    image.pixels.foreach_set(rgba.ravel())
    image.update()
    if keep:
        image.pack()
    return image


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
    if not image.has_data or not (0 <= x <= width and 0 <= y <= height) or image.channels < 3:
        return None
    column, row = min(int(x), width - 1), height - 1 - min(int(y), height - 1)
    start = (row * width + column) * image.channels
    return tuple(image.pixels[start : start + 3])


def read_pixels(image):
    """Return an image as (H, W, 3) uint8, as stored, row 0 at the top; None where it cannot be read."""
    width, height = image.size
    if not image.has_data or not width or image.channels < 3:
        return None
    stored = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(stored)
    pixels = stored.reshape(height, width, image.channels)[::-1, :, :3]
    return np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
