"""Before and after, in the Image Editor's sidebar."""

import bpy

from ..operators.overlays.wipe import overlay_image
from ..operators.scene.editor_images import scan_of_image
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


def draw_in_header(self, context):
    """The switch in the Image Editor's own header, while it shows an image of a scan that has colors."""
    image = context.space_data.image
    obj = None if image is None else scan_of_image(image, context)
    if obj is not None and overlay_image(obj) is not None:
        self.layout.prop(context.window_manager.reflcolor_wipe, "show", toggle=True, icon="ARROW_LEFTRIGHT")


classes = (in_images(Compare),)
menus = ((bpy.types.IMAGE_HT_header, draw_in_header),)
