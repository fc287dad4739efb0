"""Live Update: while it is on, the colors of the active scan follow its seeds and settings.

What is shown meanwhile is a preview: an image of its own, over the images and, in Solid shading, on the mesh. The
colors that the scan has stay as they are, and are seen again when Live Update is turned off.
"""

import bpy
from bpy.app.handlers import persistent

from ...reflcolor_addon.errors import ReflcolorError
from ...reflcolor_addon.failures import line_of
from ...reflcolor_addon.view.live import LiveColorizer
from ..scene import polls
from ..scene.editors import redraw_editors
from ..scene.images import put_pixels, stored_pixels
from ..scene.looks import shown_look
from ..scene.photo_colors import observed_key, observed_reader
from ..scene.scan_object import own_image, scan_reader, show_like_reflectance
from ..scene.seed_arrays import seed_arrays
from ..scene.seed_list import seeds_of
from ..scene.setting_properties import COLORIZE_NAMES, scene_settings
from ..scene.texts import shown
from . import jobs

PREVIEW = "Live Preview"
# Seconds between two looks: for a change, and for the first colors of one.
_POLL_S, _AWAITED_POLL_S = 0.03, 0.01
# Redrawing the mesh of a larger scan is slow on some machines, so it waits for the full result.
_QUICK_VERTICES = 150_000


class _Live:
    """The scan that is followed."""

    def __init__(self, obj):
        self.place = _place(obj)
        self.colorizer = LiveColorizer(scan_reader(obj), prepare=stored_pixels)
        self.wished = self.kept = self.seen = None
        self.shown = 0

    def wish(self, obj, settings):
        """Ask for the colors of the present seeds and settings, if those are not asked for yet."""
        wanted = _wanted(obj), settings
        if self.wished != wanted:
            self.wished, self.kept = wanted, None
            if self.seen is None or self.seen[0] != observed_key(obj):
                self.seen = observed_key(obj), observed_reader(obj)()
            self.colorizer.wish(seeds_of(obj), settings, self.seen[1])

    def awaits(self):
        """Whether nothing has come of the last wish yet."""
        return self.shown < self.colorizer.latest

    def settled(self):
        """Whether the newest result is there in full."""
        return self.kept is not None


def _wanted(obj):
    """A value that is the same as long as the object's seeds with a color, and what photos saw, are.

    Which seeds are selected does not matter.
    """
    seeds = seed_arrays(obj)
    columns = (
        seeds.rows,
        seeds.cols,
        seeds.colors,
        seeds.photo_xy,
        seeds.photo_names,
        seeds.found_by,
        seeds.confidence,
        seeds.locked,
    )
    return hash((observed_key(obj), *(column[seeds.has_color].tobytes() for column in columns)))


_live = None
# (screen, number of the area in it, what it colored surfaces by before)
_switched = []
_message = ""
# Whether 3D Views are left alone, because a person chose there what to look at.
_given_way = False


def message():
    """Return what keeps the preview from being shown; empty if nothing does."""
    return _message


def finished(obj, settings):
    """Return the Colorization of the object's present seeds by these settings if the preview has it, else None."""
    if _live is None or _live.place != _place(obj) or _live.wished != (_wanted(obj), settings):
        return None
    return _live.kept


def redraw_seeds(obj):
    """Have the editors drawn that show the object's seeds; those of a large mesh with the preview that will follow."""
    follows = bpy.context.window_manager.reflcolor.live_update
    if follows and _live is not None and _live.place == _place(obj) and jobs.running() is None:
        # The timer's next turn may come only after all editors were drawn.
        _wish(obj)
    large = len(obj.data.vertices) > _QUICK_VERTICES
    redraw_editors({"IMAGE_EDITOR"} if follows and large else {"IMAGE_EDITOR", "VIEW_3D"})


def switch(on):
    """Begin to follow the seeds, or end it and show again what was there."""
    global _given_way
    obj = polls.scan_object(bpy.context)
    _given_way = obj is not None and shown_look(obj) not in (None, "gray", "colorized")
    if on and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=0)
    if not on:
        _end()
        redraw_editors()


def look_was_chosen(obj, identifier):
    """Have 3D Views show what a person chose there; that is the preview again where the result's colors were chosen."""
    global _given_way
    _given_way = identifier != "colorized"
    if _given_way:
        _switch_back()
    elif _live is not None and _live.place == _place(obj) and obj.reflcolor.preview_image is not None:
        _lay_on_mesh(obj)


def _tick():
    """Look for a change, and for a result; quick, because the window waits for it."""
    window = bpy.context.window_manager
    if not window.reflcolor.live_update:
        return None
    obj = polls.scan_object(bpy.context)
    if obj is not None and jobs.running() is None:
        _follow(obj)
    return _AWAITED_POLL_S if _live is not None and _live.awaits() else _POLL_S


