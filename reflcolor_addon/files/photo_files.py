"""Files that photos are taken from: an image, or an E57 with photos inside."""

from pathlib import Path

from .images import IMAGE_SUFFIXES, read_image
from .photo import Photo
from .readers.e57_photos import read_photos

PHOTO_SUFFIXES = (*IMAGE_SUFFIXES, ".e57")
"""For file dialogs."""


def photos_of(path, warnings=None, *, cancelled=None):
    """Read the photos of a file: the one that an image is, or all that an E57 holds.

    Parameters
    ----------
    path : path-like
    warnings : list, optional
        Gets a `Message` for each thing that a person should know.
    cancelled : callable, optional

    Returns
    -------
    list of Photo

    Raises
    ------
    ImageError
        In one line.
    Cancelled
        If ``cancelled()`` returned True.
    """
    path = Path(path)
    if path.suffix.lower() == ".e57":
        return read_photos(path, warnings, cancelled=cancelled)
    return [Photo(name=path.name, rgb=read_image(path, warnings, cancelled=cancelled))]
