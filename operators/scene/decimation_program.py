"""Run by `decimation` in a Blender of its own. Arguments: a folder with the mesh, and the number of faces."""

import os
import sys
from pathlib import Path

import bpy
import numpy as np

_FIXED = "fixed"


def main(folder, faces):
    """Read a mesh from a folder, make it lighter, and write the result there."""
    coordinates, corners, sizes, fixed = (
        np.load(folder / f"{name}.npy", allow_pickle=False) for name in ("coordinates", "corners", "sizes", "fixed")
    )
    mesh = bpy.data.meshes.new("mesh")
    mesh.vertices.add(len(coordinates))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(sizes))
    mesh.attributes["position"].data.foreach_set("vector", coordinates.ravel())
    mesh.attributes[".corner_vert"].data.foreach_set("value", corners)
    mesh.polygons.foreach_set("loop_start", (np.cumsum(sizes) - sizes).astype(np.int32))
    mesh.update(calc_edges=True)
    obj = bpy.data.objects.new("object", mesh)
    bpy.context.scene.collection.objects.link(obj)
    modifier = obj.modifiers.new("light", "DECIMATE")
    modifier.ratio = faces / int((sizes - 2).sum())
    modifier.use_collapse_triangulate = True
    if len(fixed):
        obj.vertex_groups.new(name=_FIXED).add(fixed.tolist(), 1.0, "REPLACE")
        # Edges at vertices without weight are left alone.
        modifier.vertex_group, modifier.invert_vertex_group = _FIXED, True
        modifier.vertex_group_factor = 1.0
    light = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    vertices = np.empty(3 * len(light.vertices), np.float32)
    light.attributes["position"].data.foreach_get("vector", vertices)
    triangles = np.empty(len(light.loops), np.int32)
    light.attributes[".corner_vert"].data.foreach_get("value", triangles)
    np.save(folder / "light_vertices.npy", vertices.reshape(-1, 3), allow_pickle=False)
    np.save(folder / "light_triangles.npy", triangles.reshape(-1, 3), allow_pickle=False)


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    main(Path(arguments[0]), int(arguments[1]))
    # Blender may hang at its end.
    os._exit(0)
