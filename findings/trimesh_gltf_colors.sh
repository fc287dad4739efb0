#!/usr/bin/env bash
# trimesh takes the lower byte of 16-bit colors in a glTF, and hides vertex colors where there is a material
# (trimesh 5.2.0).
#
# COLOR_0 of a glTF is linear light: floats, or normalized integers of 8 or 16 bits. Three GLB files hold the same 256
# levels, once as floats and once as 16 bits, without a material, and as floats with a material. trimesh.load raises
# nothing.
# - Floats: the linear levels in 8 bits.
# - 16 bits: not scaled to 8 bits but cut to their lower byte. sRGB 64, which is 3360 of 65535 in linear light, becomes
#   32, the remainder of 3360 by 256; neighboring levels jump up and down.
# - With a material: mesh.visual is a texture of one gray; the colors are in visual.vertex_attributes, and gone after
#   Scene.dump().
#
# Seen:
#   floats: sRGB 64, 128, 188 become 13, 55, 128
#   16 bits: sRGB 64, 128, 188 become 32, 66, 189
#   with a material: texture, main color [102, 102, 102, 255], colors in vertex_attributes: True, after dump: False
#
# Why it matters: 16 bits are the smallest form of COLOR_0 that keeps every 8-bit sRGB color. A colored scan written so
# is noise in programs that are built on trimesh; with floats it is only too dark.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6 pillow==12.0.0

cd "$folder"
venv/bin/python - <<'PYTHON'
import json
import struct

import numpy as np
import trimesh

level = np.arange(256) / 255
linear = np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4)
rows, cols = np.divmod(np.arange(256), 16)
points = np.stack([cols, rows, 0 * rows], axis=1).astype("<f4")
first = (16 * np.arange(15)[:, None] + np.arange(15)).ravel()
faces = np.concatenate([np.stack([first, first + 1, first + 17], 1), np.stack([first, first + 17, first + 16], 1)])


def glb(colors, component, material):
    """A GLB of a grid of 256 points with (256, 4) colors."""
    parts = [points, colors, faces.astype("<u4")]
    starts = np.cumsum([0, *(part.nbytes for part in parts)])
    accessors = [
        {"componentType": 5126, "type": "VEC3", "count": 256, "min": [0, 0, 0], "max": [15, 15, 0]},
        {"componentType": component, "type": "VEC4", "count": 256, "normalized": component != 5126},
        {"componentType": 5125, "type": "SCALAR", "count": faces.size},
    ]
    primitive = {"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, **({"material": 0} if material else {})}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [{"bufferView": i, **accessor} for i, accessor in enumerate(accessors)],
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(start), "byteLength": part.nbytes} for start, part in zip(starts, parts)
        ],
        "buffers": [{"byteLength": int(starts[-1])}],
        **({"materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}]} if material else {}),
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(part.tobytes() for part in parts)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def loaded(name, *how):
    """What trimesh loads of such a file: the scene and its mesh."""
    with open(name, "wb") as file:
        file.write(glb(*how))
    scene = trimesh.load(name, process=False)
    (mesh,) = scene.geometry.values()
    return scene, mesh


opaque = np.column_stack([linear, linear, linear, np.ones(256)])
chosen = [64, 128, 188]
floats = loaded("floats.glb", opaque.astype("<f4"), 5126, False)[1].visual.vertex_colors[chosen, 0].tolist()
shorts = loaded("shorts.glb", np.rint(65535 * opaque).astype("<u2"), 5123, False)[1].visual.vertex_colors
scene, mesh = loaded("material.glb", opaque.astype("<f4"), 5126, True)
kept = "color" in mesh.visual.vertex_attributes
dumped = "color" in scene.dump()[0].visual.vertex_attributes
main = mesh.visual.material.main_color.tolist()

print("floats: sRGB 64, 128, 188 become " + ", ".join(map(str, floats)))
print("16 bits: sRGB 64, 128, 188 become " + ", ".join(map(str, shorts[chosen, 0].tolist())))
print(f"with a material: {mesh.visual.kind}, main color {main}, colors in vertex_attributes: {kept}, after dump: {dumped}")
assert floats == np.rint(255 * linear[chosen]).tolist() == [13, 55, 128]
assert shorts[chosen, 0].tolist() == [32, 66, 189]
assert mesh.visual.kind == "texture" and kept and not dumped
PYTHON
