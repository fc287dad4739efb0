"""Files that a run reads and writes, known before the work begins, so that conflicts are found early."""

import glob
import os
from contextlib import contextmanager
from pathlib import Path

from ..errors import OutputError, ScanError, UsageError
from ..files.atomic import require_writable
from ..files.readers.scan_json import load_description
from ..seeds.seeds_file import find_photo
from .plan import PLACEHOLDER, filled


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
        # The reader reports what is wrong with it.
        return [path]
    return [path, *(path.parent / name for name in description.files)]


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


def files_of_each(path, name):
    """Return the files that a path means for the scans of one item of a batch, as far as they are there.

    Parameters
    ----------
    path : Path
        With the placeholder, or a file of its own.
    name : str
        The item's; several scans of it have labels that begin with it and a plus sign (see `read.read_jobs`).

    Returns
    -------
    list of Path
    """
    several = []
    if PLACEHOLDER in str(path):
        anchor = Path(path.anchor)
        pattern = glob.escape(str(path.relative_to(anchor))).replace(PLACEHOLDER, f"{glob.escape(name)}+*")
        several = sorted(anchor.glob(pattern))
    return [found for found in (filled(path, name), *several) if found.is_file()]


def output_faults(outputs, inputs):
    """Yield what is wrong with files to write: an error for each that would overwrite another, or cannot be written.

    Parameters
    ----------
    outputs : list of (str, Path)
        The option that names it, and the path.
    inputs : list of Path

    Yields
    ------
    UsageError
        Where two outputs, or an output and an input, are the same file.
    OutputError
        Where a file cannot be written.
    """
    for place, (option, path) in enumerate(outputs):
        if any(_same_file(path, other) for other in inputs):
            yield UsageError(
                "{option} {path}: is an input, and would be overwritten; choose another name", option=option, path=path
            )
        for other_option, other in outputs[:place]:
            if _same_file(path, other):
                yield UsageError(
                    "{option} {path}: the same file as {other_option} {other}; choose another name",
                    option=option,
                    path=path,
                    other_option=other_option,
                    other=other,
                )
    for _, path in outputs:
        try:
            require_writable(path)
        except OutputError as fault:
            yield fault


def check_outputs(outputs, inputs):
    """Raise the first of `output_faults`."""
    for fault in output_faults(outputs, inputs):
        raise fault


@contextmanager
def tracked(paths, written):
    """Add to the list ``written``, when the block ends well or not, every path that it wrote.

    A path counts as written when it is another file than before, as files that are written atomically are.
    """
    before = {path: _identity(path) for path in paths}
    try:
        yield
    finally:
        written.extend(path for path in paths if _identity(path) != before[path])


def _same_file(one, other):
    try:
        return one.samefile(other)
    except ValueError:  # a null character, which no file's name has
        return one == other
    except OSError:
        return os.path.normcase(os.path.realpath(one)) == os.path.normcase(os.path.realpath(other))


def _identity(path):
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_ino, found.st_mtime_ns
