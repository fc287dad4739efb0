"""What would come of two or three images, shown in the file browser before they are imported."""

import os
from pathlib import Path

from ...reflcolor_addon.errors import ReflcolorError
from ...reflcolor_addon.files.readers.pair_description import previewed
from .texts import shown

# The last preview: drawing asks for it again and again.
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
        pair = pair_of(images)
        preview = _previewed(pair)
    except (ReflcolorError, OSError) as error:
        column.label(
            text=shown(error.message) if isinstance(error, ReflcolorError) else str(error),
            icon="ERROR",
            translate=False,
        )
        return
    for line in preview.said:
        column.label(text=shown(line), translate=False)
    for line in preview.doubts:
        column.label(text=shown(line), icon="ERROR", translate=False)


def _previewed(pair):
    stamps = tuple((path, path.stat().st_mtime_ns) for path in pair.images)
    key = repr((stamps, pair))
    if key not in _made:
        _made.clear()
        _made[key] = previewed(pair)
    return _made[key]
