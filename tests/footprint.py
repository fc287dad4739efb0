"""What an extension can leave behind in Blender, as plain values to compare."""


def footprint(bpy) -> dict:
    """Everything that code has registered in Blender by now: each kind with its names, sorted."""
    classes = {name: getattr(bpy.types, name) for name in dir(bpy.types)}
    # Only data-blocks and what hangs in the window manager can be given properties that are not of a class itself.
    owners = [cls for cls in classes.values() if isinstance(cls, type) and issubclass(cls, _property_owners(bpy))]
    return {
        "types": sorted(classes),
        "properties": sorted(f"{cls.__name__}.{prop.identifier}" for cls in owners for prop in cls.bl_rna.properties),
        "draw functions": sorted(
            f"{name}.draw: {_place(function)}"
            for name, cls in classes.items()
            for function in getattr(getattr(cls, "draw", None), "_draw_funcs", ())
            # Blender lists a class's own function once another one was added, and leaves it listed.
            if function.__qualname__ != f"{name}.draw"
        ),
        "handlers": sorted(
            f"{kind}: {_place(function)}"
            for kind in dir(bpy.app.handlers)
            if isinstance(handlers := getattr(bpy.app.handlers, kind), list)
            for function in handlers
        ),
        "keymap items": sorted(
            f"{keymap.name}: {item.idname} {item.to_string()}"
            for keymap in bpy.context.window_manager.keyconfigs.addon.keymaps
            for item in keymap.keymap_items
        ),
        "driver functions": sorted(bpy.app.driver_namespace),
    }


def _property_owners(bpy) -> tuple[type, ...]:
    return (bpy.types.ID, bpy.types.Bone, bpy.types.PoseBone, bpy.types.ViewLayer)


def _place(function) -> str:
    return f"{function.__module__}.{function.__qualname__}"
