"""Draws the seeds over the images and the mesh, and lines from seeds to their points in photos."""

from contextlib import suppress

import bpy
import numpy as np

from ...reflcolor_addon.errors import ScanError
from ...reflcolor_addon.view.picking import mark_spacing
from ..scene import polls
from ..scene.editor_images import side_in
from ..scene.scan_object import seed_vertices
from ..scene.seed_arrays import seed_arrays
from ..window import seed_picking
from ..window.tools import SeedTool3D
from . import drawing

# Usual and smallest radius of a mark, in pixels of the screen at a scale of 1: many seeds close together have smaller
# marks, so that they do not hide the image.
_SIZE, _LEAST_SIZE = 8.0, 2.5
_SHARE_OF_SPACING = 0.35
_handles = []
# (what is drawn where) -> (key of the seeds, batch): made again only when the seeds change.
_batches = {}
# Area -> how it showed its image when it was drawn last.
_views = {}


def register():
    """Start drawing."""
    if bpy.app.background:
        return
    for space, draw, kind in (
        (bpy.types.SpaceImageEditor, _draw_in_image, "POST_PIXEL"),
        (bpy.types.SpaceView3D, _draw_in_world, "POST_VIEW"),
    ):
        _handles.append((space, space.draw_handler_add(draw, (), "WINDOW", kind)))


def unregister():
    """Stop drawing."""
    while _handles:
        space, handle = _handles.pop()
        space.draw_handler_remove(handle, "WINDOW")
    _batches.clear()
    _views.clear()
    drawing.forget_shaders()


def styles_of(seeds):
    """Return (S,) int: the style of every seed's mark."""
    styles = seeds.selected * drawing.SELECTED | ~seeds.by_hand * drawing.FOUND
    styles |= ~seeds.has_color * drawing.UNCOLORED | seeds.locked * drawing.LOCKED
    if 0 <= seeds.active < len(styles) and seeds.selected[seeds.active]:
        styles[seeds.active] |= drawing.ACTIVE
    return styles


def _opacity(seeds):
    """How much of a mark's ring shows: less where its color is less sure."""
    return np.where(seeds.by_hand, 1.0, 0.3 + 0.7 * seeds.confidence)


def _batch(place, key, make):
    if _batches.get(place, (None,))[0] != key:
        if len(_batches) > 32:
            _batches.clear()
        _batches[place] = key, make()
    return _batches[place][1]


def _mark_size(count, width, height):
    """Radius of the marks for a number of seeds in an area of the screen."""
    spacing = mark_spacing(count, width, height) * _SHARE_OF_SPACING
    return max(_LEAST_SIZE, min(_SIZE, spacing)) * bpy.context.preferences.system.ui_scale


def _draw_in_image():
    context = bpy.context
    side = side_in(context.area, context.region, context)
    if side is None or not context.space_data.overlay.show_overlays:
        return
    _redraw_partners(context.area, side)
    seeds = seed_arrays(side.obj)
    points, here = side.marks(seeds)
    _draw_match_lines(context, side, seeds)
    if here.any():
        make = lambda: drawing.mark_batch(  # noqa: E731
            points[here], seeds.colors[here], _opacity(seeds)[here], styles_of(seeds)[here]
        )
        batch = _batch((side.obj.name, side.image.name), seeds.key, make)
        drawing.draw_marks(batch, _mark_size(len(here), *side.view.extent), side.view)
    settings = context.scene.reflcolor
    if settings.picked and settings.picked_photo == side.image:
        point = np.array([settings.picked_xy[:]])
        batch = drawing.mark_batch(point, [settings.picked_color[:]], [1.0], [drawing.SELECTED | drawing.ACTIVE])
        drawing.draw_marks(batch, _mark_size(1, *side.view.extent), side.view)


def _redraw_partners(area, side):
    """Lines run from one editor into the other, so the others are drawn again when this one is moved."""
    shown = (side.image.name, side.view)
    if _views.get(area.as_pointer()) == shown:
        return
    _views[area.as_pointer()] = shown
    for other in bpy.context.screen.areas:
        if other.type == "IMAGE_EDITOR" and other != area:
            other.tag_redraw()


def _draw_match_lines(context, side, seeds):
    """Lines to the points of a photo, or from them, that another Image Editor of the window shows."""
    wanted = seeds.photo_names != ""
    if not context.scene.reflcolor.show_matches:
        wanted &= seeds.selected
    if not wanted.any():
        return
    here = context.region
    for area in context.screen.areas:
        region = next((region for region in area.regions if region.type == "WINDOW"), None)
        if area.type != "IMAGE_EDITOR" or area == context.area or region is None:
            continue
        other = side_in(area, region, context)
        if other is None or other.obj != side.obj or other.is_scan == side.is_scan:
            continue
        points, there = other.marks(seeds)
        own, present = side.marks(seeds)
        joined = wanted & there & present
        offset = (region.x - here.x, region.y - here.y)
        opacity = np.where(seeds.selected, 1.0, 0.15 + 0.6 * _opacity(seeds))
        colors = np.column_stack([seeds.colors, opacity])[joined]
        drawing.draw_lines(side.view.to_region(own[joined]), other.view.to_region(points[joined]) + offset, colors)


def _picking_in(context):
    """Whether seeds are picked here: elsewhere the marks of hundreds would hide the colors of the mesh."""
    tool = context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    return seed_picking.is_open(context) or (tool is not None and tool.idname == SeedTool3D.bl_idname)


def _draw_in_world():
    context = bpy.context
    obj = polls.scan_object(context) if _picking_in(context) else None
    if obj is None or not obj.visible_get() or not context.space_data.overlay.show_overlays:
        return
    seeds = seed_arrays(obj)
    if not len(seeds.rows):
        return

    def make():
        places, known = seed_vertices(obj, seeds.rows, seeds.cols)
        return drawing.mark_batch(places[known], seeds.colors[known], _opacity(seeds)[known], styles_of(seeds)[known])

    key = seeds.key, tuple(map(tuple, obj.matrix_world)), len(obj.data.vertices)
    size = _mark_size(len(seeds.rows), context.region.width, context.region.height)
    # In Edit Mode, or if the mesh has lost its grid, the seeds' places are not known; operators report it.
    with suppress(ScanError):
        drawing.draw_marks(_batch((obj.name, "world"), key, make), size)
