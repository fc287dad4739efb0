"""The seed tools in the toolbars of the Image Editor and the 3D View."""

from pathlib import Path

import bpy

_ICON = (Path(__file__).parent / "seeds_icon").as_posix()
_registered = []


def draw_settings(context, layout, _tool):
    """What the next click will do, and in which color."""
    settings = context.scene.reflcolor
    # The label of a property is as wide as its field; in a narrow header that leaves no room for what follows.
    layout.label(text="Seed Color")
    draw_color(layout, settings, text="")
    if not settings.picked:
        layout.label(text="Click scan, then photo, or choose a color", icon="INFO")
    layout.prop(context.window_manager.reflcolor, "live_update", toggle=True, icon="FILE_REFRESH")
    layout.operator("reflcolor.keep_gray", icon="COLORSET_13_VEC")
    layout.prop(settings, "show_matches")
    layout.prop(settings, "stroke_spacing")


def draw_color(layout, settings, text="Seed Color"):
    """The color of the tool: it is always there, and used once it was chosen."""
    row = layout.row(align=True)
    row.prop(settings, "picked_color", text=text)
    if settings.picked:
        row.operator("reflcolor.drop_color", text="", icon="X")


def take_tools(window):
    """Take the tool in every editor of a window that has one."""
    for area in window.screen.areas:
        for tool in _registered:
            if area.type == tool.bl_space_type:
                region = next(region for region in area.regions if region.type == "WINDOW")
                with bpy.context.temp_override(window=window, area=area, region=region):
                    bpy.ops.wm.tool_set_by_id(name=tool.bl_idname, space_type=area.type)
                area.spaces.active.show_region_tool_header = True


def _pick(act, **modifiers):
    return "reflcolor.pick", {"type": "LEFTMOUSE", "value": "CLICK", **modifiers}, {"properties": [("act", act)]}


def _region(shape, mode, key="LEFTMOUSE", value="CLICK_DRAG", **modifiers):
    properties = {"properties": [("shape", shape), ("mode", mode), ("wait", key != "LEFTMOUSE")]}
    return "reflcolor.select_region", {"type": key, "value": value, **modifiers}, properties


_MENU = ("wm.call_menu", {"type": "RIGHTMOUSE", "value": "PRESS"}, {"properties": [("name", "REFLCOLOR_MT_scan")]})
_LEAVE = ("reflcolor.step_back", {"type": "ESC", "value": "PRESS"}, None)


class SeedTool(bpy.types.WorkSpaceTool):
    """Picks seeds in the images of a scan and in photos."""

    bl_space_type = "IMAGE_EDITOR"
    bl_context_mode = "VIEW"
    bl_idname = "reflcolor.seed_tool"
    bl_label = "Seeds"
    bl_description = (
        "Place seeds in the reflectance image and pick their colors in a photo, in either order.\n"
        "Click: place, pick or select.  Drag a seed: move it.  Drag elsewhere: lay a line of seeds.\n"
        "Ctrl-click: delete.  Alt-click: take a color.  Shift-drag: select in a box.  Ctrl-drag: select by a lasso"
    )
    bl_icon = _ICON
    bl_cursor = "CROSSHAIR"
    bl_keymap = (
        _pick("extend", shift=True),
        _pick("delete", ctrl=True),
        _pick("sample", alt=True),
        _pick("pick"),
        _region("box", "set", shift=True),
        _region("lasso", "set", ctrl=True),
        _region("lasso", "add", ctrl=True, shift=True),
        _region("box", "set", "B", "PRESS"),
        ("reflcolor.drag", {"type": "LEFTMOUSE", "value": "CLICK_DRAG"}, None),
        ("reflcolor.delete_seeds", {"type": "X", "value": "PRESS"}, None),
        ("reflcolor.delete_seeds", {"type": "DEL", "value": "PRESS"}, None),
        ("reflcolor.keep_gray", {"type": "G", "value": "PRESS", "shift": True}, None),
        ("reflcolor.lock_seeds", {"type": "L", "value": "PRESS"}, None),
        ("reflcolor.lock_seeds", {"type": "L", "value": "PRESS", "alt": True}, {"properties": [("unlock", True)]}),
        ("reflcolor.select_all_seeds", {"type": "A", "value": "PRESS"}, {"properties": [("which", "all")]}),
        (
            "reflcolor.select_all_seeds",
            {"type": "A", "value": "PRESS", "alt": True},
            {"properties": [("which", "none")]},
        ),
        _MENU,
        _LEAVE,
    )
    draw_settings = staticmethod(draw_settings)


class SeedTool3D(bpy.types.WorkSpaceTool):
    """Picks seeds on the mesh of a scan."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = "reflcolor.seed_tool_3d"
    bl_label = "Seeds"
    bl_description = (
        "Place seeds on the mesh of a scan.\nClick: place or select.  Ctrl-click: delete.  X: delete the selected ones"
    )
    bl_icon = _ICON
    bl_cursor = "CROSSHAIR"
    bl_keymap = (
        ("reflcolor.pick_in_view", {"type": "LEFTMOUSE", "value": "CLICK"}, None),
        (
            "reflcolor.pick_in_view",
            {"type": "LEFTMOUSE", "value": "CLICK", "ctrl": True},
            {"properties": [("delete", True)]},
        ),
        # Here Blender's own X and Delete would take the object.
        ("reflcolor.delete_picked", {"type": "X", "value": "PRESS"}, None),
        ("reflcolor.delete_picked", {"type": "DEL", "value": "PRESS"}, None),
        _LEAVE,
    )
    draw_settings = staticmethod(draw_settings)


def register():
    """Add the tools to the toolbars."""
    for tool in (SeedTool, SeedTool3D):
        bpy.utils.register_tool(tool, separator=True)
        _registered.append(tool)


def unregister():
    """Take the tools off the toolbars."""
    while _registered:
        bpy.utils.unregister_tool(_registered.pop())
