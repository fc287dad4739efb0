# What __init__.py gives lazily, for type checkers and editors; a test holds both against each other.
from .color.colorization import Colorization
from .color.colorizer import Colorizer, colorize
from .color.evaluation import evaluate
from .errors import Cancelled, ImageError, OutputError, ReflcolorError, ScanError, SeedsError, SettingsError
from .files.readers import read_scans
from .geodesic.distances import geodesic_distances
from .matching import draw_matches, match_photos, match_seeds
from .scan.scan import Scan
from .seeds.seeds import Seeds
from .settings import Settings
from .version import __version__

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
    "__version__",
    "colorize",
    "draw_matches",
    "evaluate",
    "geodesic_distances",
    "match_photos",
    "match_seeds",
    "read_scans",
]
