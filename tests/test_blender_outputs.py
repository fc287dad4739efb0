"""The files that the command line writes through Blender, read back by other means."""

import json
import subprocess
import sys

import cv2
import numpy as np
import pytest
from gltf_files import encoded
from pxr import Usd, UsdGeom, UsdShade
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import Seeds, Settings, colorize, read_scans
from reflcolor_addon.files.whole import fault_of
from reflcolor_addon.files.writers.ptx import write_ptx

KINDS = ("png", "blend", "usd", "glb", "ply")
READ_BLEND = """
import bpy, json, os, sys
import numpy as np
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
(obj,) = [o for o in bpy.context.scene.objects if o.type == "MESH"]
colors = obj.data.color_attributes
rgba = np.empty(4 * len(obj.data.vertices), np.float32)
colors["Colorized"].data.foreach_get("color_srgb", rgba)
shading = [a.spaces.active.shading for s in bpy.data.screens for a in s.areas if a.type == "VIEW_3D"]
facts = {
    "rgb": np.rint(rgba.reshape(-1, 4)[:, :3] * 255).astype(int).tolist(),
    "active": colors.active_color_name,
    "images": sorted(i.name for i in bpy.data.images if i.packed_file),
    "provenance": json.loads(obj["reflcolor_provenance"])["format"],
    "camera": bpy.context.scene.camera is not None,
    "render_path": bpy.context.scene.render.filepath,
    "shading": sorted({s.color_type for s in shading}),
}
open(sys.argv[2], "w").write(json.dumps(facts))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def results(blender_command, tmp_path_factory):
    """A small scan colorized by the command into every kind of file: (folder, rgb of every vertex)."""
    folder = tmp_path_factory.mktemp("results")
    scan, valid = random_scan(5, (8, 12)), np.ones((8, 12), bool)
    valid[3, 4] = False
    write_ptx(type(scan)(name="wall", points=scan.points, reflectance=scan.reflectance, valid=valid), folder / "w.ptx")
    seeds = Seeds([0, 7, 4], [0, 11, 2], np.array([[220, 60, 30], [30, 90, 200], [60, 180, 60]], np.uint8))
    seeds.save(folder / "seeds.json")
    outputs = [part for suffix in KINDS for part in ("-o", folder / f"wall.{suffix}")]
    done = blender_command(
        *("colorize", folder / "w.ptx", "--seeds", folder / "seeds.json", *outputs),
        *("--render", folder / "render.png", "--report", folder / "report.json"),
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    (read,) = read_scans(folder / "w.ptx")
    return folder, colorize(read, seeds, Settings.preset("Natural")).rgb[read.valid].astype(int)


def test_only_the_results_are_left(results):
    names = {path.name for path in results[0].iterdir()}
    kinds = {f"wall.{suffix}" for suffix in KINDS}
    assert names == kinds | {"w.ptx", "seeds.json", "render.png", "report.json"}


def test_the_blend_holds_the_colors_and_is_ready_to_render(results, tmp_path):
    folder, rgb = results
    script, facts = tmp_path / "read.py", tmp_path / "facts.json"
    script.write_text(READ_BLEND)
    subprocess.run([sys.executable, script, folder / "wall.blend", facts], check=True, capture_output=True, timeout=120)
    read = json.loads(facts.read_text())
    assert np.abs(np.array(read["rgb"]) - rgb).max() <= 1
    assert read["active"] == "Colorized" and read["camera"]
    assert [name.split(" ")[-1] for name in read["images"]] == ["Colorized", "Range", "Reflectance"]
    assert read["provenance"] == "reflcolor-report"
    assert "reflcolor-" not in read["render_path"]
    assert "VERTEX" in read["shading"] and "MATERIAL" not in read["shading"]


def test_the_usd_shows_the_colors_and_keeps_the_attributes(results):
    folder, rgb = results
    (scan,) = read_scans(folder / "w.ptx")
    found = colorize(scan, Seeds.load(folder / "seeds.json"), Settings.preset("Natural"))
    stage = Usd.Stage.Open(str(folder / "wall.usd"))
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    (mesh,) = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    points = np.array(mesh.GetPointsAttr().Get())
    np.testing.assert_allclose(points, scan.points[scan.valid], atol=1e-5)
    shown = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("displayColor")
    assert shown.GetTypeName() == "color3f[]" and shown.GetInterpolation() == "vertex"
    # It is linear.
    np.testing.assert_array_equal(encoded(np.array(shown.Get(), np.float64)), rgb)
    values = {
        name: np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar(name).Get()) for name in ("confidence", "nearest_seed")
    }
    np.testing.assert_allclose(values["confidence"], found.confidence[scan.valid], rtol=1e-5)
    np.testing.assert_array_equal(values["nearest_seed"], found.nearest_seed[scan.valid])


def test_the_surface_of_the_usd_reads_the_colors(results):
    stage = Usd.Stage.Open(str(results[0] / "wall.usd"))
    (mesh,) = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0]
    assert surface.GetIdAttr().Get() == "UsdPreviewSurface"
    reader = UsdShade.Shader(surface.GetInput("diffuseColor").GetConnectedSources()[0][0].source.GetPrim())
    assert reader.GetIdAttr().Get() == "UsdPrimvarReader_float3"
    assert reader.GetInput("varname").Get() == "displayColor"


def test_ply_and_glb_are_written_beside_them(results):
    assert fault_of(results[0] / "wall.ply") is None and fault_of(results[0] / "wall.glb") is None


def test_the_render_shows_the_mesh_large_and_in_its_colors(results):
    folder, rgb = results
    picture = cv2.imread(str(folder / "render.png"))[..., ::-1].astype(int)
    background = picture[0, 0]
    shown = np.abs(picture - background).max(axis=-1) > 12
    rows, cols = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
    assert max(np.ptp(rows) / picture.shape[0], np.ptp(cols) / picture.shape[1]) > 0.85
    assert min(rows[0], cols[0], picture.shape[0] - 1 - rows[-1], picture.shape[1] - 1 - cols[-1]) > 0
    hues = picture[shown] - picture[shown].mean(axis=-1, keepdims=True)
    truth = rgb - rgb.mean(axis=-1, keepdims=True)
    assert np.abs(hues.mean(axis=0) - truth.mean(axis=0)).max() < 20


def test_a_render_with_a_texture_has_its_holes_filled(blender_command, tmp_path):
    valid = np.ones((20, 30), bool)
    valid[8:10, 11] = False
    valid[15, 20] = False
    reflectance = np.tile(np.linspace(0.2, 0.8, 30), (20, 1))
    write_ptx(scan_from_ranges(np.full((20, 30), 3.0), reflectance, valid), tmp_path / "w.ptx")
    Seeds([3, 12], [5, 25], np.array([[220, 60, 30], [30, 90, 200]], np.uint8)).save(tmp_path / "seeds.json")
    done = blender_command(
        *("colorize", tmp_path / "w.ptx", "--seeds", tmp_path / "seeds.json", "--texture", "64"),
        *("-o", tmp_path / "w.png", "--render", tmp_path / "render.png"),
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    picture = cv2.imread(str(tmp_path / "render.png")).astype(int)
    background = (np.abs(picture - picture[0, 0]).max(axis=-1) <= 12).astype(np.uint8)
    assert background.any() and not background.all() and picture[0, 0].max() < 80
    # Each hole would be another part.
    assert cv2.connectedComponents(background)[0] == 2


def test_an_unwritable_place_is_refused_before_the_work(blender_command, results, tmp_path):
    folder, _ = results
    done = blender_command(
        "colorize", folder / "w.ptx", "--seeds", folder / "seeds.json", "-o", tmp_path / "missing" / "a.blend"
    )
    assert done.returncode == 1
    assert "Traceback" not in done.stderr and "missing" in done.stderr.strip().splitlines()[-1]