def _wish(obj):
    """Ask for the colors of the object's present seeds; return whether that could be done."""
    global _live, _message
    try:
        if _live is None or _live.place != _place(obj):
            _end()
            _live = _Live(obj)
        _live.wish(obj, scene_settings(bpy.context.scene, COLORIZE_NAMES))
    except ReflcolorError as error:
        _message = shown(error.message)
        return False
    return True


def _follow(obj):
    global _message
    if not _wish(obj):
        return
    result = _live.colorizer.take()
    if result is None:
        return
    error, _message, _live.shown = result.error, "", result.number
    if error is not None:
        line = line_of(error)
        if line is None:
            raise error
        _message = shown(line)
        redraw_editors()
    else:
        if result.number == _live.colorizer.latest:
            _live.kept = result.colorization
        _show(obj, result)


def _place(obj):
    return obj.name, obj.data.name, len(obj.data.vertices), obj.reflcolor.rows, obj.reflcolor.cols


def _show(obj, result):
    state = obj.reflcolor
    size = state.cols, state.rows
    state.preview_image = put_pixels(own_image(obj, "preview_image"), f"{obj.name} {PREVIEW}", result.prepared, size)
    show_like_reflectance(obj, state.preview_image)
    _lay_on_mesh(obj)
    redraw_editors(
        {"IMAGE_EDITOR"}
        if result.colorization is None and len(obj.data.vertices) > _QUICK_VERTICES
        else {"IMAGE_EDITOR", "VIEW_3D"}
    )


def _lay_on_mesh(obj):
    """Have Solid shading show the preview on the object: by an image node that nothing else uses."""
    material = obj.active_material
    if material is None or material.node_tree is None:
        return
    nodes = material.node_tree.nodes
    node = nodes.get(PREVIEW)
    if node is None:
        node = nodes.new("ShaderNodeTexImage")
        node.name = node.label = PREVIEW
    if node.image != obj.reflcolor.preview_image:
        node.image = obj.reflcolor.preview_image
    if nodes.active != node:
        nodes.active = node
    if _switched or _given_way:
        return
    for screen, index, space in _solid_views():
        if space.shading.color_type in {"VERTEX", "MATERIAL"}:
            _switched.append((screen.name, index, space.shading.color_type))
            space.shading.color_type = "TEXTURE"


def _solid_views():
    return [
        (screen, index, area.spaces.active)
        for screen in bpy.data.screens
        for index, area in enumerate(screen.areas)
        if area.type == "VIEW_3D"
    ]


def _end():
    """Stop following, and take the preview off."""
    global _live, _message
    if _live is not None:
        _live.colorizer.stop(wait=False)
    _live, _message = None, ""
    _take_off()


def _switch_back():
    before = {(screen, index): color_type for screen, index, color_type in _switched}
    _switched.clear()
    for screen, index, space in _solid_views():
        if (screen.name, index) in before and space.shading.color_type == "TEXTURE":
            space.shading.color_type = before[screen.name, index]


def _take_off():
    _switch_back()
    for material in bpy.data.materials:
        if material.node_tree is not None and PREVIEW in material.node_tree.nodes:
            material.node_tree.nodes.remove(material.node_tree.nodes[PREVIEW])
    for obj in bpy.data.objects:
        image = obj.reflcolor.preview_image
        if image is not None:
            obj.reflcolor.preview_image = None
            bpy.data.images.remove(image)


@persistent
def _file_was_loaded(_path):
    bpy.context.window_manager.reflcolor.live_update = False


@persistent
def _file_is_saved(_path):
    """A saved file holds the colors that the scan has; the preview is laid on again by the next result."""
    if _live is not None:
        _end()


@persistent
def _something_will_be_undone(_scene):
    """Take the preview off: Blender keeps what no step changed, and with it pointers to an image that is in none."""
    _take_off()


@persistent
def _something_was_undone(_scene):
    """An earlier state may have had the preview on; where it is followed, it is laid on anew."""
    _take_off()
    if _live is not None:
        _live.wished = None


handlers = (
    (bpy.app.handlers.load_post, _file_was_loaded),
    (bpy.app.handlers.save_pre, _file_is_saved),
    (bpy.app.handlers.undo_pre, _something_will_be_undone),
    (bpy.app.handlers.redo_pre, _something_will_be_undone),
    (bpy.app.handlers.undo_post, _something_was_undone),
    (bpy.app.handlers.redo_post, _something_was_undone),
)


def unregister():
    """End all of it."""
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _end()
