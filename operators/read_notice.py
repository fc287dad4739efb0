"""Read a message of the list in full."""

import textwrap

import bpy

from .show_notice import NoticeChoice

_WIDTH, _LETTERS = 460, 66


class REFLCOLOR_OT_read_notice(NoticeChoice, bpy.types.Operator):
    """Show the whole message, to read and to copy"""

    bl_idname = "reflcolor.read_notice"
    bl_label = "Read Message"
    bl_options = {"REGISTER"}

    def invoke(self, context, _event):
        return context.window_manager.invoke_popup(self, width=_WIDTH)

    def execute(self, context):
        self.report({"INFO"}, self.notice(context).text)
        return {"FINISHED"}

    def draw(self, context):
        notice = self.notice(context)
        column = self.layout.column(align=True)
        for number, line in enumerate(textwrap.wrap(notice.text, _LETTERS)):
            icon = "BLANK1" if number else "ERROR" if notice.warning else "INFO"
            column.label(text=line, icon=icon, translate=False)
        row = self.layout.row()
        row.operator("reflcolor.copy_notice", icon="COPYDOWN").index = self.index
        if notice.row >= 0:
            row.operator("reflcolor.show_notice", text="Show Seed", icon="RESTRICT_SELECT_OFF").index = self.index


classes = (REFLCOLOR_OT_read_notice,)
