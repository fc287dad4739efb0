"""Pick a color in a photo: for the selected seeds, or for those that are placed next."""

import bpy
from bpy.props import BoolProperty, FloatVectorProperty, StringProperty

from ..reflcolor_addon.errors import SeedsError
from .scene import polls
from .scene.editors import select_only
from .scene.images import read_pixel
from .scene.photo_list import list_photo
from .scene.reports import reported
from .scene.seed_colors import give_color, hold_color
from .scene.seed_list import selected_seeds
from .scene.texts import NO_COLOR
from .window.live_update import redraw_seeds


class REFLCOLOR_OT_pick_color(bpy.types.Operator):
    """Pick a color in a photo, for the selected seeds or, if none is, for those that are placed next"""

    bl_idname = "reflcolor.pick_color"
    bl_label = "Pick Color"
    bl_options = {"REGISTER", "UNDO"}

    photo: StringProperty(name="Photo", description="Name of a loaded photo")
    photo_xy: FloatVectorProperty(
        name="Point", description="Place in the photo, in pixels from its top left corner", size=2
    )
    sample_only: BoolProperty(
        name="Sample Only", description="Keep the color for the next seeds, without noting the point of the photo"
    )

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context)

    @reported
    def execute(self, context):
        obj, settings = polls.scan_object(context), context.scene.reflcolor
        image = bpy.data.images.get(self.photo)
        color = read_pixel(image, *self.photo_xy) if image is not None else None
        if color is None:
            x, y = self.photo_xy
            raise SeedsError(NO_COLOR, photo=self.photo, x=x, y=y)
        selected = [] if self.sample_only or settings.picked else selected_seeds(obj)
        for seed in (obj.reflcolor.seeds[index] for index in selected):
            give_color(seed, color, image if len(selected) == 1 else None, self.photo_xy)
        if selected:
            select_only(obj.reflcolor.seeds, [])
        else:
            hold_color(settings, color, None if self.sample_only else image, self.photo_xy)
        if not self.sample_only:
            list_photo(context.scene, image)
        redraw_seeds(obj)
        return {"FINISHED"}


classes = (REFLCOLOR_OT_pick_color,)
