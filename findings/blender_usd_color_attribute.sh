#!/usr/bin/env bash
# Blender's USD exporter writes vertex colors but leaves the material gray (bpy 5.2.3, usd-core 26.11).
#
# A mesh has a color attribute, and a material whose Color Attribute node feeds Base Color of the Principled BSDF: the
# way to show vertex colors in Blender. bpy.ops.wm.usd_export with its default settings, which convert materials to the
# USD Preview Surface, writes the colors as primvars:Color, and a preview surface whose diffuseColor is a constant gray of
# 0.8 and is connected to nothing. There is no displayColor either. No warning is given.
#
# Seen:
#   primvars: Color
#   diffuseColor: (0.8, 0.8, 0.8), not connected
#   displayColor: none
#
# Why it matters: a colored scan opens in every other program as a gray one, though its colors are in the file. A
# UsdPrimvarReader_float3 that reads the primvar has to be added to the file and connected.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 numpy==2.4.6 usd-core==26.11

cd "$folder"
venv/bin/python - >export.log 2>&1 <<'PYTHON' || { cat export.log; exit 1; }
import os

import bpy
import numpy as np

bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
mesh = bpy.data.meshes.new("square")
mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
colors = mesh.color_attributes.new("Color", "BYTE_COLOR", "POINT")
colors.data.foreach_set("color_srgb", np.tile(np.float32([0.5, 0.25, 0.75, 1]), 4))
mesh.color_attributes.active_color_name = "Color"
mesh.color_attributes.render_color_index = 0
material = bpy.data.materials.new("colored")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
attribute = nodes.new("ShaderNodeVertexColor")
attribute.layer_name = "Color"
links.new(attribute.outputs["Color"], surface.inputs["Base Color"])
mesh.materials.append(material)
bpy.context.scene.collection.objects.link(bpy.data.objects.new("square", mesh))
assert bpy.ops.wm.usd_export(filepath=os.path.abspath("square.usd")) == {"FINISHED"}
os._exit(0)
PYTHON

venv/bin/python - <<'PYTHON'
from pxr import Usd, UsdGeom, UsdShade

stage = Usd.Stage.Open("square.usd")
mesh = next(prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
shader, _, _ = material.ComputeSurfaceSource()
diffuse = shader.GetInput("diffuseColor")
names = [primvar.GetPrimvarName() for primvar in UsdGeom.PrimvarsAPI(mesh).GetAuthoredPrimvars()]
connected = diffuse.HasConnectedSource()
shown = tuple(round(float(value), 3) for value in diffuse.Get())
print("primvars:", ", ".join(name for name in names if name != "st"))
print(f"diffuseColor: {shown}, {'connected' if connected else 'not connected'}")
print("displayColor:", "written" if "displayColor" in names else "none")
assert shader.GetIdAttr().Get() == "UsdPreviewSurface"
assert "Color" in names and "displayColor" not in names
assert shown == (0.8, 0.8, 0.8) and not connected
PYTHON
