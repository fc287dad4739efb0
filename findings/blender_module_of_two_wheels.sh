#!/usr/bin/env bash
# Two extensions bundle wheels of different names that hold the same module: disabling one takes the module away from
# the other; while both are enabled, both get the module of the one that was enabled last (bpy 5.2.3).
#
# `opencv-python` and `opencv-python-headless` are such a pair: both are `cv2`. Here two small wheels stand for them,
# "shared_part" 1.0 and "shared_part_full" 2.0, which both hold the module `shared_part`. Two extensions bundle one of
# them each. They are installed and enabled one after the other; then the second is disabled.
#
# Seen:
#   first enabled: shared_part 1.0, known as shared_part 1.0
#   second enabled, too: shared_part 2.0, known as shared_part 1.0 and shared_part_full 2.0
#   second disabled: no shared_part, known as shared_part 1.0
#   first disabled and enabled again: shared_part 1.0, known as shared_part 1.0
#
# Why it matters: Blender keeps the contents of all wheels in one folder, and keeps count of them by their names, not by
# their files. An extension that was not touched lacks its module from the next start on, though its wheel is still
# listed as installed; and while both are enabled, one of them works with a version that it did not bundle. Of two
# wheels of the same name, Blender keeps the newer one until the last of the extensions is disabled.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.2.3 numpy==2.4.6

cd "$folder"
cat >extensions.py <<'PYTHON'
import os
import zipfile
from pathlib import Path

HERE = Path.cwd()
os.environ["BLENDER_USER_RESOURCES"] = str(HERE / "user")

import bpy

MANIFEST = """schema_version = "1.0.0"
id = "{id}"
version = "1.0.0"
name = "{id}"
tagline = "Bundles a wheel"
maintainer = "nobody"
type = "add-on"
blender_version_min = "4.5.0"
license = ["SPDX:GPL-3.0-or-later"]
wheels = ["./wheels/{wheel}"]
"""


def wheel(name, version):
    about = f"{name}-{version}.dist-info"
    files = {
        "shared_part/__init__.py": f"version = {version!r}\n",
        f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n",
        f"{about}/WHEEL": "Wheel-Version: 1.0\nGenerator: hand\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    files[f"{about}/RECORD"] = "".join(f"{path},,\n" for path in [*files, f"{about}/RECORD"])
    path = HERE / f"{name}-{version}-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as file:
        for inside, text in files.items():
            file.writestr(inside, text)
    return path


def install(extension, wheel_path):
    path = HERE / f"{extension}.zip"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("blender_manifest.toml", MANIFEST.format(id=extension, wheel=wheel_path.name))
        file.writestr("__init__.py", "def register():\n    pass\n\n\ndef unregister():\n    pass\n")
        file.write(wheel_path, f"wheels/{wheel_path.name}")
    bpy.ops.extensions.package_install_files(filepath=str(path), repo="user_default", enable_on_install=True)


def tell(when):
    (packages,) = (HERE / "user").glob("extensions/.local/lib/python*/site-packages")
    module = packages / "shared_part" / "__init__.py"
    found = f"shared_part {module.read_text().split(chr(39))[1]}" if module.is_file() else "no shared_part"
    known = sorted(path.name.removesuffix(".dist-info").replace("-", " ") for path in packages.glob("*.dist-info"))
    print(f"seen: {when}: {found}, known as {' and '.join(known)}")


bpy.ops.wm.read_factory_settings(use_empty=True)
install("first", wheel("shared_part", "1.0"))
tell("first enabled")
install("second", wheel("shared_part_full", "2.0"))
tell("second enabled, too")
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.second")
tell("second disabled")
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.first")
bpy.ops.preferences.addon_enable(module="bl_ext.user_default.first")
tell("first disabled and enabled again")
PYTHON
venv/bin/python extensions.py >log 2>&1 || { cat log; exit 1; }
sed -n 's/^seen: //p' log | tee seen
diff seen - <<'EXPECTED'
first enabled: shared_part 1.0, known as shared_part 1.0
second enabled, too: shared_part 2.0, known as shared_part 1.0 and shared_part_full 2.0
second disabled: no shared_part, known as shared_part 1.0
first disabled and enabled again: shared_part 1.0, known as shared_part 1.0
EXPECTED
echo "as expected"
