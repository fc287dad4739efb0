"""Color for laser scans that have none: geodesic colorization of a structured scan from a few seeds.

The method is that of Oishi, Kurazume, Iwashita and Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
Reflectivity" (ICRA 2013). Everything here works on plain NumPy arrays and needs no Blender.
"""

from .colorization import Colorization
from .colorize import colorize
from .colorizer import Colorizer
from .errors import Cancelled, ImageError, OutputError, ReflcolorError, ScanError, SeedsError, SettingsError
from .evaluation import evaluate
from .geodesic import geodesic_distances
from .matching import draw_matches, match_photos, match_seeds
from .readers import read_scans
from .scan import Scan
from .seeds import Seeds
from .settings import Settings

__all__ = [
    "Cancelled",
    "Colorization",
    "Colorizer",
    "ImageError",
    "OutputError",
    "ReflcolorError",
    "Scan",
    "ScanError",
    "Seeds",
    "SeedsError",
    "Settings",
    "SettingsError",
    "colorize",
    "draw_matches",
    "evaluate",
    "geodesic_distances",
    "match_photos",
    "match_seeds",
    "read_scans",
]
