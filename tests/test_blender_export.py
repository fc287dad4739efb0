"""File > Export of colorized scans, in Blender through the installed zip, read by other programs' readers."""

import importlib
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from blender_session import EXTENSION
from colored_scans import tilted_pose, world_points
from gltf_files import Glb, encoded
from plyfile import PlyData
from small_scans import random_scan
from test_blender_import import srgb, write_small_ptx

from reflcolor_addon import read_scans
from reflcolor_addon.scan.grid_mesh import grid_mesh

FAR = (4_500_123.25, -512_345.5, 301.0)
# In a process of its own: the USD that this reads with and the one inside Blender do not mix.
READ_USD = """
import sys
import numpy as np
from pxr import Usd, UsdGeom, UsdShade
stage = Usd.Stage.Open(sys.argv[1])
(mesh,) = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
np.save(sys.argv[2], np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("displayColor").Get()))
"""


@pytest.fixture
def colorized(blender, tmp_path):
    """bpy with a colorized scan far from the origin, and the scan as it was imported."""
    scan = replace(random_scan(3), pose=tilted_pose(FAR))
    path = write_small_ptx(tmp_path / "wall.ptx", scan)
    blender.ops.reflcolor.import_scan(filepath=str(path))
    blender.ops.reflcolor.add_seed(row=0, col=0, color=(0.8, 0.3, 0.1))
    blender.ops.reflcolor.add_seed(row=5, col=9, color=(0.1, 0.4, 0.8))
    blender.ops.reflcolor.colorize()
    (read,) = read_scans(path)
    return blender, read


def exported(bpy, path):
    assert bpy.ops.reflcolor.export_scan(filepath=str(path)) == {"FINISHED"}
    return path


def test_the_scanned_file_itself_is_never_overwritten(colorized, tmp_path):
    bpy, _ = colorized
    before = (tmp_path / "wall.ptx").read_bytes()
    with pytest.raises(RuntimeError, match="is an input, and would be overwritten"):
        bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "wall.ptx"))
    assert (tmp_path / "wall.ptx").read_bytes() == before


def test_a_ply_has_the_colors_to_the_byte_and_the_coordinates_of_the_world(colorized, tmp_path):
    bpy, scan = colorized
    ply = PlyData.read(exported(bpy, tmp_path / "wall.ply"))
    table = ply["vertex"]
    colors = np.stack([table[channel] for channel in ("red", "green", "blue")], axis=1)
    np.testing.assert_array_equal(colors, srgb(bpy.context.active_object, "Colorized"))
    np.testing.assert_allclose(np.stack([table[axis] for axis in "xyz"], axis=1), world_points(scan), atol=1e-5)
    np.testing.assert_array_equal(np.stack([table["grid_row"], table["grid_col"]], axis=1), np.argwhere(scan.valid))
    np.testing.assert_array_equal(np.stack(ply["face"]["vertex_indices"]), grid_mesh(scan).quads)
    assert {"confidence", "nearest_seed", "reflectance", "range"} <= {entry.name for entry in table.properties}


def test_a_glb_has_the_colors_to_the_byte(colorized, tmp_path, gltf_validator):
    bpy, scan = colorized
    path = exported(bpy, tmp_path / "wall.glb")
    glb = Glb(path)
    colors = encoded(glb.attribute("COLOR_0")[:, :3])
    np.testing.assert_array_equal(colors, srgb(bpy.context.active_object, "Colorized"))
    np.testing.assert_allclose(glb.world_points(), world_points(scan), atol=1e-4)
    assert gltf_validator(path)["issues"]["messages"] == []


