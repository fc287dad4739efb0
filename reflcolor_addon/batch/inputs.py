"""Which files a command works from, so that they are all hashed and none is overwritten."""

from pathlib import Path

from ..errors import ScanError
from ..files.readers.scan_json import load_description
from ..seeds.seeds import find_photo


def scan_files(path):
    """Return a scan's file and, where it only describes images, those.

    Parameters
    ----------
    path : Path

    Returns
    -------
    list of Path
    """
    if not path.name.lower().endswith(".scan.json"):
        return [path]
    try:
        description = load_description(path)
    except ScanError:
        # What is wrong with it is for its reader to say.
        return [path]
    names = (description.range, description.reflectance, description.color)
    return [path, *(path.parent / name for name in names if name is not None)]


def photo_files(seeds, seeds_path, photos):
    """Return the photos that were given, and those that the seeds name and that are there.

    Parameters
    ----------
    seeds : Seeds
    seeds_path : Path
        The file of seeds.
    photos : sequence of Path
        Photos that were given.

    Returns
    -------
    list of Path
        Each once.
    """
    named = (find_photo(name, seeds_path, photos) for name in seeds.photos if name is not None)
    return list(dict.fromkeys([*map(Path, photos), *(path for path in named if path is not None)]))
