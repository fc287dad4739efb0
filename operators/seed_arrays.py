"""The seeds of an object as arrays, read in bulk: quick enough to be read whenever an editor is drawn."""

from dataclasses import dataclass

import numpy as np


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
    selected, locked, has_color, by_hand : (S,) bool
    confidence : (S,) float32
    active : int
        Index of the one that is chosen in the list.
    """

    rows: np.ndarray
    cols: np.ndarray
    colors: np.ndarray
    photo_xy: np.ndarray
    photo_names: np.ndarray
    selected: np.ndarray
    locked: np.ndarray
    has_color: np.ndarray
    by_hand: np.ndarray
    confidence: np.ndarray
    active: int

    def key(self):
        """Return a value that is the same as long as nothing of this has changed."""
        arrays = (array for array in vars(self).values() if isinstance(array, np.ndarray))
        return hash((self.active, *(array.tobytes() for array in arrays)))


def seed_arrays(obj):
    """Return the object's seeds as SeedArrays."""
    seeds = obj.reflcolor.seeds

    def column(name, dtype, size=1):
        values = np.empty(len(seeds) * size, dtype)
        seeds.foreach_get(name, values)
        return values if size == 1 else values.reshape(-1, size)

    return SeedArrays(
        rows=column("row", np.int32),
        cols=column("col", np.int32),
        colors=column("color", np.float32, 3),
        photo_xy=column("photo_xy", np.float32, 2),
        photo_names=np.array([seed.photo.name if seed.photo else "" for seed in seeds], str),
        selected=column("select", bool),
        locked=column("locked", bool),
        has_color=column("has_color", bool),
        # The first choice of the property; the others are ways of finding seeds in photos.
        by_hand=column("reason", np.int32) == 0,
        confidence=column("confidence", np.float32),
        active=obj.reflcolor.active_seed,
    )
