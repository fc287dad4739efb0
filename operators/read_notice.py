"""Read a message of the list in full."""

import bpy

from .scene.paragraphs import POPUP_WIDTH, draw_paragraph
from .show_notice import NoticeChoice


class REFLCOLOR_OT_read_notice(NoticeChoice, bpy.types.Operator):
    """Show the whole message, to read and to copy"""

    bl_idname = "reflcolor.read_notice"
    bl_label = "Read Message"
    bl_options = {"REGISTER"}

    def invoke(self, context, _event):
        return context.window_manager.invoke_popup(self, width=POPUP_WIDTH)

    def execute(self, context):
        self.report({"INFO"}, self.notice(context).text)
        return {"FINISHED"}

    def draw(self, context):
        notice = self.notice(context)
        draw_paragraph(self.layout, notice.text, "ERROR" if notice.warning else "INFO")
        row = self.layout.row()
        row.operator("reflcolor.copy_notice", icon="COPYDOWN").index = self.index
        if notice.row >= 0:
            row.operator("reflcolor.show_notice", text="Show Seed", icon="RESTRICT_SELECT_OFF").index = self.index


classes = (REFLCOLOR_OT_read_notice,)
