"""Colored scans into a binary glTF 2.0, straight from their arrays."""

import json
import struct
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from ...errors import Cancelled, OutputError
from ...messages import Message
from ...progress import IsCancelled, Progress
from ...scan.georeference import origin_shift
from ...scan.mesh_surface import MeshSurface
from ...scan.rotations import quaternion
from ...scan.surface import ScanSurface
from ...srgb import srgb8_to_linear
from ...version import __version__
from ..atomic import written_atomically

_LARGEST = 2**32 - 1
_FLOAT, _INDEX = 5126, 5125
_ARRAY, _ELEMENTS = 34962, 34963
_POINTS, _TRIANGLES = 0, 4
_HEADER = 12
_CHUNK_HEADER = 8
# Room for the JSON document; a scan's part of it is far smaller.
_JSON_PER_SCAN = 8192
# What a colorization adds to a surface without one.
_MORE_VALUES = 4
_TO_Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
_ROTATION_TOLERANCE = 1e-7
# Floats, not normalized integers: trimesh takes only the lower byte of 16 bits.
_LINEAR = srgb8_to_linear(np.arange(256)).astype("<f4")


def check_glb_size(surfaces, path, *, textures=None, faces=None):
    """Raise OutputError if the surfaces do not fit into a GLB, which ends at 4 GiB.

    Faces are only counted where the answer depends on it. Surfaces may be without their colors yet, and have more than
    the ``faces`` that each is to have.
    """
    most = _LARGEST if faces is None else faces
    textures = textures or [None] * len(surfaces)
    size = _glb_bytes(surfaces, textures, lambda surface: 2 * surface.vertex_count, most)
    if size > _LARGEST:
        size = _glb_bytes(surfaces, textures, lambda surface: surface.triangle_count, most)
    if size > _LARGEST:
        raise OutputError(
            "{path}: would have {size:.1f} GiB, and a GLB holds at most 4 GiB; make the mesh lighter with --faces, or "
            "write .ply or .blend",
            path=path,
            size=size / 2**30,
        )


def _glb_bytes(surfaces, textures, triangles, most):
    """About how many bytes a GLB of surfaces has, with ``triangles(surface)`` triangles, or if those are more, most."""
    size = 0
    for surface, texture in zip(surfaces, textures, strict=True):
        values = len(surface.value_types) + (0 if surface.has_colors else _MORE_VALUES)
        # Position, normal and color; a vertex in no face is listed by its index.
        vertices, faces = min(surface.vertex_count, most), min(triangles(surface), most)
        size += vertices * (12 + 12 + 12 + 4 * values + 4) + faces * 12
        size += len(texture or b"") + _JSON_PER_SCAN
    return size


