"""Color for laser scans that have none: geodesic colorization of a structured scan from a few seeds.

The method is that of Oishi, Kurazume, Iwashita and Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
Reflectivity" (ICRA 2013). Everything here works on plain NumPy arrays and needs no Blender.
"""

from importlib import import_module

_MODULES = {
    "color.colorization": ("Colorization",),
    "color.colorizer": ("Colorizer", "colorize"),
    "color.evaluation": ("error_map", "evaluate"),
    "color.observed": ("Observed",),
    "errors": (
        "Cancelled",
        "ImageError",
        "OutputError",
        "ReflcolorError",
        "ScanError",
        "SeedsError",
        "SettingsError",
        "UsageError",
    ),
    "files.readers": ("ReadOptions", "read_scans"),
    "files.writers": ("write_e57", "write_glb", "write_image_pair", "write_ply", "write_ptx"),
    "geodesic.distances": ("geodesic_distances",),
    "matching": ("Matching", "PhotoMatch", "draw_matches", "match_photos", "match_seeds", "match_site"),
    "scan.scan": ("Scan",),
    "scan.surface": ("ScanSurface",),
    "seeds.seeds": ("Seeds",),
    "settings": ("Settings",),
    "version": ("__version__",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}
__all__ = list(_HOMES)


def __getattr__(name):
    """Import what is asked for when it is first asked for: the command line answers a signal before NumPy is there."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
