"""Choose what the viewport shows of a scan."""

import bpy
from bpy.props import EnumProperty

from .scene import polls
from .scene.looks import LOOKS, show_look, why_not
from .scene.reports import reported
from .scene.texts import tip
from .window import live_update


class REFLCOLOR_OT_show_look(bpy.types.Operator):
    """Choose what the viewports show of the scan; only reflectance and colorized change renders and exports, too"""

    bl_idname = "reflcolor.show_look"
    bl_label = "Show Scan As"
    bl_options = {"REGISTER", "UNDO"}

    look: EnumProperty(
        name="Show",
        description="What to look at",
        items=tuple(
            (identifier, look.title, look.description, look.icon, number)
            for number, (identifier, look) in enumerate(LOOKS.items())
        ),
    )

    @classmethod
    def poll(cls, context):
        return polls.has_editable_scan(cls, context)

    @classmethod
    def description(cls, context, properties):
        """The tooltip of a button: what it shows, and what is missing for it."""
        look, obj = LOOKS[properties.look], polls.scan_object(context)
        reason = why_not(obj, properties.look) if obj is not None else None
        return f"{tip(look.description)}.\n{tip(reason)}" if reason else tip(look.description)

    @reported
    def execute(self, context):
        obj = polls.scan_object(context)
        show_look(obj, self.look)
        live_update.look_was_chosen(obj, self.look)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_show_look,)
