"""The seeds of an object, to and from the core's Seeds."""

import bpy
import numpy as np
from bpy.props import IntProperty

from ...reflcolor_addon.errors import SeedsError
from ...reflcolor_addon.seeds.seeds import Seeds, nearest_valid
from .editors import select_only
from .quiet import point_to, write_quietly
from .scan_object import grid_indices
from .seed_arrays import FOUND_BY, seed_arrays
from .steps import complete

# Up to so many, a person has picked about one for each surface.
_FEW_SEEDS = 20
# So many are added to an object in one step.
_IN_A_STEP = 100


class SeedPlace:
    """A pixel of the scan, as properties of an operator."""

    row: IntProperty(name="Row", description="Row of the scan's grid, 0 at the top", min=0)
    col: IntProperty(name="Column", description="Column of the scan's grid, 0 at the left", min=0)

    def check_place(self, obj):
        """Raise SeedsError where the pixel is outside the object's grid."""
        rows, cols = obj.reflcolor.rows, obj.reflcolor.cols
        if self.row >= rows or self.col >= cols:
            raise SeedsError(
                "row {row}, column {col} is outside the scan's grid (rows 0 to {last_row}, columns 0 to {last_col})",
                row=self.row,
                col=self.col,
                last_row=rows - 1,
                last_col=cols - 1,
            )


class SeedChoice:
    """One of the seeds that are there, as a property of an operator."""

    index: IntProperty(name="Seed", description="Seed counted from 0, or -1 for the selected one", default=-1, min=-1)

    def chosen(self, obj):
        """Return the index of the chosen seed; raise SeedsError where there is none."""
        state = obj.reflcolor
        index = state.active_seed if self.index < 0 else self.index
        if not 0 <= index < len(state.seeds):
            raise SeedsError(
                "there is no seed {index}; the scan has seeds 0 to {last}", index=index, last=len(state.seeds) - 1
            )
        return index


def seeds_of(obj, *, wanted=lambda seeds: True):
    """Return the object's seeds that have a color as the core's Seeds.

    ``wanted`` is given the SeedArrays and returns (S,) bool, to leave out others.
    """
    seeds = seed_arrays(obj)
    chosen = np.flatnonzero(seeds.has_color & wanted(seeds))
    by_hand, named = seeds.by_hand[chosen], seeds.photo_names[chosen] != ""
    return Seeds(
        rows=seeds.rows[chosen].astype(np.int64),
        cols=seeds.cols[chosen].astype(np.int64),
        rgb=np.rint(seeds.colors[chosen] * 255).astype(np.uint8),
        photos=[name or None for name in seeds.photo_names[chosen].tolist()],
        photo_xy=np.where(named[:, None], seeds.photo_xy[chosen], np.nan),
        confidence=np.where(by_hand, np.nan, seeds.confidence[chosen]),
        reason=[
            None if hand else FOUND_BY[number] for hand, number in zip(by_hand, seeds.found_by[chosen], strict=True)
        ],
        locked=seeds.locked[chosen],
    )


def seeds_are_few_and_picked(obj):
    """Whether an object has seeds, a person picked all of them, and each is the only one of a whole surface."""
    seeds = [] if obj is None else obj.reflcolor.seeds
    return 0 < len(seeds) <= _FEW_SEEDS and all(seed.reason == "hand" for seed in seeds)


def append_seed(obj, row, col, rgb, photo=None, photo_xy=(0.0, 0.0)):
    """Add a seed to the object and select it, and no other; ``rgb`` is of 0..1."""
    seed = obj.reflcolor.seeds.add()
    write_quietly(seed, row=row, col=col, color=tuple(rgb), photo_xy=tuple(photo_xy))
    point_to(seed, photo=photo)
    choose_seed(obj, len(obj.reflcolor.seeds) - 1)
    return seed


def choose_seed(obj, index):
    """Make a seed the one that is chosen in the list, and select no other."""
    write_quietly(obj.reflcolor, active_seed=index)
    select_only(obj.reflcolor.seeds, [index])


def append_seeds(obj, seeds, images=None):
    """Add the core's Seeds to the object; photos are found by name in ``images`` or, by default, the .blend's."""
    complete(append_seeds_by_steps(obj, seeds, images))


def append_seeds_by_steps(obj, seeds, images=None):
    """As `append_seeds`, by steps."""
    images = bpy.data.images if images is None else images
    columns = (seeds.rows, seeds.cols, seeds.rgb / 255, np.nan_to_num(seeds.photo_xy), seeds.confidence, seeds.locked)
    columns = [*(column.tolist() for column in columns), seeds.photos, seeds.reason]
    for number, (row, col, rgb, xy, confidence, locked, photo, reason) in enumerate(zip(*columns, strict=True), 1):
        seed = obj.reflcolor.seeds.add()
        write_quietly(
            seed,
            row=row,
            col=col,
            color=rgb,
            photo_xy=xy,
            reason=FOUND_BY.index(reason or "hand"),
            confidence=1.0 if np.isnan(confidence) else confidence,
            locked=locked,
        )
        point_to(seed, photo=images.get(photo) if photo else None)
        if number % _IN_A_STEP == 0:
            yield
    choose_seed(obj, len(obj.reflcolor.seeds) - 1)


def remove_seeds(obj, indices):
    """Take seeds off the object; the next one becomes the selected one."""
    state = obj.reflcolor
    for index in sorted(indices, reverse=True):
        state.seeds.remove(index)
    choose_seed(obj, max(0, min([state.active_seed, len(state.seeds) - 1])))


def selected_seeds(obj):
    """Return the indices of the object's seeds that are selected."""
    return [index for index, seed in enumerate(obj.reflcolor.seeds) if seed.select]


def snapped_place(obj, row, col):
    """Return (row, col) of the pixel with a return that is nearest to a pixel of the object's grid."""
    rows, cols = grid_indices(obj)
    if ((rows == row) & (cols == col)).any():
        return row, col
    valid = np.zeros((obj.reflcolor.rows, obj.reflcolor.cols), bool)
    valid[rows, cols] = True
    if not valid.any():
        raise SeedsError("{name}: no pixel has a return, so no seed can be placed", name=obj.name)
    return nearest_valid(valid, row, col)


def place_seed(context, obj, row, col):
    """Add a seed in the picked color; without one it waits for its color, selected."""
    settings = context.scene.reflcolor
    if not settings.picked:
        color = settings.bl_rna.properties["picked_color"].default_array[:]
        write_quietly(append_seed(obj, row, col, color), has_color=False)
        return
    append_seed(obj, row, col, settings.picked_color, settings.picked_photo, settings.picked_xy)
    select_only(obj.reflcolor.seeds, [])
    # A point in a photo belongs to one place only; a color may be used for many.
    point_to(settings, picked_photo=None)
