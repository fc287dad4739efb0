"""What verified photos saw of a scan, kept with its object between the search in photos and the colorization.

It lies at the vertices, where undo, copies and files take care of it. The names begin with a dot, so that Blender shows
them to nobody and no export takes them.
"""

import hashlib
import json
from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np

from ...reflcolor_addon.color.observed import Observed, packed_rgb, unpacked_rgb
from ...reflcolor_addon.errors import ScanError
from ...reflcolor_addon.matching.registration.stored import model_document, model_of
from ...reflcolor_addon.scan.object_arrays import at_places, on_grid
from .scan_object import add_values, grid_indices, values_of
from .steps import complete

_RGB, _WEIGHT, _PHOTO = ".seen_rgb", ".seen_weight", ".seen_photo"
# Custom property of objects: a key that changes with the observed colors.
_KEY = "reflcolor_seen"
# On objects: how the scan falls into each photo, as JSON; as last found, and as it was when the scan was colorized.
_CAMERAS, _USED = "reflcolor_cameras", "reflcolor_used_cameras"
# On objects: the image of each of these photos, which a person may rename, by its place in the list.
_PHOTOS, _USED_PHOTOS = "reflcolor_camera_photos", "reflcolor_used_camera_photos"


@dataclass(frozen=True, eq=False)
class ObservedArrays:
    """`Observed` colors as an object keeps them, ready for Blender: N vertices.

    Parameters
    ----------
    place : ((N,) int32, (N,) int32)
        Rows and columns of the vertices.
    values : dict of (N,) int32 or float32
        By the attribute's name.
    key : str
        See `observed_key`.
    """

    place: tuple[np.ndarray, np.ndarray]
    values: dict[str, np.ndarray]
    key: str

    @classmethod
    def of(cls, observed, place):
        """Make them of Observed colors, for vertices on these pixels; a thread may call it: no bpy."""
        rgb, weight, photo = (at_places(image, place) for image in (observed.rgb, observed.weight, observed.photo))
        values = {_RGB: packed_rgb(rgb), _WEIGHT: weight, _PHOTO: photo.astype(np.int32)}
        digest = hashlib.sha256()
        for each in (values[_RGB], weight, photo):
            digest.update(np.ascontiguousarray(each).tobytes())
        return cls(place, values, digest.hexdigest())


def keep_observed(obj, observed):
    """Keep the `Observed` colors of an object's scan in place of those that are kept; None keeps none.

    Raises
    ------
    ScanError
        If the mesh has lost the attributes that tie its vertices to the scan's grid.
    """
    complete(keep_observed_by_steps(obj, observed))


def keep_observed_by_steps(obj, observed, arrays=None):
    """As `keep_observed`, by steps; ``arrays`` are its ObservedArrays, where a thread has made them before."""
    if observed is None:
        for name in (_RGB, _WEIGHT, _PHOTO):
            if name in obj.data.attributes:
                obj.data.attributes.remove(obj.data.attributes[name])
        for name in (_KEY, _CAMERAS, _PHOTOS):
            if name in obj:
                del obj[name]
        return
    place = grid_indices(obj)
    if arrays is None or not all(map(np.array_equal, arrays.place, place)):
        arrays = ObservedArrays.of(observed, place)
    for name, values in arrays.values.items():
        yield
        add_values(obj, name, values)
    obj[_KEY] = arrays.key


def observed_key(obj):
    """Return a text that is the same as long as what `keep_observed` kept is."""
    return obj.get(_KEY, "")


def observed_reader(obj):
    """Return a function that makes the `Observed` colors that are kept, or None; a thread may call it: it needs no bpy.

    Raises
    ------
    ScanError
        If the mesh has lost the attributes that tie its vertices to the scan's grid.
    """
    place, shape = grid_indices(obj), (obj.reflcolor.rows, obj.reflcolor.cols)
    try:
        packed, weights, photos = (
            values_of(obj, name, dtype) for name, dtype in ((_RGB, np.int32), (_WEIGHT, np.float32), (_PHOTO, np.int32))
        )
    except ScanError:
        return lambda: None

    def read():
        photo = on_grid(photos.astype(np.int16), place, shape, empty=-1)
        return Observed(on_grid(unpacked_rgb(packed), place, shape), on_grid(weights, place, shape), photo)

    return read


def keep_cameras(obj, matches, images=None):
    """Keep how an object's scan falls into each photo that was recognized.

    Parameters
    ----------
    obj : bpy.types.Object
    matches : sequence of PhotoMatch
    images : dict of str to bpy.types.Image or None, optional
        The photos' images, by the names in ``matches``; not given where the file has none.
    """
    models = [(match.name, match.model) for match in matches]
    found = [None if model is None else {"name": name, "model": model_document(model)} for name, model in models]
    obj[_CAMERAS] = json.dumps(found)
    names = () if images is None else [match.name for match in matches]
    obj[_PHOTOS] = {str(number): images.get(name) for number, name in enumerate(names)}


class Cameras(NamedTuple):
    """The cameras of the photos that observed colors come from, while a job runs; holds no data of Blender."""

    models: str
    """JSON, as on the object."""
    images: dict
    """The ``session_uid`` of each photo's image, None where it is gone, by the photo's place in the list as text."""


def observed_cameras(obj):
    """Return the `Cameras` that go with the observed colors that are kept now."""
    images = obj[_PHOTOS].to_dict() if _PHOTOS in obj else {}
    return Cameras(
        obj.get(_CAMERAS, "[]"),
        {number: None if image is None else image.session_uid for number, image in images.items()},
    )


def use_cameras(obj, cameras):
    """Keep cameras with the colors: an object was colorized, and its attribute ``photo`` counts these photos."""
    images = {image.session_uid: image for image in bpy.data.images}
    obj[_USED] = cameras.models
    obj[_USED_PHOTOS] = {number: images.get(uid) for number, uid in cameras.images.items()}


def cameras_of(obj):
    """Return (name, model) of each photo that ``photo`` counts, None for one that was not recognized; else nothing."""
    try:
        # Files of earlier versions have only the cameras that were last found.
        kept = json.loads(obj.get(_USED, obj.get(_CAMERAS, "[]")))
        return [None if each is None else (each["name"], model_of(each["model"])) for each in kept]
    except (ValueError, TypeError, KeyError, AttributeError):
        return []


def camera_image(obj, number):
    """Return the image of the photo that ``photo`` counts with a number; None where it is gone or was not recognized.

    Where the file had no image when the photo was recognized, one that was loaded since goes by its name.
    """
    cameras, photos = cameras_of(obj), obj.get(_USED_PHOTOS)
    if not 0 <= number < len(cameras) or cameras[number] is None:
        return None
    known = photos.to_dict() if hasattr(photos, "to_dict") else {}
    return known[str(number)] if str(number) in known else bpy.data.images.get(cameras[number][0])
