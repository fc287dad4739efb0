"""Results and warnings of the last operation on the scan."""

import bpy

from ..operators.scene import polls
from .step import Step, in_both_editors


class REFLCOLOR_UL_notices(bpy.types.UIList):
    """Results and warnings of the last operation; a click shows the seed that is meant"""

    def draw_item(self, _context, layout, _data, notice, _icon, _active_data, _active_property, index):
        icon = "INFO" if not notice.warning else "RESTRICT_SELECT_OFF" if notice.row >= 0 else "ERROR"
        row = layout.split(factor=0.88)
        text = row.row()
        text.alignment = "LEFT"
        text.operator("reflcolor.show_notice", text=notice.text, icon=icon, emboss=False, translate=False).index = index
        row.operator("reflcolor.read_notice", text="", icon="FULLSCREEN_ENTER", emboss=False).index = index


class Messages(Step):
    """Results and warnings of the last operation on the scan"""

    bl_label = "Messages"

    @classmethod
    def poll(cls, context):
        obj = polls.scan_object(context)
        return obj is not None and bool(obj.reflcolor.notices)

    def draw_step(self, context, layout, obj):
        state = obj.reflcolor
        rows = min(max(len(state.notices), 2), 6)
        layout.template_list(
            "REFLCOLOR_UL_notices", "", state, "notices", state, "active_notice", rows=rows, maxrows=6, sort_lock=True
        )


classes = (REFLCOLOR_UL_notices, *in_both_editors(Messages))
