"""The object of a scan's light mesh: to be shown and exported, and no more a scan to work on."""

import numpy as np
from mathutils import Matrix

from ...reflcolor_addon.scan.grid_mesh import MAX_INCIDENCE_DEG
from ...reflcolor_addon.scan.object_arrays import local_coordinates, on_grid
from .add_scan import add_scan_object
from .photo_texture import show_texture
from .provenance import copy_records
from .scan_object import (
    CENTER,
    CONFIDENCE,
    ERROR,
    GUESSED,
    IMAGE_OF,
    LIGHT,
    NEAREST_SEED,
    OBSERVED,
    PHOTO,
    SHOWN_IN_RENDERS,
    add_colors,
    add_values,
    colors_of,
    grid_indices,
    show_colors,
    shown_in_renders,
    values_of,
)
from .viewpoint import keep_view

_KNOWN = {CONFIDENCE: np.float32, NEAREST_SEED: np.int32, OBSERVED: np.float32, PHOTO: np.int32, ERROR: np.float32}


def known_of(obj):
    """Return (H, W, 3) uint8 colors and (H, W) numbers, each by its attribute's name, that a scan's object has.

    Raises
    ------
    ScanError
        As `grid_indices` and `colors_of`.
    """
    place, shape = grid_indices(obj), (obj.reflcolor.rows, obj.reflcolor.cols)
    attributes = obj.data.attributes
    names = {shown_in_renders(obj), *(name for name in SHOWN_IN_RENDERS if name in attributes)}
    colors = {name: on_grid(colors_of(obj, name), place, shape) for name in sorted(names)}
    values = {
        name: on_grid(values_of(obj, name, dtype), place, shape) for name, dtype in _KNOWN.items() if name in attributes
    }
    return colors, values


def add_light_object(context, light, colors, values, texture, *, shown, units_per_meter=1.0):
    """Make the object of a LightMesh, select it and make it active.

    Parameters
    ----------
    context : bpy.types.Context
    light : LightMesh
    colors : dict of (H, W, 3) uint8
        sRGB of the scan's pixels, by the names of color attributes.
    values : dict of (H, W) float or int
        What else is known of them, by the names of attributes.
    texture : (h, w, 3) uint8, bytes, or bpy.types.Image
        What is shown, laid over the scan's grid; see `show_texture`.
    shown : str
        Of the colors, those that are shown where the texture is not.
    units_per_meter : float
        Blender's units in a meter.
    """
    arrays = light.object_arrays(units_per_meter=units_per_meter, max_incidence_deg=MAX_INCIDENCE_DEG)
    obj = add_scan_object(context, arrays)
    obj.data[LIGHT] = int(light.scan.valid.sum())
    own = light.own
    for name, rgb in colors.items():
        add_colors(obj, name, light.at_vertices(rgb)[:own])
    for name, at_vertices in light.values(values).items():
        add_values(obj, name, at_vertices[:own])
    show_colors(obj, shown)
    show_texture(obj, texture)
    obj.data[IMAGE_OF] = shown
    keep_view(obj, local_coordinates(light.scan, arrays.center, units_per_meter))
    return obj


def add_light_copy(context, obj, light, colors, values, texture):
    """Make the object of the light mesh of a scan's object, where that is, and hide the latter.

    Parameters
    ----------
    context : bpy.types.Context
    obj : bpy.types.Object
    light : LightMesh
    colors, values
        From `known_of`.
    texture
        As `add_light_object`.
    """
    meters = context.scene.unit_settings.scale_length
    copy = add_light_object(
        context, light, colors, values, texture, shown=shown_in_renders(obj), units_per_meter=1 / meters
    )
    moved = (np.array(copy.data[CENTER]) - np.array(obj.data[CENTER])) / meters
    copy.matrix_world = obj.matrix_world @ Matrix.Translation(moved)
    copy_records(obj, copy)
    if GUESSED in obj:
        copy[GUESSED] = True
    obj.hide_set(True)
    obj.hide_render = True
    return copy
