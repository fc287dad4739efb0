"""Writing properties without telling Blender that the object has changed.

Blender answers every change of an object's property by evaluating the object and sending its mesh to the GPU anew. For
a seed, of which the mesh knows nothing, that would stop the window at every click on a large scan.
"""


def write_quietly(group, **values):
    """Write values into a property group: numbers, sequences of numbers, data-blocks or None.

    A choice is written as its number. Neither the object's evaluation nor the properties' own update functions follow.
    """
    stored = group.bl_system_properties_get(do_create=True) if hasattr(group, "bl_system_properties_get") else group
    for name, value in values.items():
        if value is not None:
            stored[name] = value
        elif name in stored:
            del stored[name]
