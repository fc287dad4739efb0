"""Show what a message of the list is about."""

import bpy
from bpy.props import IntProperty

from .scene import polls
from .scene.editor_images import center_images
from .scene.editors import redraw_editors
from .scene.notices import seed_of
from .scene.texts import tip


class NoticeChoice:
    """One of the messages of the scan, as a property of an operator."""

    index: IntProperty(name="Message", description="Message of the list, counted from 0", min=0, options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        if not polls.has_scan(cls, context):
            return False
        missing = None if polls.scan_object(context).reflcolor.notices else tip("There are no messages")
        return polls.nothing_missing(cls, missing)

    def notice(self, context):
        """Return the chosen message; the last one where there are fewer."""
        notices = polls.scan_object(context).reflcolor.notices
        return notices[min(self.index, len(notices) - 1)]


class REFLCOLOR_OT_show_notice(NoticeChoice, bpy.types.Operator):
    """Select the seed that the message is about and show it in the images; without one, show the whole message"""

    bl_idname = "reflcolor.show_notice"
    bl_label = "Show Message"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def description(cls, context, properties):
        """The tooltip: the whole message, even if it does not fit into the panel."""
        obj = polls.scan_object(context)
        if obj is None or properties.index >= len(obj.reflcolor.notices):
            return cls.__doc__
        notice = obj.reflcolor.notices[properties.index]
        hint = tip("Click to select the seed and show it")
        return f"{notice.text}\n{hint}" if notice.row >= 0 else notice.text

    def execute(self, context):
        obj, notice = polls.scan_object(context), self.notice(context)
        seed = seed_of(obj, notice)
        if seed is not None:
            obj.reflcolor.active_seed = seed
            center_images(context, obj, notice.row, notice.col)
            redraw_editors()
            return {"FINISHED"}
        if notice.row >= 0:
            self.report({"INFO"}, "That seed was moved or removed")
            return {"CANCELLED"}
        if context.window is None:
            self.report({"INFO"}, notice.text)
            return {"FINISHED"}
        return bpy.ops.reflcolor.read_notice("INVOKE_DEFAULT", index=self.index)


classes = (REFLCOLOR_OT_show_notice,)
