"""Select the seeds inside a box or a lasso."""

import bpy
import numpy as np
from bpy.props import EnumProperty

from ..reflcolor_addon.view.picking import box_outline, inside_outline
from .overlays.drawing import draw_outline
from .scene.editor_images import event_side
from .scene.editors import redraw_editors, select_only
from .scene.seed_list import selected_seeds
from .window.pointer import PointerOperator, object_named


class REFLCOLOR_OT_select_region(PointerOperator, bpy.types.Operator):
    """Select the seeds inside a box or a lasso that is drawn around them"""

    bl_idname = "reflcolor.select_region"
    bl_label = "Select Seeds Inside"
    bl_options = {"UNDO", "BLOCKING"}
    hint = "Select Seeds"

    shape: EnumProperty(
        name="Shape",
        description="What is drawn around the seeds",
        items=(("box", "Box", "A rectangle"), ("lasso", "Lasso", "A free line, closed by itself")),
    )
    mode: EnumProperty(
        name="Mode",
        description="What becomes of the selection",
        items=(
            ("set", "Set", "Select these only"),
            ("add", "Extend", "Select these, too"),
            ("subtract", "Subtract", "Deselect these"),
        ),
    )

    def begin(self, context, place):
        side = event_side(context)
        if side is None or not len(side.obj.reflcolor.seeds):
            return None
        side.activate(context)
        return _Outline(side, context.region, place, self.shape, self.mode)


class _Outline:
    """An outline that is being drawn, as `PointerOperator` asks for it."""

    def __init__(self, side, region, place, shape, mode):
        points, here = side.marks()
        self._object, self._outline, self._shape, self._mode = side.obj.name, [place], shape, mode
        self._indices = np.flatnonzero(here)
        self._points = side.view.to_region(points[self._indices])
        self._region = region
        self._handle = bpy.types.SpaceImageEditor.draw_handler_add(self._draw, (), "WINDOW", "POST_PIXEL")

    def follow(self, _context, place):
        if self._shape == "box":
            self._outline = list(box_outline(self._outline[0], place))
        else:
            self._outline.append(place)
        return True

    def finish(self, _context):
        obj = object_named(self._object)
        if obj is None:
            return False
        inside = set(self._indices[inside_outline(self._points, self._outline)].tolist())
        before = set(selected_seeds(obj))
        chosen = {"set": inside, "add": before | inside, "subtract": before - inside}[self._mode]
        select_only(obj.reflcolor.seeds, chosen)
        redraw_editors()
        return True

    def give_up(self, _context):
        redraw_editors()

    def release(self):
        bpy.types.SpaceImageEditor.draw_handler_remove(self._handle, "WINDOW")

    def _draw(self):
        if bpy.context.region == self._region:
            draw_outline(self._outline)


classes = (REFLCOLOR_OT_select_region,)
