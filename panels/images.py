"""Step 2: the reflectance image and the photos."""

import bpy

from ..operators.window import seed_picking
from .step import Step, in_both_editors


class REFLCOLOR_UL_photos(bpy.types.UIList):
    """Photos that colors are taken from, with what became of them"""

    def draw_item(self, _context, layout, _data, photo, _icon, _active_data, _active_property):
        if photo.image is None:
            layout.label(text="Deleted image", icon="ERROR")
            return
        layout.label(text=photo.image.name, icon="IMAGE_DATA", translate=False)


class Images(Step):
    """The images to pick in"""

    bl_label = "2. Images"

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        if seed_picking.is_open(context):
            layout.operator("reflcolor.close_seed_picking", icon="LOOP_BACK")
        else:
            layout.operator("reflcolor.open_seed_picking", icon="WORKSPACE")
        layout.operator("reflcolor.open_reflectance", icon="IMAGE_REFERENCE")
        row = layout.row()
        row.template_list("REFLCOLOR_UL_photos", "", settings, "photos", settings, "active_photo", rows=2)
        buttons = row.column(align=True)
        buttons.operator("reflcolor.load_photo", text="", icon="ADD")
        buttons.operator("reflcolor.remove_photo", text="", icon="REMOVE")
        if settings.active_photo < len(settings.photos) and settings.photos[settings.active_photo].note:
            layout.label(text=settings.photos[settings.active_photo].note, icon="INFO", translate=False)
        elif not settings.photos:
            layout.operator("reflcolor.load_photo", icon="FILE_IMAGE")


classes = (REFLCOLOR_UL_photos, *in_both_editors(Images))
