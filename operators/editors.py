"""The editors of the window that show a scan or its images."""

import bpy


def redraw_editors(kinds=frozenset({"VIEW_3D", "IMAGE_EDITOR"})):
    """Have every 3D View and Image Editor, or those of some kinds, drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in kinds:
                area.tag_redraw()


def select_only(seeds, indices):
    """Select these of a collection of seeds, and no others."""
    chosen = set(indices)
    seeds.foreach_set("select", [index in chosen for index in range(len(seeds))])
