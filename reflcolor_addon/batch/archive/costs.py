"""Estimates what the scans of a batch cost, from the sizes that the headers of its files tell."""

from dataclasses import dataclass, field
from pathlib import Path

from ..memory import bytes_of_pixels
from ..paths import scan_files

# Bytes of a file for each pixel of its grid, where its header was not read. Pixels without a return cost nothing, and
# files with fewer returns are smaller.
_BYTES_PER_PIXEL = {".ptx": 40.0, ".e57": 14.0}
_OTHERS = 4.0
# Bytes that a worker needs before there is a scan, and for each pixel of the scan while it is colorized and written.
_MEMORY, _MEMORY_PER_PIXEL = 350 << 20, 450
# Seconds of one processor for each scan, each million of its pixels, and each photo that it is matched with; for each
# photo that is looked at, and looked at again; for each other scan that a photo was found to show; for each two
# photos that are compared; and for each picture that is rendered.
SECONDS, SECONDS_PER_MEGAPIXEL, SECONDS_PER_PAIR = 1.5, 8.0, 10.0
SECONDS_PER_LOOK, SECONDS_PER_SECOND_LOOK, SECONDS_PER_LOOK_OF_SCANS = 0.25, 0.25, 0.1
SECONDS_PER_COMPARISON, SECONDS_TO_RENDER = 0.01, 8.0


@dataclass(frozen=True, kw_only=True)
class Costs:
    """What the files of a batch cost.

    Parameters
    ----------
    scans, photos : dict of Path to int
        Pixels of the files whose headers were read, of all scans of a file together.
    unusable : dict of Path to str
        Why files cannot be used, as far as their headers show it.
    """

    scans: dict[Path, int] = field(default_factory=dict)
    photos: dict[Path, int] = field(default_factory=dict)
    unusable: dict[Path, str] = field(default_factory=dict)

    def pixels(self, scans):
        """Return how many pixels the scans in some files have."""
        return sum(self.scans[path] if path in self.scans else _pixels(path) for path in scans)

    def memory(self, scans, photos=()):
        """Return how many bytes a worker takes for the scans in some files, matched with some photos."""
        pixels, sizes = self.pixels(scans), [self.photos.get(Path(path), 0) for path in photos]
        matching = bytes_of_pixels(pixels, sizes) if sizes else 0
        return int(_MEMORY + max(_MEMORY_PER_PIXEL * pixels, matching))

    def seconds(self, scans, photos):
        """Return about how many seconds of a processor it takes to colorize scans, matched with so many photos."""
        return SECONDS + SECONDS_PER_MEGAPIXEL * self.pixels(scans) / 1e6 + SECONDS_PER_PAIR * photos


def _pixels(path):
    """Estimated from the size of a file."""
    per_pixel = _BYTES_PER_PIXEL.get(Path(path).suffix.lower(), _OTHERS)
    size = 0
    for part in scan_files(Path(path)):
        try:
            size += part.stat().st_size
        except OSError:
            continue
    return size / per_pixel
