"""Photos however they are given: paths, arrays, or all photos inside an E57."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import ImageError
from ..files.photo import Photo
from ..files.photo_files import photos_of
from ..messages import Message
from .photo_image import PhotoImage

_LEAST_SIDE = 16
_TWICE = "another photo has the same name; give each photo once, and another name to one of two"


def opened_photos(photos, warnings=None):
    """Return a `PhotoImage` for each photo: a path, a `Photo`, an array, or a name and an array.

    The path of an E57 stands for all photos inside.

    ``warnings``, a list, gets the warnings about a file.

    Raises
    ------
    ImageError
        If a photo cannot be read, or is too small.
    """
    if isinstance(photos, str | Path | Photo) or (isinstance(photos, np.ndarray) and photos.ndim == 3):
        photos = [photos]
    names = names_of_files([photo for photo in photos if isinstance(photo, str | Path)])
    opened = []
    for number, given in enumerate(photos, 1):
        for photo in _photos(given, number, names, warnings):
            rgb = photo.rgb
            if rgb.ndim != 3 or rgb.shape[2] != 3 or rgb.dtype != np.uint8:
                raise ImageError(
                    "{photo}: expected (H, W, 3) uint8, found {shape} {dtype}",
                    photo=photo.name,
                    shape=rgb.shape,
                    dtype=rgb.dtype,
                )
            if min(rgb.shape[:2]) < _LEAST_SIDE:
                raise ImageError(
                    "{photo}: has {width} x {height} pixels, expected at least {least} on each side",
                    photo=photo.name,
                    width=rgb.shape[1],
                    height=rgb.shape[0],
                    least=_LEAST_SIDE,
                )
            if any(photo.name == other.name for other in opened):
                raise ImageError(
                    "{photo}: {problem}",
                    photo=given if isinstance(given, str | Path) else photo.name,
                    problem=Message(_TWICE),
                )
            opened.append(PhotoImage(photo.name, rgb, photo.place))
    return opened


def _photos(given, number, names, warnings):
    """The `Photo` of whatever was given as one; of an E57 all that are inside."""
    if isinstance(given, Photo):
        return [given]
    if isinstance(given, np.ndarray):
        return [Photo(name=f"photo {number}", rgb=given)]
    if isinstance(given, tuple):
        return [Photo(name=given[0], rgb=given[1])]
    # Photos inside an E57 have names of their own.
    photos, name = photos_of(given, warnings), Path(given).name
    return [replace(photo, name=names[str(given)]) if photo.name == name else photo for photo in photos]


def names_of_files(paths):
    """Return the names of photos: that of the file, where several share it with enough folders to tell them apart.

    Parameters
    ----------
    paths : sequence of path-like

    Returns
    -------
    dict of str to str
        By the path as text, with slashes: "hall.jpg", or "2019/hall.jpg" and "2021/hall.jpg".
    """
    parts = {str(path): Path(path).absolute().parts for path in paths}
    names = {}
    for text, own in parts.items():
        others = [other for key, other in parts.items() if key != text and other != own]
        count = 1
        while count < len(own) and any(other[-count:] == own[-count:] for other in others):
            count += 1
        names[text] = "/".join(own[-count:])
    return names
