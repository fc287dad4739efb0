"""What .blend files hold: python -m benchmarks.blend_contents FILE...

Prints JSON: for each file a hash of the names and places of its objects, and of every array of its meshes and images.
The bytes of a .blend differ from run to run, these do not. Runs in the bpy of the environment.
"""

import hashlib
import json
import sys

import numpy as np

# What an attribute of each type is read by, with its NumPy type and how many of these an element has.
_READ = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "INT16_2D": ("value", np.int32, 2),
}


def main():
    import bpy

    found = {}
    for path in sys.argv[1:]:
        bpy.ops.wm.open_mainfile(filepath=path)
        found[path] = _hashed(bpy.data)
    print(json.dumps(found))


def _hashed(data):
    digest = hashlib.sha256()

    def add(name, values):
        digest.update(f"{name} {values.dtype} {values.shape}".encode())
        digest.update(values.tobytes())

    for thing in data.objects:
        add(f"object {thing.name} {thing.type}", np.array(thing.matrix_world, np.float32))
    for mesh in data.meshes:
        for name, things, key in (
            ("corners", mesh.loops, "vertex_index"),
            ("faces", mesh.polygons, "loop_start"),
        ):
            values = np.empty(len(things), np.int32)
            things.foreach_get(key, values)
            add(f"{mesh.name} {name}", values)
        for attribute in mesh.attributes:
            key, kind, each = _READ[attribute.data_type]
            values = np.empty(len(attribute.data) * each, kind)
            attribute.data.foreach_get(key, values)
            add(f"{mesh.name} {attribute.name} {attribute.domain}", values)
    for image in data.images:
        values = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(values)
        add(f"image {image.name}", values)
    return digest.hexdigest()


if __name__ == "__main__":
    main()
