"""Step 1: the scan."""

from .step import Step, in_view


class Scan(Step):
    """Import a scan, and what it is"""

    bl_label = "1. Scan"

    def draw_step(self, context, layout, obj):
        layout.operator("reflcolor.import_scan", icon="IMPORT")
        if obj is None:
            layout.label(text="Import a scan, or select one", icon="INFO")
            return
        column = layout.column(align=True)
        column.label(text=obj.name, icon="MESH_GRID", translate=False)
        column.label(text=f"{obj.reflcolor.rows} x {obj.reflcolor.cols} pixels, {len(obj.data.vertices)} returns")


classes = (in_view(Scan),)
