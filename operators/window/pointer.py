"""Operators that follow the pointer from press to release."""

import bpy
from bpy.props import BoolProperty

from ...reflcolor_addon.errors import ReflcolorError
from ..scene.reports import reported
from ..scene.texts import label

_following = []


def unregister():
    """Let go of whatever is being dragged; the extension is about to go."""
    for operator in list(_following):
        operator.let_go()


class PointerOperator:
    """Follows the pointer while the left mouse button is down; with ``wait``, that is waited for first.

    A subclass gives ``begin(context, place)``, which returns None where there is nothing to do, else an object that has
    ``follow(context, place)``, which returns whether it can go on, ``finish(context)``, which returns whether anything
    was changed, ``give_up(context)``, which puts things back, and perhaps ``release()``, called at the end of either.
    Places are (x, y) in the region.
    """

    hint = ""

    wait: BoolProperty(
        name="Wait",
        description="Wait for the mouse button to be pressed, as when a key began it",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def invoke(self, context, event):
        self._area, self._region, self._drag = context.area, context.region, None
        if not self.wait:
            # Where the button was pressed: Blender reports a drag only some pixels later.
            place = event.mouse_prev_press_x - self._region.x, event.mouse_prev_press_y - self._region.y
            self._begin(context, place)
            if self._drag is None:
                return {"CANCELLED"}
        _following.append(self)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(f"{label(self.hint)}   |   {label('ESC: Cancel')}")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        outcome = {"CANCELLED"}
        try:
            outcome = self._next(context, event)
        finally:
            # Also where an error ends it: Blender then removes the operator.
            if outcome != {"RUNNING_MODAL"}:
                self._end(context)
        return outcome

    @reported
    def _next(self, context, event):
        try:
            return self._follow(context, event)
        except ReflcolorError:
            if self._drag is not None:
                self._drag.give_up(context)
            raise

    def _follow(self, context, event):
        place = event.mouse_x - self._region.x, event.mouse_y - self._region.y
        if self not in _following:
            return {"CANCELLED"}
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            if self._drag is not None:
                self._drag.give_up(context)
            return {"CANCELLED"}
        if self._drag is None:
            if event.type == "LEFTMOUSE" and event.value == "PRESS":
                self._begin(context, place)
                return {"RUNNING_MODAL"} if self._drag is not None else {"CANCELLED"}
            return {"RUNNING_MODAL"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            done = self._drag.follow(context, place) and self._drag.finish(context)
            return {"FINISHED"} if done else {"CANCELLED"}
        if event.type == "MOUSEMOVE":
            if not self._drag.follow(context, place):
                return {"CANCELLED"}
            self._area.tag_redraw()
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender ends the operator, because its window or file goes away."""
        self._end(context)

    def let_go(self):
        """Drop what is held; the operator ends at the next event."""
        if self in _following:
            _following.remove(self)
            if hasattr(self._drag, "release"):
                self._drag.release()

    @reported
    def _begin(self, context, place):
        """Begin, where nothing keeps the subclass from it."""
        self._drag = self.begin(context, place)

    def _end(self, context):
        self.let_go()
        if context.workspace is not None:
            context.workspace.status_text_set(None)


def object_named(name):
    """Return the object of that name that is a scan; None if it is gone."""
    obj = bpy.data.objects.get(name)
    return obj if obj is not None and obj.reflcolor.rows else None
