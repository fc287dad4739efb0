"""What the extension can do in Blender: one act per file."""

import bpy

from . import (
    add_seed,
    apply_preset,
    clear_seeds,
    colorize,
    command,
    copy_provenance,
    evaluate,
    import_scan,
    jobs,
    load_photo,
    load_seeds,
    match_photos,
    move_seed,
    open_reflectance,
    properties,
    remove_photo,
    remove_seed,
    save_seeds,
    show_look,
    simulate,
)

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
    colorize,
    evaluate,
    show_look,
    copy_provenance,
    simulate,
)
_undo = []


def register():
    for module in _MODULES:
        for cls in module.classes:
            bpy.utils.register_class(cls)
            _undo.append((bpy.utils.unregister_class, cls))
    for owner, cls in ((bpy.types.Object, properties.ReflcolorScan), (bpy.types.Scene, properties.ReflcolorSettings)):
        owner.reflcolor = bpy.props.PointerProperty(type=cls)
        _undo.append((_delete_property, owner))
    for menu, module in ((bpy.types.TOPBAR_MT_file_import, import_scan), (bpy.types.TOPBAR_MT_file_export, simulate)):
        menu.append(module.draw_menu)
        _undo.append((menu.remove, module.draw_menu))
    _undo.append((bpy.utils.unregister_cli_command, bpy.utils.register_cli_command("reflcolor", command.run)))


def unregister():
    jobs.stop_all()
    while _undo:
        take_off, thing = _undo.pop()
        take_off(thing)


def _delete_property(owner):
    del owner.reflcolor
