"""Keep settings of the scene as the user's own presets, the way Blender does."""

import bpy
from bl_operators.presets import AddPresetBase

from .scene.setting_properties import COLORIZE_NAMES, MATCH_NAMES


class _AddPreset(AddPresetBase):
    """The attributes that Blender's base class expects, made from the names of the settings."""

    preset_defines = ["settings = bpy.context.scene.reflcolor"]


class REFLCOLOR_OT_add_colorize_preset(_AddPreset, bpy.types.Operator):
    """Keep the settings of the colorization as a preset, or remove a preset"""

    bl_idname = "reflcolor.add_colorize_preset"
    bl_label = "Add Colorize Preset"
    preset_menu = "REFLCOLOR_PT_colorize_presets"
    preset_subdir = "reflcolor/colorize"
    preset_values = [f"settings.{name}" for name in COLORIZE_NAMES]


class REFLCOLOR_OT_add_match_preset(_AddPreset, bpy.types.Operator):
    """Keep the settings of the search in photos as a preset, or remove a preset"""

    bl_idname = "reflcolor.add_match_preset"
    bl_label = "Add Match Preset"
    preset_menu = "REFLCOLOR_PT_match_presets"
    preset_subdir = "reflcolor/match"
    preset_values = [f"settings.{name}" for name in MATCH_NAMES]


classes = (REFLCOLOR_OT_add_colorize_preset, REFLCOLOR_OT_add_match_preset)
