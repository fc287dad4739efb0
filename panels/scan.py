"""Step 1: the scan."""

from ..operators.scene import packages
from ..operators.scene.scan_object import GUESSED, is_joined
from ..operators.scene.texts import label
from .step import Step, draw_act, in_view


class Scan(Step):
    """Import a scan, and what it is"""

    bl_label = "1. Scan"

    def draw_step(self, context, layout, obj):
        if missing := packages.missing():
            column = layout.column(align=True)
            column.alert = True
            column.label(text=label("{names} missing", names=", ".join(missing)), icon="ERROR", translate=False)
            column.operator("reflcolor.repair", icon="FILE_REFRESH")
        draw_act(layout, "reflcolor.import_scan", "Import Laser Scan", icon="IMPORT")
        if obj is None:
            layout.label(text="Import a scan, or select one", icon="INFO")
            layout.operator("reflcolor.open_example", icon="FILE_3D")
            return
        column = layout.column(align=True)
        column.label(text=obj.name, icon="MESH_GRID", translate=False)
        rows, cols, returns = obj.reflcolor.rows, obj.reflcolor.cols, len(obj.data.vertices)
        said = label("{cols} x {rows} pixels, {returns} returns", rows=rows, cols=cols, returns=returns)
        column.label(text=said, translate=False)
        if is_joined(obj):
            column.label(text="Another mesh was joined to it", icon="ERROR")
            column.label(text="Renders keep each one's colors", icon="BLANK1")
        if obj.get(GUESSED):
            row = column.row()
            row.alert = True
            row.label(text="Its colors are guesses", icon="ERROR")
        if context.space_data.local_view is not None:
            layout.operator("view3d.localview", text="Show Other Objects", icon="HIDE_OFF")


classes = (in_view(Scan),)
