"""Bring back the packages that another extension took away."""

import bpy

from .scene import packages, polls
from .scene.texts import tip

_EXTENSION = __package__.rpartition(".")[0]
# The operator has to end before its own class is unregistered.
_WAIT_S = 0.1


class REFLCOLOR_OT_repair(bpy.types.Operator):
    """Disable and enable Reflectance Colorizer: then Blender puts back what another extension took away"""

    bl_idname = "reflcolor.repair"
    bl_label = "Repair"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context):
        return polls.nothing_missing(cls, None if packages.missing() else tip("Nothing is missing"))

    def execute(self, _context):
        bpy.app.timers.register(enable_again, first_interval=_WAIT_S)
        return {"FINISHED"}


def enable_again():
    """Disable and enable the extension: then Blender installs all that it brings along."""
    bpy.ops.preferences.addon_disable(module=_EXTENSION)
    bpy.ops.preferences.addon_enable(module=_EXTENSION)


def unregister():
    """Cancel the scheduled repair."""
    if bpy.app.timers.is_registered(enable_again):
        bpy.app.timers.unregister(enable_again)


classes = (REFLCOLOR_OT_repair,)
