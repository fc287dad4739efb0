"""What would come of images picked together, shown in the file browser before they are imported."""

import os
import textwrap
from pathlib import Path

from ...reflcolor_addon.errors import ReflcolorError
from ...reflcolor_addon.files.readers.pair_description import pair_and_photos, previewed
from .texts import report_text, shown

_LETTERS = 34
# The last preview: every redraw needs it again.
_made = {}


def picked_files(context):
    """Return the paths that are selected in the file browser."""
    space = context.space_data
    if space is None or space.type != "FILE_BROWSER" or space.params is None:
        return []
    folder = Path(os.fsdecode(space.params.directory))
    return [folder / entry.name for entry in getattr(context, "selected_files", None) or ()]


def draw_preview(layout, images, pair_of):
    """Draw which image is which, the size of the scene, and what makes no sense.

    Parameters
    ----------
    layout : bpy.types.UILayout
    images : list of Path
    pair_of : callable
        Makes a `Pair` of the images; may raise ReflcolorError, as `previewed` does.
    """
    column = layout.column(align=True)
    column.label(text="Image Pair", icon="IMAGE_DATA")
    try:
        preview, photos = _previewed(images, pair_of)
    except (ReflcolorError, OSError) as error:
        _draw(column, shown(error.message) if isinstance(error, ReflcolorError) else str(error), "ERROR")
        return
    for line in preview.said:
        _draw(column, shown(line))
    for photo in photos:
        _draw(column, report_text("photo: {image}", image=photo.name))
    for line in preview.doubts:
        _draw(column, shown(line), "ERROR")


def _draw(column, text, icon="NONE"):
    """A text in as many lines as the side of a file browser needs; Blender would leave out the middle."""
    for number, line in enumerate(textwrap.wrap(text, _LETTERS)):
        column.label(text=line, icon=icon if number == 0 else "NONE" if icon == "NONE" else "BLANK1", translate=False)


def _previewed(images, pair_of):
    """The preview of the pair among images, and the photos among them."""
    stamps = tuple((path, path.stat().st_mtime_ns) for path in images)
    key = repr((stamps, pair_of(images)))
    if key not in _made:
        _made.clear()
        pair, photos = pair_and_photos(images)
        _made[key] = previewed(pair_of(pair)), photos
    return _made[key]
