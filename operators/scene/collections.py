"""The collections of a scene that hold what the extension adds to it, apart from what was there."""

import bpy

SCANS, PICTURE = "Laser Scans", "Laser Scan Picture"
# Custom property of collections: their purpose, whatever they are called now.
_PURPOSE = "reflcolor_collection"


def own_collection(context, purpose):
    """Return the collection of the context's scene that was made for a purpose and can be seen; else a new one."""
    for layer in _layers(context.view_layer.layer_collection):
        if layer.collection.get(_PURPOSE) == purpose and layer.is_visible and layer.collection.library is None:
            return layer.collection
    collection = bpy.data.collections.new(purpose)
    collection[_PURPOSE] = purpose
    context.scene.collection.children.link(collection)
    return collection


def _layers(layer):
    for child in layer.children:
        yield child
        yield from _layers(child)
