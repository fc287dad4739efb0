"""A Blender in which another extension has taken away a package that ours brought along."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What Blender 5.2 leaves of OpenCV when an extension that brings opencv-python is disabled: nothing (findings/).
TAKE_AWAY = """
import shutil, sys
from pathlib import Path
sys.path.insert(0, {tools!r})
import blender_session
resources = Path({resources!r})
blender_session.start(Path({zip!r}), resources)
installed = next(resources.glob("extensions/.local/lib/python*/site-packages/cv2"))
shutil.rmtree(installed)
blender_session.end(0)
"""
# In the next process, as after the next start of Blender.
NEXT = """
import importlib, sys
from pathlib import Path
sys.path.insert(0, {tools!r})
import blender_session
bpy = blender_session.start(Path({zip!r}), Path({resources!r}))
here = lambda name: importlib.import_module(blender_session.EXTENSION + "." + name)
print("PANEL", bpy.types.REFLCOLOR_PT_scan.bl_label, here("operators.scene.packages").missing())
print("STATUS", here("operators.command").run(["info", {scan!r}]))
print("STATUS", here("operators.command").run(["colorize", {scan!r}, "--seeds", {seeds!r}, "-o", {out!r}]))
try:
    bpy.ops.reflcolor.import_scan(filepath={scan!r})
except RuntimeError as error:
    print("TOLD", error)
here("operators.repair").enable_again()
here("operators.scene.packages")._seen = (0.0, ())
print("AGAIN", here("operators.scene.packages").missing(), bpy.ops.reflcolor.import_scan(filepath={scan!r}))
blender_session.end(0)
"""


def test_without_opencv_the_extension_stands_says_so_and_mends_itself(extension_zip, tmp_path):
    places = {
        "tools": str(ROOT / "tools"),
        "zip": str(extension_zip),
        "resources": str(tmp_path / "blender"),
        "scan": str(ROOT / "examples" / "cones" / "cones.scan.json"),
        "seeds": str(ROOT / "examples" / "cones" / "cones.seeds.json"),
        "out": str(tmp_path / "out.png"),
    }

    def run(script):
        line = [sys.executable, "-c", script.format(**places)]
        return subprocess.run(line, capture_output=True, text=True, timeout=120, check=False)

    assert run(TAKE_AWAY).returncode == 0
    done = run(NEXT)
    said = done.stdout + done.stderr
    told = "OpenCV is missing: another extension took it away; disable and enable Reflectance Colorizer"
    assert "PANEL 1. Scan ('OpenCV',)" in said, said
    assert "STATUS 1" in said and f"error: {told}" in said, said
    assert f"TOLD Error: {told}" in said, said
    assert "AGAIN () {'FINISHED'}" in said, said
    assert "Traceback" not in said, said
