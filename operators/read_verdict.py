"""Read in full what was found of a photo."""

import bpy

from .scene import polls
from .scene.paragraphs import POPUP_WIDTH, draw_paragraph
from .scene.photo_list import active_image
from .scene.texts import tip
from .scene.verdicts import verdict_of


class REFLCOLOR_OT_read_verdict(bpy.types.Operator):
    """Show what was found when the selected photo was matched with this scan"""

    bl_idname = "reflcolor.read_verdict"
    bl_label = "Read Verdict"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        missing = tip("Match the photo first") if _verdict(context) is None else None
        return polls.has_scan(cls, context) and polls.nothing_missing(cls, missing)

    def invoke(self, context, _event):
        return context.window_manager.invoke_popup(self, width=POPUP_WIDTH)

    def execute(self, context):
        self.report({"INFO"}, _verdict(context).note)
        return {"FINISHED"}

    def draw(self, context):
        verdict = _verdict(context)
        if verdict is not None:
            text = f"{verdict.image.name}: {verdict.note}"
            draw_paragraph(self.layout, text, "CHECKMARK" if verdict.verified else "ERROR")


def _verdict(context):
    return verdict_of(polls.scan_object(context), active_image(context.scene))


classes = (REFLCOLOR_OT_read_verdict,)
