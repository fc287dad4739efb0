"""Several scans of one site through the command line, read back from the files that Blender wrote."""

import json
import subprocess
import sys
from dataclasses import replace

import cv2
import numpy as np
import pytest
from gltf_files import encoded
from pxr import Usd, UsdGeom
from small_scans import random_scan

from reflcolor_addon import Seeds, Settings, colorize, read_scans
from reflcolor_addon.files.writers import write_ptx

READ_BLEND = """
import bpy, json, os, sys
import numpy as np
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
facts = {}
# What a modifier shows in pictures is an object that stands in no scene.
scans = [o for o in bpy.data.objects if o.type == "MESH" and not o.name.endswith(" Shown Surface")]
assert {o.name for o in bpy.context.scene.objects if o.type == "MESH"} == {o.name for o in scans}
for obj in scans:
    rgba = np.empty(4 * len(obj.data.vertices), np.float32)
    obj.data.color_attributes["Colorized"].data.foreach_get("color_srgb", rgba)
    facts[obj.name] = {
        "rgb": np.rint(rgba.reshape(-1, 4)[:, :3] * 255).astype(int).tolist(),
        "pose": [list(row) for row in obj.matrix_world],
        "scan": json.loads(obj["reflcolor_provenance"])["scan"]["name"],
    }
context = bpy.context
facts = {"scans": facts, "active": context.active_object.name, "camera": context.scene.camera is not None}
open(sys.argv[2], "w").write(json.dumps(facts))
sys.stdout.flush()
os._exit(0)
"""
NAMES = ("south", "east")
SHAPE = (8, 12)


@pytest.fixture(scope="module")
def results(blender_command, tmp_path_factory):
    """The folder of two small scans, 90 degrees and a few meters apart, colorized by the command."""
    folder = tmp_path_factory.mktemp("site")
    turned = np.array([[0, -1, 0, 6], [1, 0, 0, -2], [0, 0, 1, 0.5], [0, 0, 0, 1]], float)
    for number, (name, pose) in enumerate(zip(NAMES, (np.eye(4), turned), strict=True)):
        # The first alone has colors of its own: an attribute that the other mesh lacks.
        color = None if number else np.random.default_rng(0).integers(0, 256, (*SHAPE, 3), np.uint8)
        write_ptx(replace(random_scan(number, SHAPE), pose=pose, color=color), folder / f"{name}.ptx")
        Seeds([0, 7], [0, 11], [[220, 60 + 90 * number, 30], [30, 90, 200]]).save(folder / f"{name}.json")
    done = blender_command(
        *("colorize", folder / "south.ptx", folder / "east.ptx", "--seeds", folder / "{scan}.json"),
        *("-o", folder / "site.blend", "-o", folder / "site.usd"),
        *("-o", folder / "one_{scan}.blend", "-o", folder / "{scan}.png"),
        *("--render", folder / "site.png"),
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    return folder


def scan_and_colors(folder, name):
    (scan,) = read_scans(folder / f"{name}.ptx")
    result = colorize(scan, Seeds.load(folder / f"{name}.json"), Settings.preset("Natural"))
    return scan, result.rgb[scan.valid].astype(int)


def read_blend(path, tmp_path):
    script, facts = tmp_path / "read.py", tmp_path / "facts.json"
    script.write_text(READ_BLEND)
    subprocess.run([sys.executable, script, path, facts], check=True, capture_output=True, timeout=120)
    return json.loads(facts.read_text())


def test_only_the_results_are_left(results):
    made = {f"site.{suffix}" for suffix in ("blend", "usd", "png")}
    for name in NAMES:
        made |= {f"{name}.ptx", f"{name}.json", f"{name}.png", f"one_{name}.blend"}
    assert {path.name for path in results.iterdir()} == made


def test_the_blend_holds_every_scan_as_its_own_object_at_its_pose(results, tmp_path):
    found = read_blend(results / "site.blend", tmp_path)
    assert sorted(found["scans"]) == sorted(NAMES)
    assert (found["active"], found["camera"]) == ("south", True)
    for name in NAMES:
        scan, rgb = scan_and_colors(results, name)
        there = found["scans"][name]
        np.testing.assert_allclose(there["pose"], scan.pose, atol=1e-6)
        assert np.abs(np.array(there["rgb"]) - rgb).max() <= 1
        assert there["scan"] == name


def test_a_blend_of_one_scan_holds_nothing_of_the_others(results, tmp_path):
    found = read_blend(results / "one_east.blend", tmp_path)
    scan, rgb = scan_and_colors(results, "east")
    assert list(found["scans"]) == ["east"]
    np.testing.assert_allclose(found["scans"]["east"]["pose"], scan.pose, atol=1e-6)
    assert np.abs(np.array(found["scans"]["east"]["rgb"]) - rgb).max() <= 1


def test_the_usd_holds_every_scan_in_its_place(results):
    stage = Usd.Stage.Open(str(results / "site.usd"))
    meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert sorted(prim.GetParent().GetName() for prim in meshes) == sorted(NAMES)
    for prim in meshes:
        scan, rgb = scan_and_colors(results, prim.GetParent().GetName())
        place = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(prim)).T
        np.testing.assert_allclose(place, scan.pose, atol=1e-5)
        shown = UsdGeom.PrimvarsAPI(prim).GetPrimvar("displayColor").Get()
        np.testing.assert_array_equal(encoded(np.array(shown, np.float64)), rgb)


def test_the_render_is_filled_by_the_first_scan(results):
    picture = cv2.imread(str(results / "site.png")).astype(int)
    shown = np.abs(picture - picture[0, 0]).max(axis=-1) > 12
    rows, cols = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
    assert max(np.ptp(rows) / picture.shape[0], np.ptp(cols) / picture.shape[1]) > 0.8
