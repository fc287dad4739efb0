"""The line of before and after in the Image Editor, and its handle that can be dragged."""

import bpy

from . import drawing
from .wipe import overlay_image, scan_side

# In pixels of the screen at a scale of 1.
_REACH, _HANDLE = 8, 12


class REFLCOLOR_GT_wipe(bpy.types.Gizmo):
    """The line between before and after; drag it"""

    bl_idname = "REFLCOLOR_GT_wipe"

    def setup(self):
        self.use_draw_modal = True
        self.use_tooltip = False

    def draw(self, context):
        side = scan_side(context)
        if side is None:
            return
        x, bottom, top = _line(side, context)
        wide = 3.0 if self.is_highlight or self.is_modal else 1.5
        drawing.draw_bar(x, bottom, top, wide * _scale(context))
        middle = (max(bottom, 0) + min(top, context.region.height)) / 2
        drawing.draw_handle(x, middle, _HANDLE * _scale(context), bright=self.is_highlight or self.is_modal)

    def test_select(self, context, location):
        side = scan_side(context)
        if side is None:
            return -1
        x, bottom, top = _line(side, context)
        near = abs(location[0] - x) <= _REACH * _scale(context) and bottom <= location[1] <= top
        return 0 if near else -1

    def invoke(self, context, _event):
        self._before = context.window_manager.reflcolor_wipe.position
        return {"RUNNING_MODAL"}

    def modal(self, context, event, _tweak):
        side = scan_side(context)
        if side is not None:
            x, _ = side.view.to_image((event.mouse_region_x, event.mouse_region_y))
            context.window_manager.reflcolor_wipe.position = x / side.image.size[0]
        return {"RUNNING_MODAL"}

    def exit(self, context, cancel):
        if cancel:
            context.window_manager.reflcolor_wipe.position = self._before


class REFLCOLOR_GGT_wipe(bpy.types.GizmoGroup):
    """Before and after in the Image Editor"""

    bl_idname = "REFLCOLOR_GGT_wipe"
    bl_label = "Before and After"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "WINDOW"
    bl_options = {"PERSISTENT", "SHOW_MODAL_ALL"}

    @classmethod
    def poll(cls, context):
        if not context.window_manager.reflcolor_wipe.show:
            return False
        side = scan_side(context)
        return side is not None and overlay_image(side.obj) is not None

    def setup(self, _context):
        self.gizmos.new(REFLCOLOR_GT_wipe.bl_idname)


def _line(side, context):
    """Where the line is: x, and the y of its ends, in pixels of the region."""
    width, height = side.image.size
    x = context.window_manager.reflcolor_wipe.position * width
    (x, top), (_, bottom) = side.view.to_region([(x, 0), (x, height)])
    return x, bottom, top


def _scale(context):
    return context.preferences.system.ui_scale


def register():
    """Have the handle in Image Editors."""
    for cls in (REFLCOLOR_GT_wipe, REFLCOLOR_GGT_wipe):
        bpy.utils.register_class(cls)


def unregister():
    """Take it away."""
    for cls in (REFLCOLOR_GGT_wipe, REFLCOLOR_GT_wipe):
        bpy.utils.unregister_class(cls)
