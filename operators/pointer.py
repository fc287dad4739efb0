"""Operators that follow the pointer from press to release."""

import bpy

_following = []


def stop_all():
    """Let go of whatever is being dragged; the extension is about to go."""
    while _following:
        _following.pop().release()


class PointerOperator:
    """Follows the pointer while the left mouse button is down; started by a key, it waits for the button first.

    A subclass gives ``begin(context, place)``, which returns whether there is anything to do, ``follow(context,
    place)``, ``finish(context)``, which returns whether anything was changed, ``give_up(context)``, which puts things
    back, and ``release()``, which drops what was held meanwhile. Places are (x, y) in the region.
    """

    hint = ""

    def invoke(self, context, event):
        self.lost = False
        self._area, self._region = context.area, context.region
        self._waiting = event.type != "LEFTMOUSE"
        if not self._waiting and not self.begin(context, pressed_at(context.region, event)):
            return {"CANCELLED"}
        _following.append(self)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(f"{self.hint}   |   ESC: Cancel")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        place = event.mouse_x - self._region.x, event.mouse_y - self._region.y
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            if not self._waiting:
                self.give_up(context)
            return self._end(context, {"CANCELLED"})
        if self._waiting:
            if event.type == "LEFTMOUSE" and event.value == "PRESS":
                self._waiting = False
                return {"RUNNING_MODAL"} if self.begin(context, place) else self._end(context, {"CANCELLED"})
            return {"RUNNING_MODAL"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self.follow(context, place)
            done = not self.lost and self.finish(context)
            return self._end(context, {"FINISHED"} if done else {"CANCELLED"})
        if event.type == "MOUSEMOVE":
            self.follow(context, place)
            self._area.tag_redraw()
        return self._end(context, {"CANCELLED"}) if self.lost else {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender ends the operator, because its window or file goes away."""
        self._end(context, {"CANCELLED"})

    def release(self):
        """Drop what was held while the pointer was followed."""

    def _end(self, context, outcome):
        if self in _following:
            _following.remove(self)
            self.release()
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        return outcome


def pressed_at(region, event):
    """Return where in a region the button went down: only some pixels further on does Blender call it a drag."""
    return event.mouse_prev_press_x - region.x, event.mouse_prev_press_y - region.y


def object_named(name):
    """Return the object of that name that is a scan; None if it is gone."""
    obj = bpy.data.objects.get(name)
    return obj if obj is not None and obj.reflcolor.rows else None
