"""Method 2: seeds from photos, found by the program."""

from .draw import draw_matches
from .match import Matching, PhotoMatch, match_photos, match_seeds, match_site
from .transfer.texture import LARGEST, Shot, colors_of_texture, grid_texture, shots_of, texture, texture_shape

__all__ = [
    "LARGEST",
    "Matching",
    "PhotoMatch",
    "Shot",
    "colors_of_texture",
    "draw_matches",
    "grid_texture",
    "match_photos",
    "match_seeds",
    "match_site",
    "shots_of",
    "texture",
    "texture_shape",
]
