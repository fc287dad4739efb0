"""Looks at the scans and photos of a batch before the work begins: at the headers of all, and at whole photos."""

from functools import partial

from ...errors import ReflcolorError, UsageError
from ...files.images import check_image, image_size
from ...files.readers import scan_pixels
from ...files.readers.options import BY_ANGLE, LIGHTER
from ...messages import Message, value_of
from .costs import Costs
from .passing import may_pass

_WAYS = {BY_ANGLE: 'reading = { grid = "angle" }', LIGHTER: "reading = { step = 2 }"}
"""What a manifest has for the ways out that errors of readers name."""


def check_files(manifest, items, refuse, *, decode, progress):
    """Look at every scan and photo of some items.

    Parameters
    ----------
    manifest : Manifest
    items : list of Item
    refuse : callable
        Given a UsageError for each file that cannot be used, with the line that names it.
    decode : bool
        Whether photos are decoded, too, which finds the damaged ones and takes longer.
    progress : callable
        Called as ``progress(fraction, text)``; may raise Cancelled.

    Returns
    -------
    Costs
        By the sizes found, with what is wrong with the files that cannot be used.
    """
    scans = {path: item for item in items for path in item.plan.scans}
    photos = {path: manifest.photo_lines[path] for item in items for path in item.plan.photos}
    found, count, done = Costs(), len(scans) + len(photos), 0

    def look(path, line, act):
        nonlocal done
        name = manifest.name_of(path)
        progress(done / count, Message("Checking {name}", name=name))
        done += 1
        try:
            return act()
        except (ReflcolorError, UsageError) as error:
            problem = _with_way(_naming(error.message, path, name))
            if not may_pass(error):
                found.unusable[path] = problem
            refuse(UsageError("{file}: line {line}: {problem}", file=manifest.path, line=line, problem=problem))
            return None

    for path, item in scans.items():
        pixels = look(path, item.line, partial(_pixels_of, path, item))
        if pixels is not None:
            found.scans[path] = sum(pixels)
    for path, line in photos.items():
        size = look(path, line, partial(check_image if decode else image_size, path))
        if size is not None:
            found.photos[path] = size[0] * size[1]
    return found


def _pixels_of(path, item):
    """The pixels of the scans of a file, of which the manifest may choose one by its number."""
    pixels = scan_pixels(path, options=item.plan.reading, outside=item.plan.outside_files)
    if item.number is not None and item.number > len(pixels):
        held = Message("1 scan") if len(pixels) == 1 else Message("{count} scans", count=len(pixels))
        raise UsageError(
            "{file}: holds {held}, so scan {number} is none", file=path.name, held=held, number=item.number
        )
    return pixels


def _with_way(message):
    """A message that names a way out on the command line, with what a manifest has for it."""
    way = _WAYS.get(value_of(message, "way"))
    return Message("{problem}; in the manifest: {way}", problem=message, way=way) if way else message


def _naming(message, path, name):
    """A message about a file, with the folders before its name: an archive has many files of one name."""
    if message.values.get("file") != path.name:
        return message
    return Message(message.template, **message.values | {"file": name})
