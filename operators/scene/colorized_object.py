"""A colorization on its object: colors and how far to trust them, at every vertex and as an image."""

from .images import packed_pixels, write_packed
from .looks import refresh_look, show_look
from .scan_object import (
    COLORIZED,
    GUESSED,
    add_colors,
    add_values,
    at_vertices,
    own_image,
    show_like_reflectance,
)


def show_colorization(obj, colorization, picture=None):
    """Write a Colorization onto its object, and show it in viewports, renders and exports.

    ``picture`` is what `packed_pixels` gives of ``colorization.rgb``, where a thread has made it before.

    The attribute ``confidence`` is of 0 to 1, ``nearest_seed`` the index of a seed in ``colorization.seeds``, which is
    their order in the provenance, or -1 where none reaches. ``observed`` is 1 where a photo saw the color and 0 where
    it is inferred; ``photo`` is the index of that photo in the provenance, or -1. Vertices that were deleted since are
    left out.
    """
    rgb, *others = at_vertices(obj, colorization.rgb, *colorization.values.values())
    add_colors(obj, COLORIZED, rgb)
    for name, values in zip(colorization.values, others, strict=True):
        add_values(obj, name, values)
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
