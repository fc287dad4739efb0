"""A colorization on its object: colors and how far to trust them, at every vertex and as an image."""

from dataclasses import dataclass

import numpy as np

from ...reflcolor_addon.scan.object_arrays import at_places
from .images import packed_pixels, write_packed
from .looks import refresh_look, show_look
from .scan_object import (
    COLORIZED,
    GUESSED,
    add_values,
    color_values,
    grid_indices,
    own_image,
    show_like_reflectance,
    write_colors,
)


@dataclass(frozen=True, eq=False)
class ColorizedArrays:
    """What is written onto an object, ready for Blender: N vertices.

    Parameters
    ----------
    place : ((N,) int32, (N,) int32)
        Rows and columns of the vertices.
    colors : (4 N,) float32
        As `color_values` gives them.
    values : dict of (N,) array
        By the attribute's name.
    """

    place: tuple[np.ndarray, np.ndarray]
    colors: np.ndarray
    values: dict[str, np.ndarray]

    @classmethod
    def of(cls, colorization, place):
        """Make them of a Colorization, for vertices on these pixels; a thread may call it: no bpy."""
        return cls(
            place=place,
            colors=color_values(at_places(colorization.rgb, place)),
            values={name: at_places(image, place) for name, image in colorization.values.items()},
        )


def show_colorization(obj, colorization, arrays=None, picture=None):
    """Write a Colorization onto its object, and show it in viewports, renders and exports.

    ``arrays`` are its ColorizedArrays, and ``picture`` is what `packed_pixels` gives of ``colorization.rgb``, where a
    thread has made them before.

    The attribute ``confidence`` is of 0 to 1, ``nearest_seed`` the index of a seed in ``colorization.seeds``, which is
    their order in the provenance, or -1 where none reaches. ``observed`` is 1 where a photo saw the color and 0 where
    it is inferred; ``photo`` is the index of that photo in the provenance, or -1. Vertices that were deleted since are
    left out.
    """
    place = grid_indices(obj)
    if arrays is None or not all(map(np.array_equal, arrays.place, place)):
        arrays = ColorizedArrays.of(colorization, place)
    write_colors(obj, COLORIZED, arrays.colors)
    for name, values in arrays.values.items():
        add_values(obj, name, values)
    # They are as large as the result.
    del arrays
    state = obj.reflcolor
    picture = picture or packed_pixels(colorization.rgb, obj.name)
    name = f"{obj.name} {COLORIZED}"
    state.colorized_image = write_packed(own_image(obj, "colorized_image"), name, picture, is_data=False)
    show_like_reflectance(obj, state.colorized_image)
    if colorization.seeds.all_guessed:
        obj[GUESSED] = True
    elif GUESSED in obj:
        del obj[GUESSED]
    refresh_look(obj)
    show_look(obj, "colorized")
