"""Saves settings that nobody changed as well, so that a file keeps them when the defaults change.

Blender saves a property only once it was set. A file from the time when Paper was the default therefore has no values
for Paper's settings, and gets them when it is opened.
"""

import bpy
from bpy.app.handlers import persistent

from ...reflcolor_addon.settings import DEFAULT_PRESET, FORMER_DEFAULT_PRESET, Settings
from .setting_properties import take_over


def keep_settings(preset, scenes):
    """Give every setting of these scenes that has no value yet the value of a preset."""
    for scene in scenes:
        take_over(scene.reflcolor, Settings.preset(preset), unset_only=True)


def _scenes_of_scans():
    """The file's own scenes, if it holds scans: other files stay as they are."""
    if not any(obj.reflcolor.rows for obj in bpy.data.objects):
        return []
    return [scene for scene in bpy.data.scenes if scene.library is None]


@persistent
def _file_is_saved(_path):
    keep_settings(DEFAULT_PRESET, _scenes_of_scans())


@persistent
def _file_was_loaded(_path):
    keep_settings(FORMER_DEFAULT_PRESET, _scenes_of_scans())


handlers = (
    (bpy.app.handlers.save_pre, _file_is_saved),
    (bpy.app.handlers.load_post, _file_was_loaded),
)
