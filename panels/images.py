"""Step 2: the reflectance image and the photos."""

import bpy

from ..operators.scene import polls
from ..operators.scene.photo_list import active_image, photo_settings
from ..operators.scene.texts import label
from ..operators.scene.verdicts import verdict_of
from ..operators.window import seed_picking
from .step import Step, draw_act, in_both_editors, is_running


class REFLCOLOR_UL_photos(bpy.types.UIList):
    """Photos that colors are taken from, with what became of them"""

    def draw_item(self, context, layout, _data, photo, _icon, _active_data, _active_property):
        if photo.image is None:
            layout.label(text="Deleted image", icon="ERROR")
            return
        verdict = verdict_of(polls.scan_object(context), photo.image)
        icon = "IMAGE_DATA" if verdict is None else "CHECKMARK" if verdict.verified else "ERROR"
        layout.label(text=photo.image.name, icon=icon, translate=False)


class Images(Step):
    """The images to pick in"""

    bl_label = "2. Images"

    def draw_step(self, context, layout, obj):
        settings = photo_settings(context.scene)
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
        verdict = verdict_of(obj, active_image(context.scene))
        if is_running("Load Photo") or not settings.photos:
            draw_act(layout, "reflcolor.load_photo", "Load Photo", icon="FILE_IMAGE")
        elif verdict is not None:
            row = layout.row(align=True)
            said = label("Verified on this scan") if verdict.verified else label("Not found on this scan")
            row.label(text=said, icon="CHECKMARK" if verdict.verified else "ERROR", translate=False)
            row.operator("reflcolor.read_verdict", text="", icon="FULLSCREEN_ENTER", emboss=False)
        else:
            # A row in any case: no button below it is to jump.
            layout.label(text="Not matched with this scan", icon="IMAGE_DATA")


classes = (REFLCOLOR_UL_photos, *in_both_editors(Images))
