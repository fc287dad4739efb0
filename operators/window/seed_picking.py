"""A workspace to pick seeds in: the reflectance image, a photo and the mesh, side by side."""

import bpy

from ..scene.photo_list import listed_images
from ..scene.viewpoint import look_from_scanner, show_scans_alone

NAME = "Seed Picking"
# The workspace that was there before, kept with the one that is laid out.
_BEFORE = "reflcolor_before"
# Share of the width that the two images get.
_IMAGES_SHARE = 0.55
_TRIES = 40


def open_seed_picking(context, obj):
    """Show the workspace to pick the seeds of a scan's object in, and lay it out where it is not there yet."""
    _begin(_open(_number(context.window), context.window.workspace.name, obj.name))


def close_seed_picking(context):
    """Go back to the workspace that was there before, and remove the one to pick seeds in."""
    _begin(_close(_number(context.window), context.workspace.get(_BEFORE, "")))


def is_open(context):
    """Whether the window shows the workspace to pick seeds in."""
    return context.workspace is not None and _BEFORE in context.workspace


def _number(window):
    return list(bpy.context.window_manager.windows).index(window)


def _begin(steps):
    """Do one step whenever Blender has nothing else to do: it changes workspaces and areas between events."""
    bpy.app.timers.register(lambda: next(steps, None), first_interval=0)


def _window(number):
    windows = bpy.context.window_manager.windows
    return windows[min(number, len(windows) - 1)]


def _open(number, before, object_name):
    if NAME in bpy.data.workspaces:
        _window(number).workspace = bpy.data.workspaces[NAME]
        yield 0.05
    else:
        with bpy.context.temp_override(window=_window(number)):
            bpy.ops.workspace.duplicate()
        for _ in range(_TRIES):
            yield 0.05
            if _window(number).workspace.name != before:
                break
        workspace = _window(number).workspace
        if workspace.name == before:
            return
        workspace.name = NAME
        workspace[_BEFORE] = before
        yield from _lay_out(number)
    obj = bpy.data.objects.get(object_name)
    if obj is not None:
        yield from _fill(number, obj.name)


def _lay_out(number):
    """One 3D View at the right, its sidebar as high as the window, and two Image Editors one above the other."""
    for _ in range(_TRIES):
        areas = sorted(_window(number).screen.areas, key=lambda area: area.width * area.height)
        if len(areas) == 1:
            break
        for area in areas[:-1]:
            if _apply(number, area, bpy.ops.screen.area_close):
                break
        else:
            break
    area = max(_window(number).screen.areas, key=lambda area: area.width * area.height)
    area.ui_type = "IMAGE_EDITOR"
    _apply(number, area, bpy.ops.screen.area_split, direction="VERTICAL", factor=_IMAGES_SHARE)
    # Where areas are is known once they were drawn; images are drawn more quickly than the mesh.
    yield 0.01
    max(_window(number).screen.areas, key=lambda area: area.x).ui_type = "VIEW_3D"
    left = min(_window(number).screen.areas, key=lambda area: area.x)
    _apply(number, left, bpy.ops.screen.area_split, direction="HORIZONTAL", factor=0.5)
    yield 0.1


def _fill(number, object_name):
    """Show the images and the mesh, whole, with the tools at hand."""
    obj, window = bpy.data.objects[object_name], _window(number)
    photos = listed_images(window.scene)
    images = [obj.reflcolor.reflectance_image, photos[-1] if photos else None]
    editors = sorted((area for area in window.screen.areas if area.type == "IMAGE_EDITOR"), key=lambda area: -area.y)
    for area, image in zip(editors, images, strict=False):
        area.spaces.active.image = image
        area.spaces.active.show_region_toolbar = area.spaces.active.show_region_tool_header = True
        _apply(number, area, bpy.ops.wm.tool_set_by_id, name="reflcolor.seed_tool", space_type="IMAGE_EDITOR")
    for area in window.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.show_region_ui = True
            # An outline around every hole of the scan hides what is picked.
            area.spaces.active.overlay.show_outline_selected = False
    for _ in range(_TRIES):
        yield 0.05
        if all(_show_tab(area) for area in _window(number).screen.areas if area.type == "VIEW_3D"):
            break
    obj = bpy.data.objects.get(object_name)
    for area in _window(number).screen.areas:
        if area.type == "IMAGE_EDITOR" and area.spaces.active.image is not None:
            _apply(number, area, bpy.ops.image.view_all, fit_view=True)
        elif area.type == "VIEW_3D" and obj is not None:
            look_from_scanner(bpy.context, [obj], area)
            show_scans_alone(bpy.context, area)


def _show_tab(area):
    """Bring the steps to the front of a sidebar; possible once it was drawn."""
    region = next(region for region in area.regions if region.type == "UI")
    try:
        region.active_panel_category = "Reflectance"
    except (AttributeError, TypeError):
        area.tag_redraw()
        return False
    area.tag_redraw()
    return True


def _apply(number, area, operator, **properties):
    """Run an operator as if the pointer were in an area; return whether it did something."""
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=_window(number), area=area, region=region):
        return operator.poll() and operator(**properties) == {"FINISHED"}


def _close(number, before):
    doomed = _window(number).workspace.name
    if before not in bpy.data.workspaces:
        before = next((other.name for other in bpy.data.workspaces if other.name != doomed), doomed)
    _window(number).workspace = bpy.data.workspaces[before]
    for _ in range(_TRIES):
        yield 0.05
        if _window(number).workspace.name != doomed:
            break
    else:
        return
    if not any(window.workspace.name == doomed for window in bpy.context.window_manager.windows):
        workspace = bpy.data.workspaces[doomed]
        bpy.data.batch_remove([workspace, *workspace.screens])
