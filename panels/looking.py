"""What the viewport shows of a scan."""

from ..operators.scene.looks import LOOKS, shown_look, why_not
from ..operators.scene.texts import label
from .step import Step, in_view


class Looking(Step):
    """Choose what the viewport shows of the scan"""

    bl_label = "Show Scan As"

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        shown = shown_look(obj)
        column = layout.column(align=True)
        for identifier, look in LOOKS.items():
            reason = why_not(obj, identifier)
            row = column.row(align=True)
            row.enabled = reason is None
            text = f"{label(look.title)}: {label(reason)}" if reason else label(look.title)
            row.operator(
                "reflcolor.show_look", text=text, icon=look.icon, depress=identifier == shown, translate=False
            ).look = identifier
        shading = context.space_data.shading
        if shading.type != "SOLID":
            layout.label(text="Maps show in Solid shading", icon="INFO")
        elif shown and shown != "gray":
            # Under studio light a color is not quite the legend's, or that of a picture.
            layout.row().prop(shading, "light", expand=True)


classes = (in_view(Looking),)
