"""The menus of the user's own presets, in the headers of the steps."""

import bpy
from bl_ui.utils import PresetPanel

from ..operators.add_preset import REFLCOLOR_OT_add_colorize_preset, REFLCOLOR_OT_add_match_preset


class REFLCOLOR_PT_colorize_presets(PresetPanel, bpy.types.Panel):
    """Presets of the settings of the colorization"""

    bl_label = "Colorize Presets"
    preset_subdir = REFLCOLOR_OT_add_colorize_preset.preset_subdir
    preset_operator = "script.execute_preset"
    preset_add_operator = REFLCOLOR_OT_add_colorize_preset.bl_idname

    @staticmethod
    def reset_cb(context, _filepath):
        """Presets that were kept before there was such a setting do not name it: the light was the reflectance's."""
        context.scene.reflcolor.light = 0


class REFLCOLOR_PT_match_presets(PresetPanel, bpy.types.Panel):
    """Presets of the settings of the search in photos"""

    bl_label = "Match Presets"
    preset_subdir = REFLCOLOR_OT_add_match_preset.preset_subdir
    preset_operator = "script.execute_preset"
    preset_add_operator = REFLCOLOR_OT_add_match_preset.bl_idname


classes = (REFLCOLOR_PT_colorize_presets, REFLCOLOR_PT_match_presets)
