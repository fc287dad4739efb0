"""Step 3: the seeds, picked by hand or found in photos."""

import bpy

from ..operators.scene.scan_object import SCANNED
from ..operators.scene.texts import label
from ..operators.window.tools import draw_color
from .presets import REFLCOLOR_PT_match_presets
from .step import Step, draw_act, draw_selected, in_both_editors

# Of the list's width.
_COLOR_SHARE = 0.22
# In units of the interface: how sure a color is, and the lock beside it.
_FACTS_WIDTH, _LOCK_WIDTH = 2.6, 0.8


class REFLCOLOR_UL_seeds(bpy.types.UIList):
    """Seeds of a scan: color, number, how sure the color is, lock"""

    def draw_item(self, _context, layout, _data, seed, _icon, _active_data, _active_property, index):
        split = layout.split(factor=_COLOR_SHARE)
        swatch = split.row(align=True)
        swatch.prop(seed, "color", text="")
        row = split.row(align=True)
        row.label(text=f"{index + 1}", icon="NONE" if seed.has_color else "QUESTION", translate=False)
        facts = row.row(align=True)
        facts.ui_units_x = _FACTS_WIDTH
        facts.alignment = "RIGHT"
        if seed.reason != "hand":
            facts.label(text=f"{seed.confidence:.0%}", translate=False)
        elif seed.photo:
            facts.label(text="", icon="IMAGE_DATA")
        facts.prop(seed, "locked", text="", icon="LOCKED" if seed.locked else "UNLOCKED", emboss=False)


class Seeds(Step):
    """The list of seeds"""

    bl_label = "3. Seeds"

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        state = obj.reflcolor
        row = layout.row()
        column = row.column(align=True)
        heads = column.split(factor=_COLOR_SHARE)
        heads.label(text="Color")
        heads = heads.row(align=True)
        heads.label(text="Seed")
        sure = heads.row(align=True)
        sure.ui_units_x = _FACTS_WIDTH + _LOCK_WIDTH
        sure.label(text="Sure")
        column.template_list("REFLCOLOR_UL_seeds", "", state, "seeds", state, "active_seed", rows=4)
        buttons = row.column(align=True)
        buttons.operator("reflcolor.take_seed_tool", text="", icon="ADD")
        buttons.operator("reflcolor.remove_seed", text="", icon="REMOVE")
        buttons.separator()
        buttons.operator("reflcolor.move_seed", text="", icon="ARROW_LEFTRIGHT")
        buttons.operator("reflcolor.clear_seeds", text="", icon="TRASH")
        if 0 <= state.active_seed < len(state.seeds):
            seed = state.seeds[state.active_seed]
            place = label("Row {row}, column {col}", row=seed.row, col=seed.col)
            layout.label(
                text=place if seed.has_color else label("{place}: choose its color", place=place), translate=False
            )
        draw_color(layout, context.scene.reflcolor)
        row = layout.row(align=True)
        for which in ("all", "none", "unsure"):
            row.operator("reflcolor.select_all_seeds", text=label(which.title()), translate=False).which = which
        row.operator("reflcolor.delete_seeds", text="", icon="X")
        row = layout.row(align=True)
        row.operator("reflcolor.load_seeds", icon="FILE_FOLDER")
        row.operator("reflcolor.save_seeds", icon="FILE_TICK")
        if SCANNED in obj.data.color_attributes:
            layout.operator("reflcolor.seeds_from_color", icon="CAMERA_DATA")


class Match(Step):
    """Find seeds in the photos"""

    bl_label = "Find in Photos"
    bl_parent_id = "REFLCOLOR_PT_seeds"

    def draw_header_preset(self, _context):
        REFLCOLOR_PT_match_presets.draw_panel_header(self.layout)

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        layout.prop(settings, "matching")
        if settings.matching == "verified":
            layout.prop(settings, "guess")
        draw_selected(context, layout)
        draw_act(layout, "reflcolor.match_photos", "Match Photos", icon="VIEWZOOM")
        row = layout.row(align=True)
        row.operator("reflcolor.lock_seeds", icon="LOCKED")
        row.operator("reflcolor.lock_seeds", text="Unlock", icon="UNLOCKED").unlock = True
        layout.prop(settings, "show_matches")
        if obj is not None and any(not verdict.verified for verdict in obj.reflcolor.verdicts):
            pairs = sum(seed.reason == "hand" and seed.photo is not None for seed in obj.reflcolor.seeds)
            column = layout.column(align=True)
            column.label(text="Not recognized? Pick 4 to 6 seeds", icon="INFO")
            said = label("with a photo point ({count} so far)", count=pairs)
            column.label(text=said, icon="BLANK1", translate=False)


class Descriptors(Step):
    """How the images are divided and described"""

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


classes = (REFLCOLOR_UL_seeds, *in_both_editors(Seeds), *in_both_editors(Match), *in_both_editors(Descriptors))
