"""A scan's object as it is seen, ready to be written as a mesh: with what was edited, and with its modifiers."""

import re
from contextlib import contextmanager

import numpy as np

from ...reflcolor_addon.errors import ScanError
from ...reflcolor_addon.scan.mesh_surface import MeshSurface, split_at_seams
from .scan_object import CENTER, SHIFT, UV_MAP, shown_in_renders

_DTYPES = {"FLOAT": np.float32, "INT": np.int32}


def surface_of_object(context, obj, *, textured=False):
    """Return the MeshSurface of a scan's object, with the colors that renders show.

    It is in meters, with the kilometers that were taken off the scene added again. Where it is to be ``textured``, it
    has a place on the image for every vertex; a vertex with several places is there once for each.

    Raises
    ------
    ScanError
        If the mesh has not one color per vertex any more.
    """
    meters = context.scene.unit_settings.scale_length
    center = np.array(obj.data.get(CENTER, (0, 0, 0)), np.float64)
    pose = np.array(obj.matrix_world, np.float64)
    shift = np.array(obj.get(SHIFT, (0, 0, 0)), np.float64)
    pose[:3, 3] = pose[:3, 3] * meters + shift - pose[:3, :3] @ center
    with _evaluated(context, obj) as mesh:
        faces, triangles = _faces(mesh)
        points, rgb, values = _values(mesh.vertices, "co", np.float32, 3), _colors(mesh, obj), _attributes(mesh)
        placed = {}
        if textured:
            split = _split(mesh, triangles)
            points, rgb = points[split.vertex], rgb[split.vertex]
            values = {name: array[split.vertex] for name, array in values.items()}
            faces, triangles = [split.triangles], split.triangles
            placed = {"uv": split.uv, "same": split.same}
        return MeshSurface(
            name=obj.name,
            shape=(obj.reflcolor.rows, obj.reflcolor.cols),
            pose=pose,
            center=center,
            points=points.astype(np.float64) * meters + center,
            rgb=rgb,
            values=values,
            faces=faces,
            triangles=triangles,
            **placed,
        )


@contextmanager
def _evaluated(context, obj):
    evaluated = obj.evaluated_get(context.evaluated_depsgraph_get())
    try:
        yield evaluated.to_mesh()
    finally:
        evaluated.to_mesh_clear()


def _values(items, name, dtype, width=1):
    values = np.empty(len(items) * width, dtype)
    items.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def _colors(mesh, obj):
    name = shown_in_renders(obj)
    attribute = mesh.color_attributes.get(name)
    if attribute is None or attribute.domain != "POINT":
        raise ScanError(
            "{object}: the mesh has no color attribute {name} with one color per vertex", object=obj.name, name=name
        )
    rgba = _values(attribute.data, "color_srgb", np.float32, 4)
    return np.rint(np.clip(rgba[:, :3], 0, 1) * 255).astype(np.uint8)


def _attributes(mesh):
    """Numbers of the vertices, by names that are legal in every format."""
    return {
        re.sub(r"\W", "_", attribute.name, flags=re.ASCII): _values(
            attribute.data, "value", _DTYPES[attribute.data_type]
        )
        for attribute in mesh.attributes
        if attribute.domain == "POINT" and attribute.data_type in _DTYPES and not attribute.name.startswith(".")
    }


def _faces(mesh):
    """Faces, an array for each number of corners, and the triangles that they are cut into."""
    starts, counts = (_values(mesh.polygons, name, np.int32) for name in ("loop_start", "loop_total"))
    corners = _values(mesh.loops, "vertex_index", np.int32)
    faces = [corners[starts[counts == count][:, None] + np.arange(count)] for count in np.unique(counts).tolist()]
    mesh.calc_loop_triangles()
    return faces, _values(mesh.loop_triangles, "vertices", np.int32, 3)


def _split(mesh, triangles):
    """The vertices of a mesh, once for each of their places on its image."""
    corners = _values(mesh.loop_triangles, "loops", np.int32, 3)
    uv = _values(mesh.uv_layers[UV_MAP].uv, "vector", np.float32, 2)[corners]
    return split_at_seams(len(mesh.vertices), triangles, uv)
