"""What a scan will cost, told by the size of its file before anything is read."""

from pathlib import Path

from ..paths import scan_files

# Bytes of a file for each pixel of its grid; a file of fewer returns holds fewer pixels that cost anything.
_BYTES_PER_PIXEL = {".ptx": 40.0, ".e57": 14.0}
_OTHERS = 4.0
# Of a worker: what it takes before there is a scan, and for each pixel and each photo's pixel, bytes.
_MEMORY, _MEMORY_PER_PIXEL = 350 << 20, 450
# Seconds of one processor for each scan, for each million of its pixels, and for each photo that it is matched with.
SECONDS, SECONDS_PER_MEGAPIXEL, SECONDS_PER_PAIR, SECONDS_PER_LOOK = 1.5, 8.0, 6.0, 0.25


def pixels_of(paths):
    """Return about how many pixels the scans in some files have, as far as their sizes tell."""
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
