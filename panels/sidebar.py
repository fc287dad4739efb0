"""The steps from a scan to its colors, in order, in the 3D View's sidebar."""

import bpy

from ..operators import jobs, polls
from ..reflcolor_addon.settings import PRESETS


class _Step:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Reflectance"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_step(context, layout, polls.scan_object(context))


class REFLCOLOR_UL_seeds(bpy.types.UIList):
    """Seeds of a scan: color, number, row and column"""

    def draw_item(self, _context, layout, _data, seed, _icon, _active_data, _active_property, index):
        split = layout.split(factor=0.3)
        split.prop(seed, "color", text="")
        row = split.row()
        row.label(text=f"{index + 1}:  {seed.row}, {seed.col}", translate=False)
        if seed.photo:
            row.label(text="", icon="IMAGE_DATA")


class REFLCOLOR_UL_photos(bpy.types.UIList):
    """Photos that colors are taken from, with what became of them"""

    def draw_item(self, _context, layout, _data, photo, _icon, _active_data, _active_property):
        if photo.image is None:
            layout.label(text="Deleted image", icon="ERROR")
            return
        layout.label(text=photo.image.name, icon="IMAGE_DATA", translate=False)


class REFLCOLOR_PT_scan(_Step, bpy.types.Panel):
    bl_label = "1. Scan"

    def draw_step(self, context, layout, obj):
        layout.operator("reflcolor.import_scan", icon="IMPORT")
        if obj is None:
            layout.label(text="Import a scan, or select one", icon="INFO")
            return
        column = layout.column(align=True)
        column.label(text=obj.name, icon="MESH_GRID", translate=False)
        column.label(text=f"{obj.reflcolor.rows} x {obj.reflcolor.cols} pixels, {len(obj.data.vertices)} returns")


class REFLCOLOR_PT_images(_Step, bpy.types.Panel):
    bl_label = "2. Images"

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
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


class REFLCOLOR_PT_seeds(_Step, bpy.types.Panel):
    bl_label = "3. Seeds"

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        state = obj.reflcolor
        row = layout.row()
        row.template_list("REFLCOLOR_UL_seeds", "", state, "seeds", state, "active_seed", rows=4)
        buttons = row.column(align=True)
        buttons.operator("reflcolor.add_seed", text="", icon="ADD")
        buttons.operator("reflcolor.remove_seed", text="", icon="REMOVE")
        buttons.separator()
        buttons.operator("reflcolor.move_seed", text="", icon="ARROW_LEFTRIGHT")
        buttons.operator("reflcolor.clear_seeds", text="", icon="TRASH")
        row = layout.row(align=True)
        row.operator("reflcolor.load_seeds", icon="FILE_FOLDER")
        row.operator("reflcolor.save_seeds", icon="FILE_TICK")


class REFLCOLOR_PT_match(_Step, bpy.types.Panel):
    bl_label = "Find in Photos"
    bl_parent_id = "REFLCOLOR_PT_seeds"

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        layout.prop(settings, "matching")
        layout.operator("reflcolor.match_photos", icon="VIEWZOOM")
        if obj is not None and settings.photos:
            pairs = sum(seed.reason == "hand" and seed.photo is not None for seed in obj.reflcolor.seeds)
            column = layout.column(align=True)
            column.label(text="Not recognized? Pick 4 to 6 seeds", icon="INFO")
            column.label(text=f"with a photo point ({pairs} so far)", icon="BLANK1")


class REFLCOLOR_PT_descriptors(_Step, bpy.types.Panel):
    bl_label = "Superpixels and Descriptors"
    bl_parent_id = "REFLCOLOR_PT_match"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, _obj):
        for names in (
            ("slic_segments", "slic_compactness", "slic_sigma"),
            ("hog_cell", "hog_block", "hog_orientations", "hog_window"),
        ):
            column = layout.column(align=True)
            for name in names:
                column.prop(context.scene.reflcolor, name)


class REFLCOLOR_PT_colorize(_Step, bpy.types.Panel):
    bl_label = "4. Colorize"

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        row = layout.row(align=True)
        for preset in PRESETS:
            row.operator("reflcolor.apply_preset", text=preset).preset = preset
        column = layout.column()
        column.prop(settings, "alpha")
        column.prop(settings, "beta")
        job = jobs.running()
        if job is not None:
            layout.progress(factor=job.fraction, text="Cancelling" if job.stopping else job.name)
            layout.label(text="Press ESC to cancel", icon="EVENT_ESC")
            return
        row = layout.row()
        row.scale_y = 1.5
        row.operator("reflcolor.colorize", icon="COLOR")
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
        elif not obj.reflcolor.seeds:
            layout.label(text="Needs seeds", icon="INFO")


class REFLCOLOR_PT_advanced(_Step, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "REFLCOLOR_PT_colorize"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, _obj):
        settings = context.scene.reflcolor
        layout.prop(settings, "color_space")
        layout.row().prop(settings, "neighbors", expand=True)
        layout.prop(settings, "blend")
        if settings.blend == "nearest":
            layout.prop(settings, "nearest")
        layout.prop(settings, "smoothing")
        layout.prop(settings, "kriging")


class REFLCOLOR_PT_evaluate(_Step, bpy.types.Panel):
    bl_label = "5. Evaluate"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        layout.prop(obj.reflcolor, "truth_image")
        layout.operator("reflcolor.evaluate", icon="VIEWZOOM")


classes = (
    REFLCOLOR_UL_seeds,
    REFLCOLOR_UL_photos,
    REFLCOLOR_PT_scan,
    REFLCOLOR_PT_images,
    REFLCOLOR_PT_seeds,
    REFLCOLOR_PT_match,
    REFLCOLOR_PT_descriptors,
    REFLCOLOR_PT_colorize,
    REFLCOLOR_PT_advanced,
    REFLCOLOR_PT_evaluate,
)
