"""The steps from a scan to its colors, in order, in the 3D View's sidebar."""

import bpy

from ..operators import jobs, polls


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
        layout.operator("reflcolor.open_reflectance", icon="IMAGE_REFERENCE")
        layout.operator("reflcolor.load_photo", icon="FILE_IMAGE")
        layout.prop(context.scene.reflcolor, "photo")


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


class REFLCOLOR_PT_colorize(_Step, bpy.types.Panel):
    bl_label = "4. Colorize"

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        column = layout.column()
        for name in ("alpha", "beta", "color_space"):
            column.prop(settings, name)
        column.row().prop(settings, "neighbors", expand=True)
        column.prop(settings, "blend")
        if settings.blend == "nearest":
            column.prop(settings, "nearest")
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


classes = (REFLCOLOR_UL_seeds, REFLCOLOR_PT_scan, REFLCOLOR_PT_images, REFLCOLOR_PT_seeds, REFLCOLOR_PT_colorize)
