"""Step 4: colorize, and step 5: compare with the truth."""

from ..operators.scene import polls
from ..operators.scene.properties import scene_picture
from ..operators.scene.render import lacks_surface
from ..operators.scene.scan_object import is_light
from ..operators.scene.seed_list import seeds_are_few_and_picked
from ..operators.scene.setting_properties import COLORIZE_NAMES, active_preset
from ..operators.scene.texts import label
from ..operators.window import live_update
from ..reflcolor_addon.settings import PRESETS
from .presets import REFLCOLOR_PT_colorize_presets
from .step import Step, draw_act, draw_selected, in_both_editors, in_view

# What is shown at once; all other settings are under Advanced.
_FIRST = ("light", "alpha", "beta", "tone")
# Above this share of the light from a few picked colors, the detail of the reflectance hardly shows.
_FLAT_LIGHT = 0.7


class Colorize(Step):
    """Spread the colors"""

    bl_label = "4. Colorize"

    def draw_header_preset(self, _context):
        REFLCOLOR_PT_colorize_presets.draw_panel_header(self.layout)

    def draw_step(self, context, layout, obj):
        settings = context.scene.reflcolor
        row, active = layout.row(align=True), active_preset(settings)
        for preset in PRESETS:
            shown = preset == active
            row.operator("reflcolor.apply_preset", text=label(preset), translate=False, depress=shown).preset = preset
        column = layout.column()
        for name in _FIRST:
            column.prop(settings, name)
            if name == "light" and settings.light > _FLAT_LIGHT and seeds_are_few_and_picked(obj):
                column.label(text="Looks flat? Lower it for detail", icon="INFO")
        row = layout.row()
        # Split, a button would have its text beside it.
        row.use_property_split = False
        row.prop(context.window_manager.reflcolor, "live_update", toggle=True, icon="FILE_REFRESH")
        if live_update.message():
            layout.label(text=live_update.message(), icon="ERROR", translate=False)
        draw_selected(context, layout)
        row = layout.row()
        row.scale_y = 1.5
        draw_act(row, "reflcolor.colorize", "Colorize", icon="COLOR")
        draw_act(layout, "reflcolor.make_texture", "Make Texture", icon="TEXTURE")
        draw_act(layout, "reflcolor.make_light_mesh", "Make Light Mesh", icon="MOD_DECIM")
        column = layout.column()
        column.row().prop(settings, "picture_look", expand=True)
        column.prop(settings, "picture_filled")
        row = column.row()
        row.active = settings.picture_filled
        row.prop(settings, "picture_drop_mixed")
        row = layout.row(align=True)
        draw_act(row, "reflcolor.set_up_render", "Set Up Render", icon="OUTLINER_OB_CAMERA")
        row.operator("render.render", text="Render", icon="RENDER_STILL")
        if lacks_surface(context.scene, scene_picture(context.scene)):
            layout.label(text="Set Up Render again to show this", icon="INFO")
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
        elif not is_light(obj) and not any(scan.reflcolor.seeds for scan in polls.scan_objects(context)):
            layout.label(text="Needs seeds", icon="INFO")


class Advanced(Step):
    """The other settings of the colorization"""

    bl_label = "Advanced"
    bl_parent_id = "REFLCOLOR_PT_colorize"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, _obj):
        settings = context.scene.reflcolor
        for name in COLORIZE_NAMES:
            if name == "neighbors":
                layout.row().prop(settings, name, expand=True)
            elif name not in _FIRST and (name != "nearest" or settings.blend == "nearest"):
                layout.prop(settings, name)


class Evaluate(Step):
    """Compare the colors with true ones"""

    bl_label = "5. Evaluate"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_step(self, context, layout, obj):
        if obj is None:
            layout.label(text="Needs a scan", icon="INFO")
            return
        layout.prop(obj.reflcolor, "truth_image")
        layout.operator("reflcolor.evaluate", icon="VIEWZOOM")


classes = (*in_both_editors(Colorize), *in_both_editors(Advanced), in_view(Evaluate))