def write_glb(
    surfaces: Sequence[ScanSurface | MeshSurface],
    path: PathLike | str,
    *,
    textures: Sequence[bytes | None] | None = None,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> None:
    """Write colored scans into a GLB: a node for each, in meters, Y up.

    A node stands where the scanner stood, whole kilometers taken off as in Blender's scene; the extra
    ``reflcolor_shift`` of the scene says how much. ``COLOR_0`` is linear light, as glTF has it, in single
    precision, from which every 8-bit sRGB color comes back exactly; values are attributes ``_NAME``. Returns that are
    in no face are points.

    Parameters
    ----------
    surfaces : sequence of ScanSurface or MeshSurface
    path : path-like
    textures : sequence of bytes or None, optional
        A PNG or JPEG file for each surface, laid over the scan's grid; instead of ``COLOR_0``, which glTF would
        multiply with it. The surface must be made with ``split_seam``.
    progress, cancelled : callable, optional
        As `write_ply`.

    Raises
    ------
    OutputError
        If the file would have more than 4 GiB, or cannot be written.
    Cancelled
        If ``cancelled()`` returned True.

    Examples
    --------
    >>> from reflcolor_addon import ScanSurface, Seeds, colorize, read_scans, write_glb
    >>> scan = read_scans("garage.ptx")[0]
    >>> result = colorize(scan, Seeds([1], [2], [[200, 80, 40]]))
    >>> write_glb([ScanSurface(scan, result.rgb, result.values)], "garage.glb")
    """
    path = Path(path)
    textures = textures or [None] * len(surfaces)
    check_glb_size(surfaces, path, textures=textures)
    document = _Document()
    shift = None
    for surface, texture in zip(surfaces, textures, strict=True):
        pose, center = surface.pose, surface.center
        shift = origin_shift(pose[:3, :3] @ center + pose[:3, 3], shift)
        document.add(surface, _Placement(pose, center, shift), texture)
    if cancelled and cancelled():
        raise Cancelled
    with written_atomically(path) as temporary, temporary.open("wb") as file:
        document.write(
            file, _WriteProgress(progress, cancelled, Message("Writing {name}", name=path.name), document.size)
        )


class _WriteProgress:
    """Reports the progress of writing, and cancels it on request."""

    def __init__(self, progress, cancelled, text, whole):
        self._progress, self._cancelled, self._text, self._whole, self._done = progress, cancelled, text, whole, 0

    def __call__(self, size):
        if self._cancelled and self._cancelled():
            raise Cancelled
        self._done += size
        if self._progress:
            self._progress(min(1.0, self._done / self._whole), self._text)


class _Placement:
    """Where a node is, and its points relative to it, with Y up.

    A node can be turned and moved. A pose that also scales, shears, or is printed with few digits is put into the
    points themselves.
    """

    def __init__(self, pose, center, shift):
        matrix = pose[:3, :3]
        turns = np.abs(matrix @ matrix.T - np.eye(3)).max() < _ROTATION_TOLERANCE and np.linalg.det(matrix) > 0
        self._center = center
        self._matrix = _TO_Y_UP if turns else _TO_Y_UP @ matrix
        self._to_normals = np.linalg.inv(self._matrix)
        self.mirrored = np.linalg.det(self._matrix) < 0
        self.shift = shift
        w, *xyz = quaternion(_TO_Y_UP @ matrix @ _TO_Y_UP.T) if turns else (1.0, 0.0, 0.0, 0.0)
        self.rotation = [float(number) for number in (*xyz, w)]
        self.translation = (_TO_Y_UP @ (matrix @ center + pose[:3, 3] - shift)).tolist()

    def points(self, points):
        """(N, 3) float32 of (N, 3) float64 in the scanner's frame."""
        return _product(points - self._center, self._matrix.T).astype("<f4")

    def normals(self, normals):
        """(N, 3) float32 of unit length, of normals in the scanner's frame."""
        turned = _product(normals.astype(np.float64), self._to_normals)
        return (turned / np.sqrt(np.einsum("ij,ij->i", turned, turned))[:, None]).astype("<f4")


def _product(vectors, matrix):
    """(N, 3) times (3, 3), in a fixed order of additions: a library's product may differ in the last digit."""
    x, y, z = vectors.T
    return np.stack([x * matrix[0, i] + y * matrix[1, i] + z * matrix[2, i] for i in range(3)], axis=1)


class _Document:
    """The JSON of a glTF, and what goes into its binary part."""

    def __init__(self):
        self._nodes, self._meshes, self._materials, self._textures, self._images = [], [], [], [], []
        self._views, self._accessors = [], []
        self._writers = []
        self.size = 0

    def add(self, surface, placement, texture):
        """Add the node of a surface, to be written later."""
        loose = sum(len(block) for block in surface.loose_blocks())
        attributes = {
            "POSITION": self._accessor(surface.vertex_count, "VEC3", **_limits(surface, placement)),
            "NORMAL": self._accessor(surface.vertex_count, "VEC3"),
        }
        if texture is None:
            attributes["COLOR_0"] = self._accessor(surface.vertex_count, "VEC3")
        else:
            attributes["TEXCOORD_0"] = self._accessor(surface.vertex_count, "VEC2")
        for name in surface.value_types:
            attributes[f"_{name.upper()}"] = self._accessor(surface.vertex_count, "SCALAR")
        shared = {"attributes": attributes, "material": len(self._materials)}
        primitives = []
        for mode, count in ((_TRIANGLES, 3 * surface.triangle_count), (_POINTS, loose)):
            if count:
                indices = self._accessor(count, "SCALAR", _INDEX, _ELEMENTS)
                primitives.append({**shared, "indices": indices, "mode": mode})
        self._writers.append((surface, placement, attributes, [primitive["indices"] for primitive in primitives]))
        rows, columns = surface.shape
        node = {"name": surface.name, "mesh": len(self._meshes), "translation": placement.translation}
        if placement.rotation[:3] != [0, 0, 0]:
            node["rotation"] = placement.rotation
        self._nodes.append({**node, "extras": {"reflcolor_rows": rows, "reflcolor_columns": columns}})
        self._meshes.append({"name": surface.name, "primitives": primitives})
        self._materials.append(self._material(surface.name, texture))
        self._shift = placement.shift

    def write(self, file, written):
        """Write it to an open binary file; ``written(bytes)`` is called for every piece."""
        text = json.dumps(self._content(), ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        start = _HEADER + _CHUNK_HEADER + len(text) + _CHUNK_HEADER
        file.write(struct.pack("<4sII", b"glTF", 2, start + self.size))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", self.size, b"BIN\0"))
        # The length of every part is known, so each can be written to its place.
        file.truncate(start + self.size)
        places = [start + view["byteOffset"] for view in self._views]

        def put(accessor, values):
            view = self._accessors[accessor]["bufferView"]
            file.seek(places[view])
            file.write(values)
            places[view] += values.nbytes
            written(values.nbytes)

        for surface, placement, attributes, indices in self._writers:
            _put_vertices(surface, placement, attributes, put)
            _put_faces(surface, placement, indices, put)
        for image in self._images:
            file.seek(places[image["bufferView"]])
            file.write(image["data"])

    def _accessor(self, count, kind, component=_FLOAT, target=_ARRAY, **more):
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]
        view = self._view(4 * count * width, target=target)
        self._accessors.append({"bufferView": view, "componentType": component, "count": count, "type": kind, **more})
        return len(self._accessors) - 1

    def _view(self, size, **more):
        self._views.append({"buffer": 0, "byteOffset": self.size, "byteLength": size, **more})
        self.size += size + -size % 4
        return len(self._views) - 1

    def _material(self, name, texture):
        surface = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
        if texture is not None:
            kind = "image/png" if texture.startswith(b"\x89PNG") else "image/jpeg"
            surface["baseColorTexture"] = {"index": len(self._textures)}
            self._textures.append({"sampler": 0, "source": len(self._images)})
            self._images.append(
                {"bufferView": self._view(len(texture)), "mimeType": kind, "name": name, "data": texture}
            )
        return {"name": name, "doubleSided": True, "pbrMetallicRoughness": surface}

    def _content(self):
        content = {
            "asset": {"version": "2.0", "generator": f"Reflectance Colorizer {__version__}"},
            "scene": 0,
            "scenes": [
                {"nodes": list(range(len(self._nodes))), "extras": {"reflcolor_shift": self._shift.tolist()}},
            ],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": self._materials,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": self.size}],
        }
        if self._images:
            content["images"] = [
                {key: image[key] for key in ("bufferView", "mimeType", "name")} for image in self._images
            ]
            # Linear, repeated to the right for the faces across a full turn's seam.
            content["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 33071}]
            content["textures"] = self._textures
        return content


def _limits(surface, placement):
    """Least and greatest coordinates, which glTF asks for."""
    low, high = np.full(3, np.inf, np.float32), np.full(3, -np.inf, np.float32)
    for block in surface.vertex_blocks():
        if len(block.points):
            points = placement.points(block.points)
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    return {"min": low.tolist(), "max": high.tolist()}


def _put_vertices(surface, placement, attributes, put):
    for block, normals in zip(surface.vertex_blocks(), surface.normal_blocks(), strict=True):
        put(attributes["POSITION"], placement.points(block.points))
        put(attributes["NORMAL"], placement.normals(normals))
        if "COLOR_0" in attributes:
            put(attributes["COLOR_0"], _LINEAR[block.rgb])
        else:
            put(attributes["TEXCOORD_0"], block.uv.astype("<f4"))
        for name, values in block.values.items():
            put(attributes[f"_{name.upper()}"], values.astype("<f4"))


def _put_faces(surface, placement, indices, put):
    indices = list(indices)
    if surface.triangle_count:
        accessor = indices.pop(0)
        for triangles in surface.triangle_blocks():
            put(accessor, (triangles[:, ::-1] if placement.mirrored else triangles).astype("<u4"))
    if indices:
        for loose in surface.loose_blocks():
            put(indices[0], loose.astype("<u4"))
