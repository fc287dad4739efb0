"""What the mouse does while the seed tool is at hand, in the status bar."""

import bpy

from ..operators.window.tools import SeedTool


def draw_hints(self, context):
    """Hints at the left of the status bar, where the window shows an Image Editor with the seed tool."""
    if context.window is None or not any(area.type == "IMAGE_EDITOR" for area in context.window.screen.areas):
        return
    tool = context.workspace.tools.from_space_image_mode("VIEW", create=False)
    if tool is None or tool.idname != SeedTool.bl_idname:
        return
    row = self.layout.row(align=True)
    row.label(text="Seed or Color", icon="MOUSE_LMB")
    row.label(text="Move or Stroke", icon="MOUSE_LMB_DRAG")
    # The picture of a key is wider than Blender takes an icon to be.
    row.label(text="", icon="EVENT_CTRL")
    row.separator()
    row.label(text="Delete")
    row.label(text="", icon="EVENT_ALT")
    row.separator()
    row.label(text="Take Color")
    row.label(text="Select", icon="EVENT_SHIFT")
    row.label(text="", icon="EVENT_ESC")
    row.separator()
    row.label(text="Let Go")
    row.separator()


def register():
    """Put the hints into the status bar."""
    bpy.types.STATUSBAR_HT_header.prepend(draw_hints)


def unregister():
    """Take them out again."""
    bpy.types.STATUSBAR_HT_header.remove(draw_hints)
