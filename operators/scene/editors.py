"""The editors of the window that show a scan or its images."""

import bpy

from .quiet import write_quietly


def redraw_editors(kinds=frozenset({"VIEW_3D", "IMAGE_EDITOR"})):
    """Have every 3D View and Image Editor, or those of some kinds, drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in kinds:
                area.tag_redraw()


def redraw_sidebars():
    """Have the sidebars of 3D Views and Image Editors drawn again, and not the views, which takes far longer."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "IMAGE_EDITOR"}:
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def select_only(seeds, indices):
    """Select these of a collection of seeds, and no others."""
    chosen, selected = set(indices), [False] * len(seeds)
    seeds.foreach_get("select", selected)
    # One by one, and only those that change: if all were set at once, Blender would draw the mesh again.
    for index, before in enumerate(selected):
        if before != (index in chosen):
            write_quietly(seeds[index], select=not before)
