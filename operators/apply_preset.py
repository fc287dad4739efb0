"""Set the settings of the colorization to a preset."""

import bpy
from bpy.props import EnumProperty

from ..reflcolor_addon.settings import PRESETS, Settings
from .scene.properties import take_over
from .scene.texts import tip

_DESCRIPTIONS = {
    "Paper": "The method as published",
    "Enhanced": "What measured best on real scans: smoothed reflectance, fewer seeds per pixel, kriging",
}


class REFLCOLOR_OT_apply_preset(bpy.types.Operator):
    """Set alpha, beta and the other settings of the colorization to a preset"""

    bl_idname = "reflcolor.apply_preset"
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(
        name="Preset",
        description="Which settings to take over",
        items=tuple((name, name, _DESCRIPTIONS[name]) for name in PRESETS),
    )

    @classmethod
    def description(cls, _context, properties):
        """Tell of a button what its own preset is."""
        return tip(_DESCRIPTIONS[properties.preset])

    def execute(self, context):
        settings = context.scene.reflcolor
        # How light the colors are is the scan's matter, not the method's.
        take_over(settings, Settings.preset(self.preset, tone=settings.tone))
        return {"FINISHED"}


classes = (REFLCOLOR_OT_apply_preset,)
