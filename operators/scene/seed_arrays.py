"""The seeds of an object as arrays, read in bulk: quick enough to be read whenever an editor is drawn."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...reflcolor_addon.seeds.sources import SOURCES

# The choices of a seed's ``reason``, by their numbers.
FOUND_BY = tuple(SOURCES)

# Object -> (the bulk arrays and the names of all images, which show changes; the names of the seeds' photos).
_photo_names = {}


@dataclass(frozen=True, eq=False)
class SeedArrays:
    """What is drawn of the seeds of an object: S seeds, in their order.

    Parameters
    ----------
    rows, cols : (S,) int32
    colors : (S, 3) float32 of 0..1
    photo_xy : (S, 2) float32
    photo_names : (S,) str
        Empty where a color is from no photo.
    selected, locked, has_color : (S,) bool
    found_by : (S,) int32
        Numbers of ``FOUND_BY``.
    confidence : (S,) float32
    active : int
        Index of the one that is chosen in the list.
    key : int
        The same as long as nothing of this has changed.
    """

    rows: np.ndarray
    cols: np.ndarray
    colors: np.ndarray
    photo_xy: np.ndarray
    photo_names: np.ndarray
    selected: np.ndarray
    locked: np.ndarray
    has_color: np.ndarray
    found_by: np.ndarray
    confidence: np.ndarray
    active: int
    key: int

    @property
    def by_hand(self):
        """(S,) bool: which were picked by a person."""
        return self.found_by == FOUND_BY.index("hand")


def seed_arrays(obj):
    """Return the object's seeds as SeedArrays."""
    seeds, active = obj.reflcolor.seeds, obj.reflcolor.active_seed

    def column(name, dtype, size=1):
        values = np.empty(len(seeds) * size, dtype)
        seeds.foreach_get(name, values)
        return values if size == 1 else values.reshape(-1, size)

    columns = {
        "rows": column("row", np.int32),
        "cols": column("col", np.int32),
        "colors": column("color", np.float32, 3),
        "photo_xy": column("photo_xy", np.float32, 2),
        "selected": column("select", bool),
        "locked": column("locked", bool),
        "has_color": column("has_color", bool),
        "found_by": column("reason", np.int32),
        "confidence": column("confidence", np.float32),
    }
    key = hash((active, *(values.tobytes() for values in columns.values())))
    named = _photo_names.get(obj.name)
    # Photos may be renamed, even to each other's names.
    images = tuple((image.name, image.session_uid) for image in bpy.data.images)
    state = key, hash(images), len(bpy.data.objects)
    if named is None or named[0] != state:
        named = _photo_names[obj.name] = state, np.array([seed.photo.name if seed.photo else "" for seed in seeds], str)
    return SeedArrays(**columns, photo_names=named[1], active=active, key=key)
