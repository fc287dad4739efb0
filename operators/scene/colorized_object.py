"""A colorization on its object: colors and how far to trust them, at every vertex and as an image."""

from .images import packed_pixels, write_packed
from .looks import refresh_look, show_look
from .scan_object import (
    COLORIZED,
    GUESSED,
    add_colors,
    add_values,
    grid_indices,
    own_image,
    show_like_reflectance,
)
from .steps import completed


def showing_colorization(obj, colorization, picture):
    """Write a Colorization onto its object, and show it in viewports, renders and exports.

    A generator: it yields between its steps. ``picture`` is what `packed_pixels` gives of ``colorization.rgb``.

    The attribute ``confidence`` is of 0 to 1, ``nearest_seed`` the index of a seed in ``colorization.seeds``, which is
    their order in the provenance, or -1 where none reaches. ``observed`` is 1 where a photo saw the color and 0 where
    it is inferred; ``photo`` is the index of that photo in the provenance, or -1. Vertices that were deleted since are
    left out.
    """
    place = grid_indices(obj)
    add_colors(obj, COLORIZED, colorization.rgb[place])
    yield
    for name, values in colorization.values.items():
        add_values(obj, name, values[place])
    yield
    state = obj.reflcolor
    name = f"{obj.name} {COLORIZED}"
    state.colorized_image = write_packed(own_image(obj, "colorized_image"), name, picture, is_data=False)
    show_like_reflectance(obj, state.colorized_image)
    if colorization.seeds.all_guessed:
        obj[GUESSED] = True
    elif GUESSED in obj:
        del obj[GUESSED]
    refresh_look(obj)
    show_look(obj, "colorized")


def show_colorization(obj, colorization):
    """Write a Colorization onto its object and show it, at once; see `showing_colorization`."""
    completed(showing_colorization(obj, colorization, packed_pixels(colorization.rgb, obj.name)))
