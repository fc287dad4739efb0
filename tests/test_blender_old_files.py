"""Files of earlier versions, in Blender through the installed zip."""

import json
from pathlib import Path

import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import srgb, write_small_ptx

OLD = Path(__file__).parent / "old_files"
OLD_NAMES = {"Reflectance_Gray": "Reflectance Gray", "Range_Map": "Range Map", "Scan_Grid": "Scan Grid"}


@pytest.fixture
def old_file(blender, tmp_path):
    """A scan, shown by its range, saved under names with blanks: (bpy, path, gray of its vertices)."""
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    blender.ops.reflcolor.show_look(look="range")
    obj = blender.context.active_object
    gray = srgb(obj, "Reflectance_Gray")
    for present, old in OLD_NAMES.items():
        obj.data.attributes[present].name = old
    nodes, links = obj.data.materials[0].node_tree.nodes, obj.data.materials[0].node_tree.links
    old = nodes.new("ShaderNodeVertexColor")
    old.layer_name = "Reflectance Gray"
    (present,) = (node for node in nodes if node.type == "ATTRIBUTE")
    links.new(old.outputs["Color"], present.outputs["Color"].links[0].to_socket)
    nodes.remove(present)
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    blender.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return blender, tmp_path / "old.blend", gray


def _check(obj, gray):
    assert not set(OLD_NAMES.values()) & set(obj.data.attributes.keys())
    np.testing.assert_array_equal(srgb(obj, "Reflectance_Gray"), gray)
    colors = obj.data.color_attributes
    assert (colors.active_color_name, colors[colors.render_color_index].name) == ("Range_Map", "Reflectance_Gray")
    assert obj.data.uv_layers.active.name == "Scan_Grid"
    nodes = obj.data.materials[0].node_tree.nodes
    assert [node.layer_name for node in nodes if node.type == "VERTEX_COLOR"] == ["Reflectance_Gray"]


def test_a_file_with_the_old_attribute_names_opens_with_the_present_ones(old_file):
    bpy, path, gray = old_file
    bpy.ops.wm.open_mainfile(filepath=str(path))
    (obj,) = (obj for obj in bpy.data.objects if obj.type == "MESH")
    _check(obj, gray)


@pytest.mark.parametrize("link", [False, True], ids=["appended", "linked"])
def test_an_object_of_such_a_file_comes_with_the_present_names(old_file, link):
    bpy, path, gray = old_file
    operator = bpy.ops.wm.link if link else bpy.ops.wm.append
    operator(directory=f"{path}/Object/", filename="wall")
    _check(bpy.data.objects["wall"], gray)


def test_a_file_from_when_paper_was_the_default_keeps_it_and_a_new_one_keeps_what_it_starts_with(blender, tmp_path):
    settings = blender.context.scene.reflcolor
    start = {name: getattr(settings, name) for name in ("light", "alpha", "blend", "kriging")}
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    for handler in blender.app.handlers.save_pre[:]:
        if handler.__module__.endswith("kept_settings"):
            blender.app.handlers.save_pre.remove(handler)
            break
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "new.blend"))
    for name in start:
        settings.property_unset(name)
    settings.alpha = 7
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    blender.app.handlers.save_pre.append(handler)

    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "old.blend"))
    old = blender.context.scene.reflcolor
    assert (old.light, old.alpha, old.blend, old.kriging) == (0, 7, "auto", 0)
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "new.blend"))
    new = blender.context.scene.reflcolor
    assert {name: getattr(new, name) for name in start} == start and new.light == 1


def test_scans_brought_into_a_scene_that_nobody_set_anything_in_are_saved_with_its_settings(blender, tmp_path):
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    blender.ops.scene.new(type="NEW")
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "two.blend"))
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "two.blend"))
    assert [scene.reflcolor.light for scene in blender.data.scenes] == [1, 1]


@pytest.fixture
def of_then(blender):
    """The file that commit b961f62 saved, opened: (bpy, its scan)."""
    blender.ops.wm.open_mainfile(filepath=str(OLD / "wall.blend"))
    (obj,) = (obj for obj in blender.data.objects if obj.type == "MESH")
    return blender, obj


def test_a_file_of_then_opens_with_its_colors_seeds_and_settings(of_then):
    bpy, obj = of_then
    np.testing.assert_array_equal(srgb(obj, "Colorized"), np.load(OLD / "colors.npy"))
    assert [(seed.row, seed.col) for seed in obj.reflcolor.seeds] == [(1, 2), (4, 7)]
    settings = bpy.context.scene.reflcolor
    assert (settings.alpha, settings.beta, settings.color_space, settings.slic_segments) == (7, 2, "cielab", 321)
    assert (settings.light, settings.kriging, settings.blend) == (0, 0, "auto")
    assert json.loads(obj["reflcolor_provenance"])["settings"]["alpha"] == 7


def test_a_file_of_then_colorized_again_has_the_same_colors(of_then):
    bpy, obj = of_then
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    assert bpy.ops.reflcolor.colorize() == {"FINISHED"}
    np.testing.assert_array_equal(srgb(obj, "Colorized"), np.load(OLD / "colors.npy"))


def test_provenance_reads_a_file_of_then(blender_command):
    done = blender_command("provenance", OLD / "wall.blend")
    assert done.returncode == 0 and "wall" in done.stdout, done.stderr


@pytest.mark.parametrize("kind", ["colorize", "match"])
def test_a_preset_of_then_sets_what_it_set(blender, tmp_path, kind):
    preset = tmp_path / "Dark_Halls.py"
    preset.write_bytes((OLD / f"{kind}_preset.txt").read_bytes())
    settings = blender.context.scene.reflcolor
    menu = getattr(blender.types, f"REFLCOLOR_PT_{kind}_presets")
    label = menu.bl_label
    blender.ops.script.execute_preset(filepath=str(preset), menu_idname=menu.__name__)
    menu.bl_label = label
    if kind == "colorize":
        found = settings.alpha, settings.beta, settings.color_space, settings.kriging, settings.light
        assert found == (7, 2, "cielab", 0, 0) and settings.tone == pytest.approx(1.2)
    else:
        assert (settings.matching, settings.slic_segments) == ("verified", 321)
