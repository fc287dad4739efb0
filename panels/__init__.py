"""What the extension shows: the steps in the sidebars of the 3D View and the Image Editor."""

import bpy

from ..operators.overlays import legend
from . import (
    colorize,
    compare,
    images,
    looking,
    menus,
    messages,
    presets,
    provenance,
    scan,
    seeds,
    status_bar,
    translations,
)

# In the order that they are drawn in.
_MODULES = (scan, images, seeds, colorize, messages, compare, looking, provenance, menus, presets)
# What draws or stands in menus, with register() and unregister() of its own.
_SERVICES = (legend, menus, status_bar, translations)
_registered = []


def register():
    for module in _MODULES:
        for cls in module.classes:
            bpy.utils.register_class(cls)
            _registered.append(cls)
    for service in _SERVICES:
        service.register()


def unregister():
    for service in reversed(_SERVICES):
        service.unregister()
    while _registered:
        bpy.utils.unregister_class(_registered.pop())
