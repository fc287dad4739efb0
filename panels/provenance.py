"""Where the colors of a scan are from: what is evidence, and what is inference."""

from functools import lru_cache
from pathlib import PurePath

from ..operators.scene.provenance import provenance_text
from ..operators.scene.scan_object import COLORIZED
from ..operators.scene.texts import label, shown
from ..reflcolor_addon.errors import ReflcolorError
from ..reflcolor_addon.report.provenance import outline, parse_provenance
from ..reflcolor_addon.seeds.sources import EVIDENCE
from .step import Step, in_view

_ICONS = {"scan": "MESH_GRID", "seeds": "FILE_TEXT", "photo": "IMAGE_DATA"}
_INPUTS_SHOWN = 6
_HASH_DIGITS = 12


class Provenance(Step):
    """Where the colors are from, for those who look at them later"""

    bl_label = "Provenance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        text = provenance_text(obj)
        if text is None:
            colorized = COLORIZED in obj.data.color_attributes
            layout.label(text="Colors of unknown origin" if colorized else "Colorize first", icon="INFO")
            return
        found, problem = _outline(text)
        if found is None:
            layout.label(text=problem, icon="ERROR", translate=False)
            return
        _draw(layout, found)
        layout.operator("reflcolor.copy_provenance", icon="COPYDOWN")


def _draw(layout, found):
    column = layout.column(align=True)
    if found.guessed:
        column.label(text="None: all colors are guesses", icon="ERROR")
    else:
        column.label(text="Evidence", icon="CHECKMARK")
    for source, count in found.sources.items():
        column.label(text=label(EVIDENCE[source].counted, count=count), icon="BLANK1", translate=False)
    for photo, count in found.observed:
        seen = label("{count} pixels as {photo} shows them", count=count, photo=photo)
        column.label(text=seen, icon="BLANK1", translate=False)
    column = layout.column(align=True)
    column.label(text="Inference", icon="OUTLINER_DATA_LIGHTPROBE")
    column.label(text=label("{count} pixels colored from them", count=found.inferred), icon="BLANK1", translate=False)
    if found.unreached:
        column.label(text=label("{count} pixels left gray", count=found.unreached), icon="BLANK1", translate=False)
    column = layout.column(align=True)
    column.label(text="Inputs (SHA-256)", icon="FILE")
    for role, path, sha256 in found.inputs[:_INPUTS_SHOWN]:
        split = column.split(factor=0.6)
        split.label(text=PurePath(path).name, icon=_ICONS.get(role, "FILE"), translate=False)
        split.label(text=sha256[:_HASH_DIGITS] if sha256 else label("not kept"), translate=False)
    if len(found.inputs) > _INPUTS_SHOWN:
        more = label("and {count} more", count=len(found.inputs) - _INPUTS_SHOWN)
        column.label(text=more, icon="BLANK1", translate=False)
    column = layout.column(align=True)
    column.label(text=found.created.replace("T", " ").replace("Z", " UTC"), icon="TIME", translate=False)
    made_by = {"reflcolor": "Reflectance Colorizer", "blender": "Blender"}
    versions = ", ".join(f"{made_by[name]} {version}" for name, version in found.versions.items())
    column.label(text=versions, icon="BLENDER", translate=False)


@lru_cache(maxsize=8)
def _outline(text):
    """The outline of a report, and what is wrong with it if there is none; a panel asks at every redraw."""
    try:
        return outline(parse_provenance(text)), None
    except ReflcolorError as error:
        return None, shown(error.message)


classes = (in_view(Provenance),)
