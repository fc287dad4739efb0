"""What the extension shows: the steps in the 3D View's sidebar."""

import bpy

from . import sidebar

_registered = []


def register():
    for cls in sidebar.classes:
        bpy.utils.register_class(cls)
        _registered.append(cls)


def unregister():
    while _registered:
        bpy.utils.unregister_class(_registered.pop())
