#!/usr/bin/env bash
# Turning off Use Tiling does not turn off Cycles' tiles (bpy 5.2.3).
#
# The factory scene is rendered on the processor at 256 x 256 pixels with a Tile Size of 64, once with Use Tiling and
# once without. The status that Cycles gives to the handlers of render_stats counts the same 16 tiles in both. Only a
# Tile Size that is as large as the picture gives one piece.
#
# Seen:
#   use_auto_tile True, tile_size 64: 16 tiles
#   use_auto_tile False, tile_size 64: 16 tiles
#   use_auto_tile False, tile_size 2048: no tiles
#
# Why it matters: finished tiles are files in the temporary folder. Where that folder is full or gone, a render with
# tiles fails, and trying again with Use Tiling off fails in the same way. Set the Tile Size instead.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 numpy==2.4.6

cd "$folder"
cat >render.py <<'PYTHON'
import re

import bpy

bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 1
scene.render.resolution_x = scene.render.resolution_y = 256
scene.render.resolution_percentage = 100
said = []
bpy.app.handlers.render_stats.append(lambda text, *_: said.append(text))
for use, side in ((True, 64), (False, 64), (False, 2048)):
    scene.cycles.use_auto_tile, scene.cycles.tile_size = use, side
    said.clear()
    bpy.ops.render.render()
    found = {int(count) for count in re.findall(r"/(\d+) Tiles", " ".join(said))}
    print(f"use_auto_tile {use}, tile_size {side}: {f'{max(found)} tiles' if found else 'no tiles'}")
PYTHON
venv/bin/python render.py >render.log 2>&1 || { cat render.log; exit 1; }
grep '^use_auto_tile' render.log >seen
cat seen
cat >expected <<'EXPECTED'
use_auto_tile True, tile_size 64: 16 tiles
use_auto_tile False, tile_size 64: 16 tiles
use_auto_tile False, tile_size 2048: no tiles
EXPECTED
diff seen expected
echo "as expected"
