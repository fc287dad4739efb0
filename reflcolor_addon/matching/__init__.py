"""Method 2: seeds from photos, found by the program."""

from .draw import draw_matches
from .match import Matching, PhotoMatch, match_photos, match_seeds, match_site

__all__ = ["Matching", "PhotoMatch", "draw_matches", "match_photos", "match_seeds", "match_site"]
