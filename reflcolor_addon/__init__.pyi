# What __init__.py gives lazily, for type checkers and editors; a test holds both against each other.
from .color.colorization import Colorization
from .color.colorizer import Colorizer, colorize
from .color.evaluation import error_map, evaluate
from .color.observed import Observed
from .errors import Cancelled, ImageError, OutputError, ReflcolorError, ScanError, SeedsError, SettingsError, UsageError
from .files.readers import ReadOptions, read_scans
from .files.writers import write_e57, write_glb, write_image_pair, write_ply, write_ptx
from .geodesic.distances import geodesic_distances
from .matching import Matching, PhotoMatch, draw_matches, match_photos, match_seeds, match_site
from .scan.scan import Scan
from .scan.surface import ScanSurface
from .seeds.seeds import Seeds
from .settings import Settings
from .version import __version__

__all__ = [
    "Cancelled",
    "Colorization",
    "Colorizer",
    "ImageError",
    "Matching",
    "Observed",
    "OutputError",
    "PhotoMatch",
    "ReadOptions",
    "ReflcolorError",
    "Scan",
    "ScanError",
    "ScanSurface",
    "Seeds",
    "SeedsError",
    "Settings",
    "SettingsError",
    "UsageError",
    "__version__",
    "colorize",
    "draw_matches",
    "error_map",
    "evaluate",
    "geodesic_distances",
    "match_photos",
    "match_seeds",
    "match_site",
    "read_scans",
    "write_e57",
    "write_glb",
    "write_image_pair",
    "write_ply",
    "write_ptx",
]
