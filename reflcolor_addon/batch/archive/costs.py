"""Estimates the cost of a scan from the size of its file, before anything is read."""

from pathlib import Path

from ..paths import scan_files

# Bytes of a file for each pixel of its grid. Pixels without a return cost nothing, and files with fewer returns are
# smaller.
_BYTES_PER_PIXEL = {".ptx": 40.0, ".e57": 14.0}
_OTHERS = 4.0
# Bytes that a worker needs before there is a scan, for each pixel of the scan, and for each pixel of a photo.
_MEMORY, _MEMORY_PER_PIXEL = 350 << 20, 450
# Seconds of one processor for each scan, each million of its pixels, and each photo that it is matched with.
SECONDS, SECONDS_PER_MEGAPIXEL, SECONDS_PER_PAIR, SECONDS_PER_LOOK = 1.5, 8.0, 10.0, 0.25


def pixels_of(paths):
    """Return about how many pixels the scans in some files have, estimated from their sizes."""
    return sum(_pixels(path) for path in paths)


def memory_of(paths):
    """Return how many bytes a worker takes for the scans in some files."""
    return int(_MEMORY + _MEMORY_PER_PIXEL * pixels_of(paths))


def seconds_of(paths, photos):
    """Return about how many seconds of a processor it takes to colorize scans, matched with so many photos."""
    return SECONDS + SECONDS_PER_MEGAPIXEL * pixels_of(paths) / 1e6 + SECONDS_PER_PAIR * photos


def _pixels(path):
    per_pixel = _BYTES_PER_PIXEL.get(Path(path).suffix.lower(), _OTHERS)
    size = 0
    for part in scan_files(Path(path)):
        try:
            size += part.stat().st_size
        except OSError:
            continue
    return size / per_pixel
