"""Before and after, in the Image Editor's sidebar."""

from ..operators.overlays.wipe import overlay_image
from .step import Step, in_images


class Compare(Step):
    """Lay the colors over the scan's image, up to a line"""

    bl_label = "Before and After"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.window_manager.reflcolor_wipe, "show", text="")

    def draw_step(self, context, layout, obj):
        wipe = context.window_manager.reflcolor_wipe
        if obj is None or overlay_image(obj) is None:
            layout.label(text="Colorize first", icon="INFO")
        row = layout.row()
        row.active = wipe.show
        row.prop(wipe, "position", slider=True)


classes = (in_images(Compare),)
