"""What the extension can do in Blender: one act per file."""

import bpy

from . import (
    add_preset,
    add_seed,
    apply_preset,
    clear_seeds,
    close_seed_picking,
    colorize,
    command,
    copy_notice,
    copy_provenance,
    delete_picked,
    delete_seeds,
    drag,
    drop_color,
    evaluate,
    export_scan,
    import_scan,
    keep_gray,
    leave_preview,
    load_photo,
    load_seeds,
    lock_seeds,
    match_photos,
    move_seed,
    open_reflectance,
    open_seed_picking,
    pick,
    pick_color,
    pick_in_view,
    place_seed,
    read_notice,
    remove_photo,
    remove_seed,
    save_seeds,
    select_all_seeds,
    select_region,
    select_seed,
    set_up_render,
    show_look,
    show_notice,
    simulate,
    step_back,
)
from .overlays import draw_seeds, wipe, wipe_handle
from .scene import attribute_names, images, properties
from .window import drop_files, jobs, live_update, pointer, tools

_MODULES = (
    properties,
    import_scan,
    open_reflectance,
    load_photo,
    remove_photo,
    add_seed,
    move_seed,
    remove_seed,
    clear_seeds,
    load_seeds,
    save_seeds,
    match_photos,
    apply_preset,
    add_preset,
    colorize,
    evaluate,
    show_look,
    copy_provenance,
    show_notice,
    read_notice,
    copy_notice,
    drop_files,
    wipe,
    simulate,
    export_scan,
    leave_preview,
    place_seed,
    pick_color,
    keep_gray,
    drop_color,
    select_seed,
    select_all_seeds,
    select_region,
    delete_seeds,
    lock_seeds,
    pick,
    drag,
    pick_in_view,
    open_seed_picking,
    close_seed_picking,
    set_up_render,
    step_back,
    delete_picked,
)
# What draws, listens or stands in a toolbar, with register() and unregister() of its own.
_SERVICES = (attribute_names, draw_seeds, live_update, tools, wipe, wipe_handle)
_undo = []


def register():
    for module in _MODULES:
        for cls in module.classes:
            bpy.utils.register_class(cls)
            _undo.append((bpy.utils.unregister_class, cls))
    for owner, cls in (
        (bpy.types.Object, properties.ReflcolorScan),
        (bpy.types.Scene, properties.ReflcolorSettings),
        (bpy.types.WindowManager, leave_preview.ReflcolorWindow),
    ):
        owner.reflcolor = bpy.props.PointerProperty(type=cls, override={"LIBRARY_OVERRIDABLE"})
        _undo.append((_delete_property, owner))
    for menu, module in (
        (bpy.types.TOPBAR_MT_file_import, import_scan),
        (bpy.types.TOPBAR_MT_file_export, export_scan),
        (bpy.types.TOPBAR_MT_file_export, simulate),
    ):
        menu.append(module.draw_menu)
        _undo.append((menu.remove, module.draw_menu))
    for service in _SERVICES:
        service.register()
        _undo.append((_unregister, service))
    _undo.append((bpy.utils.unregister_cli_command, bpy.utils.register_cli_command("reflcolor", command.run)))


def unregister():
    jobs.stop_all()
    pointer.stop_all()
    images.forget_pixels()
    while _undo:
        take_off, thing = _undo.pop()
        take_off(thing)


def _delete_property(owner):
    del owner.reflcolor


def _unregister(service):
    service.unregister()
