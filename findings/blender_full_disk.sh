#!/usr/bin/env bash
# Blender says that it wrote a file when the disk was full (bpy 5.2.3).
#
# Instead of a full disk, which needs rights to make one, the process may write at most 2,000 bytes to a file
# (RLIMIT_FSIZE): the system then refuses every further byte, as it does on a full disk. A mesh that needs more is
# exported as .ply, .obj, .stl and .usd and saved as .blend. All five operators return FINISHED and raise nothing. What
# they leave is the first 2,000 bytes of the file.
#
# Seen:
#   ply: ['FINISHED'], 2000 bytes of 75,195
#   obj: ['FINISHED'], 2000 bytes of 171,146
#   stl: ['FINISHED'], 2000 bytes of 149,984
#   usd: ['FINISHED'], 2000 bytes of 145,466
#   blend: ['FINISHED'], 2000 bytes of 127,235
#
# Why it matters: a script that exports hundreds of scans sees no error and goes on. Only a look at the file itself
# tells: its records against its header, its last block, or whether it opens.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 numpy==2.4.6

cd "$folder"
cat >export.py <<'PYTHON'
import os
import resource
import signal

import bpy

LIMIT = 2000
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
mesh = bpy.data.meshes.new("strip")
mesh.from_pydata([(k, k % 2, 0) for k in range(3000)], [], [(k, k + 1, k + 2) for k in range(2998)])
bpy.context.scene.collection.objects.link(bpy.data.objects.new("strip", mesh))
writers = {
    "ply": bpy.ops.wm.ply_export,
    "obj": bpy.ops.wm.obj_export,
    "stl": bpy.ops.wm.stl_export,
    "usd": bpy.ops.wm.usd_export,
    "blend": lambda filepath: bpy.ops.wm.save_as_mainfile(filepath=filepath, copy=True),
}


def written(name, folder):
    path = os.path.abspath(f"{folder}/strip.{name}")
    status = writers[name](filepath=path)
    return sorted(status), os.path.getsize(path)


os.mkdir("room")
os.mkdir("full")
whole = {name: written(name, "room") for name in writers}
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, resource.RLIM_INFINITY))
cut = {name: written(name, "full") for name in writers}
lines = [f"{name}: {cut[name][0]}, {cut[name][1]} bytes of {whole[name][1]:,}" for name in writers]
good = all(
    whole[name][0] == cut[name][0] == ["FINISHED"] and cut[name][1] == LIMIT < whole[name][1] for name in writers
)
with open("seen", "w") as file:
    file.write("\n".join(lines) + "\n")
os._exit(0 if good else 1)
PYTHON
status=0
venv/bin/python export.py >export.log 2>&1 || status=$?
cat seen || cat export.log
exit "$status"
