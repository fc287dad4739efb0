"""Show what a message of the list is about."""

import bpy
from bpy.props import IntProperty

from .scene import polls
from .scene.editor_images import side_in
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


def center_images(context, obj, row, col):
    """Move the view of every Image Editor that shows an image of the scan so that a pixel is in its middle."""
    if context.window is None:
        return
    for area in context.window.screen.areas:
        region = next((region for region in area.regions if region.type == "WINDOW"), None)
        if area.type != "IMAGE_EDITOR" or region is None:
            continue
        side = side_in(area, region, context)
        if side is None or not side.is_scan or side.obj != obj:
            continue
        x, y = side.view.to_region((col + 0.5, row + 0.5))
        # A border as large as the region moves the view but keeps its zoom.
        left, bottom = round(x - region.width / 2), round(y - region.height / 2)
        border = {"xmin": left, "xmax": left + region.width, "ymin": bottom, "ymax": bottom + region.height}
        with context.temp_override(area=area, region=region):
            bpy.ops.image.view_zoom_border(**border)


classes = (REFLCOLOR_OT_show_notice,)
