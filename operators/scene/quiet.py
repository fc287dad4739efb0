"""Writing properties without telling Blender that the object has changed.

Blender answers every change of an object's property by evaluating the object and sending its mesh to the GPU anew. For
a seed, of which the mesh knows nothing, that would stop the window at every click on a large scan.
"""


def write_quietly(group, **values):
    """Write numbers and sequences of numbers into a property group; a choice is written as its number.

    ``group.name = value`` calls the property's update function and marks the object as changed. Blender keeps the
    values of properties in a dictionary; writing there sets the same value and does neither. Until Blender 4.5 the
    dictionary is that of the group's custom properties (``group[name]``), from 5.0 on it is one of its own, which
    ``bl_system_properties_get`` returns.
    """
    stored = group.bl_system_properties_get(do_create=True) if hasattr(group, "bl_system_properties_get") else group
    for name, value in values.items():
        stored[name] = value


def point_to(group, **blocks):
    """Let properties of a group point to data-blocks or None, where they do not yet; there is no quiet way for that."""
    for name, block in blocks.items():
        if getattr(group, name) != block:
            setattr(group, name, block)
