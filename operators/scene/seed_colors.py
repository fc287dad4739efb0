"""Giving seeds their colors."""

from .quiet import point_to, write_quietly
from .seed_arrays import FOUND_BY


def give_color(seed, color, photo, photo_xy):
    """Color a seed by a person's choice, with the point of the photo that it is from if there is one."""
    write_quietly(seed, color=tuple(color), photo_xy=tuple(photo_xy), has_color=True)
    write_quietly(seed, reason=FOUND_BY.index("hand"), confidence=1.0)
    point_to(seed, photo=photo)


def give_waiting(seeds, color, last):
    """Give a color to the selected seeds that have none yet.

    Those that have just been given ``last`` follow: a color wheel that is turned gives many colors, one after another.
    """
    for seed in seeds:
        by_hand = seed.select and seed.reason == "hand" and seed.photo is None
        if by_hand and (not seed.has_color or tuple(seed.color) == tuple(last)):
            give_color(seed, color, None, (0.0, 0.0))


def hold_color(settings, color, photo=None, photo_xy=(0.0, 0.0)):
    """Give a color to the tool, for the seeds that are placed next; those that are there keep theirs."""
    write_quietly(settings, picked_color=tuple(color), last_picked_color=tuple(color), picked=True)
    write_quietly(settings, picked_xy=tuple(photo_xy))
    point_to(settings, picked_photo=photo)