def test_a_usd_has_the_colors_to_the_byte_and_the_scene_is_as_before(colorized, tmp_path):
    bpy, _ = colorized
    obj = bpy.context.active_object
    before = sorted(obj.data.attributes.keys()), obj.data.color_attributes.active_color_name
    path = exported(bpy, tmp_path / "wall.usd")
    subprocess.run([sys.executable, "-c", READ_USD, path, tmp_path / "rgb.npy"], check=True, timeout=120)
    np.testing.assert_array_equal(encoded(np.load(tmp_path / "rgb.npy").astype(np.float64)), srgb(obj, "Colorized"))
    assert (sorted(obj.data.attributes.keys()), obj.data.color_attributes.active_color_name) == before
    nodes = obj.data.materials[0].node_tree.nodes
    assert [node.attribute_name for node in nodes if node.type == "ATTRIBUTE"] == ["Colorized"]
    assert obj.select_get() and bpy.context.active_object == obj


@pytest.mark.parametrize("suffix", ["ptx", "e57"])
def test_colors_go_back_into_a_scan_file(colorized, tmp_path, suffix):
    bpy, scan = colorized
    (back,) = read_scans(exported(bpy, tmp_path / f"made.{suffix}"))
    np.testing.assert_array_equal(back.color[back.valid], srgb(bpy.context.active_object, "Colorized"))
    # A copy of the PTX that it was imported from; an E57 is made of the mesh, in single precision.
    np.testing.assert_allclose(back.points, scan.points, rtol=0, atol=1e-9 if suffix == "ptx" else 1e-5)
    np.testing.assert_allclose(back.pose, scan.pose, atol=1e-9 if suffix == "ptx" else 1e-3)


def test_what_was_edited_is_exported_as_it_is(colorized, tmp_path):
    bpy, scan = colorized
    obj = bpy.context.active_object
    modifier = obj.modifiers.new("Light", "DECIMATE")
    modifier.ratio = 0.5
    obj.scale = (2, 2, 2)
    ply = PlyData.read(exported(bpy, tmp_path / "wall.ply"))
    assert 0 < len(ply["face"]["vertex_indices"]) < 2 * len(grid_mesh(scan).quads)
    assert {len(face) for face in ply["face"]["vertex_indices"]} <= {3, 4}
    place = np.stack([ply["vertex"][axis] for axis in "xyz"], axis=1) - scan.pose[:3, 3]
    assert np.median(np.linalg.norm(place, axis=1)) > 1.5 * np.median(scan.range)


def test_an_unknown_suffix_and_an_unwritable_folder_are_refused_in_one_line(colorized, tmp_path):
    bpy, _ = colorized
    with pytest.raises(RuntimeError, match=r"wall\.obj: the suffix tells what to write; expected one of \.ply, \.glb"):
        bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "wall.obj"))
    with pytest.raises(RuntimeError, match="cannot be written"):
        bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "missing" / "wall.ply"))


def test_blenders_own_ply_can_be_read_and_is_at_most_a_level_off(colorized, tmp_path):
    bpy, _ = colorized
    bpy.ops.wm.ply_export(filepath=str(tmp_path / "own.ply"), export_colors="SRGB", export_attributes=True)
    table = PlyData.read(tmp_path / "own.ply")["vertex"]
    place = table["grid_row"].astype(int) * 10 + table["grid_col"].astype(int)
    colors = np.stack([table[channel] for channel in ("red", "green", "blue")], axis=1).astype(int)
    assert np.abs(colors - srgb(bpy.context.active_object, "Colorized")[place]).max() <= 1


def test_scans_of_one_file_have_it_read_once_and_esc_ends_that(colorized, monkeypatch):
    bpy, _ = colorized
    module = importlib.import_module(f"{EXTENSION}.operators.scene.colored_scan")
    cancelled = importlib.import_module(f"{EXTENSION}.reflcolor_addon.errors").Cancelled
    files, fingerprint = [], module.fingerprint
    monkeypatch.setattr(module, "fingerprint", lambda path, ask: files.append(path) or fingerprint(path, ask))
    read = module.colored_scans_reader([bpy.context.active_object] * 2)
    assert [scan.source.name for scan in read()] == ["wall.ptx"] * 2 and len(files) == 1
    with pytest.raises(cancelled):
        read(lambda: True)
