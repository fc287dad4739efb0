#!/usr/bin/env bash
# Cycles' adaptive sampling ends after 16, 32 or 48 samples, whatever Min Samples says (bpy 5.2.3).
#
# The factory scene is rendered with at most 64 samples and a Noise Threshold of 1, which every pixel reaches at once.
# Samples come from a table, so that a picture of 64 samples that ends early is the same, bit for bit, as one of the
# number of samples that it really took, with adaptive sampling off. Min Samples from 1 to 14 end after 16 samples. From
# 15 on they end after a later multiple of 16: 15 and 16 take 32.
#
# Seen:
#   Min Samples 1: 16 samples taken
#   Min Samples 8: 16 samples taken
#   Min Samples 14: 16 samples taken
#   Min Samples 15: 32 samples taken
#   Min Samples 16: 32 samples taken
#   Min Samples 32: 48 samples taken
#
# Why it matters: a picture of 16 samples or fewer gains nothing from adaptive sampling, and Min Samples of 15 instead of
# 14 doubles the time where little noise is left.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 numpy==2.4.6

cd "$folder"
cat >render.py <<'PYTHON'
import os

import bpy
import numpy as np

bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
scene.render.resolution_x = scene.render.resolution_y = 64
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
scene.render.filepath = os.path.abspath("picture.exr")
scene.cycles.use_denoising = False
scene.cycles.sampling_pattern = "TABULATED_SOBOL"
scene.cycles.adaptive_threshold = 1.0


def picture(samples, least=None):
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = samples, least is not None
    scene.cycles.adaptive_min_samples = least or 0
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(64 * 64 * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.tobytes()


taken = {picture(samples): samples for samples in (*range(1, 21), 24, 28, 31, 32, 33, 40, 48, 56, 64)}
for least in (1, 8, 14, 15, 16, 32):
    print(f"Min Samples {least}: {taken.get(picture(64, least), 'another number of')} samples taken")
PYTHON
venv/bin/python render.py >render.log 2>&1 || { cat render.log; exit 1; }
grep '^Min Samples' render.log >seen
cat seen
cat >expected <<'EXPECTED'
Min Samples 1: 16 samples taken
Min Samples 8: 16 samples taken
Min Samples 14: 16 samples taken
Min Samples 15: 32 samples taken
Min Samples 16: 32 samples taken
Min Samples 32: 48 samples taken
EXPECTED
diff seen expected
echo "as expected"
