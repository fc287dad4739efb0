"""Photos as Blender's images, with what their files say about where they were taken."""

from dataclasses import dataclass

import numpy as np

from ...reflcolor_addon.errors import Cancelled
from ...reflcolor_addon.files.photo import Photo, Place
from ...reflcolor_addon.report.report import input_entry
from .images import packed_pixels, read_pixels, remember_pixels, write_packed
from .photo_list import list_photo
from .provenance import record_photo

PLACE = "reflcolor_place"
"""Custom property of images: the nine numbers of `Place.rotation`, the three of its center, and its focal length."""


@dataclass(frozen=True, eq=False)
class PhotoFile:
    """The photos of a file, ready to become images; made by `photo_file`.

    Attributes
    ----------
    entry : dict
        From `input_entry`.
    photos : list of Photo
    packed : list of bytes
        Each photo as `packed_pixels` gives it.
    """

    entry: dict
    photos: list[Photo]
    packed: list[bytes]


def photo_file(photos, path, *, cancelled=None):
    """Return the PhotoFile of a list of Photo that were read from a file; touches no bpy, a thread may call it.

    Raises
    ------
    ReflcolorError
        If the file can no longer be read, or a photo cannot be kept.
    Cancelled
        If ``cancelled()`` returned True.
    """
    entry, packed = input_entry("photo", path, cancelled), []
    for photo in photos:
        if cancelled is not None and cancelled():
            raise Cancelled
        packed.append(packed_pixels(photo.rgb, photo.name))
    return PhotoFile(entry, photos, packed)


def add_photos(context, file):
    """Make an image of each photo of a PhotoFile and put it on the scene's list; return the images."""
    images = []
    for photo, packed in zip(file.photos, file.packed, strict=True):
        # Not Blender's own loader, which ignores the orientation that a camera stores in the file.
        image = write_packed(None, photo.name, packed, is_data=False)
        remember_pixels(image, photo.rgb)
        record_photo(image, file.entry)
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
        What was taken off the scene's coordinates, meters.
    """
    pixels, stored = read_pixels(image), image.get(PLACE)
    if pixels is None:
        return None
    if stored is None or len(stored) != 13:
        return Photo(name=image.name, rgb=pixels)
    numbers = np.array(stored, np.float64)
    place = Place(rotation=numbers[:9].reshape(3, 3), center=numbers[9:12] - shift, focal_px=float(numbers[12]))
    return Photo(name=image.name, rgb=pixels, place=place)
