#!/usr/bin/env bash
# Blender's PLY exporter darkens byte colors, turns whole numbers into floats, and writes names that readers refuse
# (bpy 5.2.3, plyfile 1.1.5, meshio 5.3.5).
#
# A mesh has one vertex for each of the 256 levels of gray, as a color attribute of bytes, and an attribute of whole
# numbers called "my value". bpy.ops.wm.ply_export with export_colors="SRGB" and export_attributes=True reports
# FINISHED and writes:
# - colors that went from bytes to linear light and back and were then truncated, not rounded: most levels are one too
#   dark. Exported and imported again and again, a picture gets darker each time.
# - the whole numbers as floats of 32 bits, so that 16777217 becomes 16777216.
# - the line "property float my value". Names in a PLY have no spaces: plyfile and meshio refuse the file.
#
# Seen:
#   170 of 256 levels are one too dark, the others right
#   16777217 is written as 1.6777216e+07
#   plyfile: PlyHeaderParseError: line 12: expected "property {type} {name}"
#   meshio: KeyError: 'float my'
#
# Why it matters: PLY is the usual way to hand colored scans to other programs. Colors that were measured arrive
# changed, indices (of a seed, a photo, a segment) arrive as others, and some files cannot be opened at all.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 plyfile==1.1.5 meshio==5.3.5 numpy==2.4.6

cd "$folder"
venv/bin/python - >export.log 2>&1 <<'PYTHON' || { cat export.log; exit 1; }
import os

import bpy
import numpy as np

bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
levels = np.arange(256)
mesh = bpy.data.meshes.new("levels")
mesh.from_pydata([(level, 0, 0) for level in levels], [], [(k, k + 1, k + 2) for k in range(254)])
colors = mesh.color_attributes.new("Color", "BYTE_COLOR", "POINT")
rgba = np.ones((256, 4), np.float32)
rgba[:, :3] = levels[:, None] / 255
colors.data.foreach_set("color_srgb", rgba.ravel())
held = np.empty(4 * 256, np.float32)
colors.data.foreach_get("color_srgb", held)
assert (np.rint(255 * held.reshape(-1, 4)[:, 0]) == levels).all()
mesh.color_attributes.active_color_name = "Color"
numbers = mesh.attributes.new("my value", "INT", "POINT")
numbers.data.foreach_set("value", np.full(256, 16777217, np.int32))
bpy.context.scene.collection.objects.link(bpy.data.objects.new("levels", mesh))
done = bpy.ops.wm.ply_export(
    filepath=os.path.abspath("levels.ply"), export_colors="SRGB", export_attributes=True, ascii_format=True
)
assert done == {"FINISHED"}
os._exit(0)
PYTHON

venv/bin/python - <<'PYTHON'
from pathlib import Path

import meshio
import plyfile

header, _, body = Path("levels.ply").read_text().partition("end_header\n")
names = [line.split(maxsplit=2)[2] for line in header.splitlines() if line.startswith("property") and "list" not in line]
rows = [dict(zip(names, line.split(), strict=True)) for line in body.splitlines()[:256]]
off = [int(row["red"]) - level for level, row in enumerate(rows)]
print(f"{off.count(-1)} of 256 levels are one too dark, the others right")
assert (off.count(-1), off.count(0)) == (170, 86)
number = rows[0]["my value"]
print(f"16777217 is written as {number}")
assert "property float my value\n" in header and float(number) == 16777216

for module, read in ((plyfile, plyfile.PlyData.read), (meshio, meshio.read)):
    try:
        read("levels.ply")
    except Exception as error:
        print(f"{module.__name__}: {type(error).__name__}: {error}")
    else:
        raise AssertionError(f"{module.__name__} reads it")
PYTHON
