"""Photos as Blender's images, with what their files say about where they were taken."""

import numpy as np

from ...reflcolor_addon.files.photo import Photo, Place
from ...reflcolor_addon.report.report import input_entry
from .images import read_pixels, remember_pixels, write_image
from .photo_list import list_photo
from .provenance import record_photo

PLACE = "reflcolor_place"
"""On images: the nine numbers of `Place.rotation`, the three of its center, and its focal length."""


def add_photos(context, photos, path):
    """Make an image of each photo of a file and put it on the scene's list; return the images.

    Parameters
    ----------
    context : bpy.types.Context
    photos : list of Photo
    path : Path
        The file.
    """
    entry, images = input_entry("photo", path), []
    for photo in photos:
        # Not Blender's own loader: it shows a photo lying on its side where the camera only noted how it was held.
        image = write_image(None, photo.name, photo.rgb, is_data=False)
        remember_pixels(image, photo.rgb)
        record_photo(image, entry)
        if photo.place is not None:
            image[PLACE] = [*photo.place.rotation.ravel().tolist(), *photo.place.center.tolist(), photo.place.focal_px]
        list_photo(context.scene, image)
        images.append(image)
    return images


def photo_of(image, shift):
    """Return the Photo that an image holds; None where its pixels cannot be read.

    Parameters
    ----------
    image : bpy.types.Image
    shift : (3,) float64
        What was taken off the scene's coordinates, metres.
    """
    pixels, stored = read_pixels(image), image.get(PLACE)
    if pixels is None:
        return None
    if stored is None or len(stored) != 13:
        return Photo(name=image.name, rgb=pixels)
    numbers = np.array(stored, np.float64)
    place = Place(rotation=numbers[:9].reshape(3, 3), center=numbers[9:12] - shift, focal_px=float(numbers[12]))
    return Photo(name=image.name, rgb=pixels, place=place)
