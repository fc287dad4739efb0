"""Set the settings of the colorization to a preset."""

import bpy
from bpy.props import EnumProperty

from ..reflcolor_addon.settings import PRESETS, Settings
from .scene.setting_properties import take_over
from .scene.texts import tip


class REFLCOLOR_OT_apply_preset(bpy.types.Operator):
    """Set alpha, beta and the other settings of the colorization to a preset"""

    bl_idname = "reflcolor.apply_preset"
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(
        name="Preset",
        description="Which settings to take over",
        items=tuple((name, name, preset.help) for name, preset in PRESETS.items()),
    )

    @classmethod
    def description(cls, _context, properties):
        """The tooltip of a button: what its preset is for."""
        return tip(PRESETS[properties.preset].help)

    def execute(self, context):
        take_over(context.scene.reflcolor, Settings.preset(self.preset))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_apply_preset,)
