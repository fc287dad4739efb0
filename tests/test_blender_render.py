"""Set Up Render: a camera that shows the scan, and light."""

import importlib
import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon.files.writers.ptx import write_ptx


def import_scan(blender, folder, scan):
    write_ptx(scan, folder / "scan.ptx")
    blender.ops.reflcolor.import_scan(filepath=str(folder / "scan.ptx"))
    return blender.context.active_object


def seen_by_camera(blender, obj):
    """(N, 2) places of the vertices in the camera's picture, 0..1, and (N,) their depths."""
    from bpy_extras.object_utils import world_to_camera_view

    blender.context.view_layer.update()
    scene = blender.context.scene
    seen = np.array([world_to_camera_view(scene, scene.camera, obj.matrix_world @ v.co) for v in obj.data.vertices])
    return seen[:, :2], seen[:, 2]


def test_the_camera_has_all_of_a_narrow_scan_in_its_picture(blender, tmp_path):
    scan = random_scan(1, (20, 30))
    scan.pose[:3, 3] = 3, -4, 1
    obj = import_scan(blender, tmp_path, scan)
    blender.ops.reflcolor.set_up_render()
    seen, depth = seen_by_camera(blender, obj)
    camera = blender.context.scene.camera
    assert seen.min() >= 0 and seen.max() <= 1
    assert np.ptp(seen, axis=0).min() > 0.9
    assert camera.data.clip_start < depth.min() and depth.max() < camera.data.clip_end
    np.testing.assert_allclose(camera.location, scan.pose[:3, 3], atol=1e-5)


def test_the_camera_is_the_same_when_set_up_in_edit_mode(blender, tmp_path):
    import_scan(blender, tmp_path, random_scan())
    places = []
    for mode in ("OBJECT", "EDIT"):
        blender.ops.object.mode_set(mode=mode)
        blender.ops.reflcolor.set_up_render()
        places.append(tuple(blender.context.scene.camera.location))
    assert places[0] == places[1]


def test_the_camera_looks_down_at_a_scan_all_around(blender, tmp_path):
    scan = scan_from_ranges(np.full((12, 72), 4.0), np.zeros((12, 72)), azimuth_deg=360)
    obj = import_scan(blender, tmp_path, scan)
    blender.ops.reflcolor.set_up_render()
    seen, _ = seen_by_camera(blender, obj)
    assert seen.min() >= 0 and seen.max() <= 1
    assert blender.context.scene.camera.location.z > 4


@pytest.mark.parametrize("scale_length", [1.0, 0.01])
def test_what_was_set_up_before_makes_room(blender, tmp_path, scale_length):
    blender.context.scene.unit_settings.scale_length = scale_length
    import_scan(blender, tmp_path, random_scan())
    blender.context.scene.reflcolor.picture_look = "lit"
    for _ in range(2):
        blender.ops.reflcolor.set_up_render()
        added = [other.type for other in blender.data.objects if other.type != "MESH"]
        assert added == ["CAMERA"]
    assert math.degrees(blender.context.scene.camera.data.angle) < 100


@pytest.fixture
def startup_scan(blender, tmp_path):
    """Blender's startup file, cube, lamp and camera included, with a scan."""
    blender.ops.wm.read_homefile(use_factory_startup=True)
    import_scan(blender, tmp_path, random_scan())
    return blender


def test_pictures_show_the_scans_and_nothing_else(startup_scan):
    scene = startup_scan.context.scene
    before, world = set(scene.objects), scene.world
    startup_scan.ops.reflcolor.set_up_render()
    assert [obj.name for obj in scene.objects if not obj.hide_render and obj.type != "CAMERA"] == ["scan"]
    assert before <= set(scene.objects)
    assert scene.camera not in before
    # A world that nothing uses would not be saved.
    assert world.use_fake_user


def test_what_a_person_left_out_of_renders_stays_so(startup_scan):
    scan = startup_scan.context.active_object
    scan.hide_render = True
    startup_scan.ops.reflcolor.set_up_render()
    assert scan.hide_render


@pytest.mark.parametrize("look", ["archive", "lit"])
def test_the_output_that_exporters_read_stays_as_it_is(startup_scan, look):
    nodes = startup_scan.context.active_object.active_material.node_tree.nodes
    startup_scan.context.scene.reflcolor.picture_look = look
    for _ in range(2):
        startup_scan.ops.reflcolor.set_up_render()
    outputs = [node for node in nodes if node.type == "OUTPUT_MATERIAL"]
    assert sorted(output.target for output in outputs) == ["ALL", "CYCLES", "EEVEE"]
    (active,) = [output for output in outputs if output.is_active_output]
    assert active.target == "ALL"
    assert active.inputs["Surface"].links[0].from_node.type == "BSDF_PRINCIPLED"


def test_colors_of_the_archive_look_are_exactly_those_of_the_scan(startup_scan, tmp_path):
    startup_scan.ops.reflcolor.set_up_render()
    scene, obj = startup_scan.context.scene, startup_scan.context.active_object
    levels = np.full((len(obj.data.vertices), 4), [200, 120, 40, 255], np.float32) / 255
    obj.data.color_attributes["Reflectance_Gray"].data.foreach_set("color_srgb", levels.ravel())
    scene.render.resolution_percentage, scene.cycles.samples = 10, 1
    scene.render.filepath = str(tmp_path / "picture.png")
    startup_scan.ops.render.render(write_still=True)
    picture = cv2.imread(scene.render.filepath)[..., ::-1].reshape(-1, 3)
    values, counts = np.unique(picture, axis=0, return_counts=True)
    assert [200, 120, 40] in values[np.argsort(counts)[-2:]].tolist()


def test_a_rendered_picture_has_the_same_bytes_each_time(startup_scan, tmp_path):
    render = importlib.import_module(f"{EXTENSION}.operators.scene.render").render
    startup_scan.ops.reflcolor.set_up_render()
    settings = startup_scan.context.scene.render
    settings.resolution_percentage, settings.filepath = 5, "kept"
    for name in ("one.png", "other.png"):
        render(startup_scan.context, tmp_path / name)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "other.png").read_bytes()
    assert b"tEXt" not in (tmp_path / "one.png").read_bytes() and settings.filepath == "kept"
    assert cv2.imread(str(tmp_path / "one.png")).std() > 0


# The surface that pictures show


def shown(blender, obj):
    """The mesh of an object as a render shows it, with the modifier on."""
    modifier = obj.modifiers["Shown Surface"]
    modifier.show_viewport = modifier.show_render
    return obj.evaluated_get(blender.context.evaluated_depsgraph_get()).data


def values(mesh, name):
    found = np.zeros(len(mesh.attributes[name].data), np.int32)
    mesh.attributes[name].data.foreach_get("value", found)
    return found


def color_values(mesh, name):
    found = np.zeros(4 * len(mesh.vertices), np.float32)
    mesh.color_attributes[name].data.foreach_get("color_srgb", found)
    return np.rint(found.reshape(-1, 4)[:, :3] * 255).astype(int)


@pytest.fixture
def holed(blender, tmp_path):
    """Blender with a wall of 20 x 30 pixels that has a hole, its render set up; and the mesh as it was imported."""
    valid = np.ones((20, 30), bool)
    valid[8:10, 11] = False
    obj = import_scan(blender, tmp_path, scan_from_ranges(np.full((20, 30), 3.0), np.zeros((20, 30)), valid))
    before = np.array([v.co for v in obj.data.vertices]), len(obj.data.polygons)
    blender.ops.reflcolor.set_up_render()
    return blender, obj, before


def test_holes_are_filled_in_renders_and_the_mesh_stays_as_measured(holed):
    blender, obj, (points, faces) = holed
    np.testing.assert_array_equal([v.co for v in obj.data.vertices], points)
    assert len(obj.data.polygons) == faces == 19 * 29 - 6
    modifier = obj.modifiers["Shown Surface"]
    assert modifier.show_render and not modifier.show_viewport
    mesh = shown(blender, obj)
    assert len(mesh.polygons) == 19 * 29
    filled = values(mesh, "filled")
    assert (filled[: len(points)] == 0).all() and (filled[len(points) :] == 1).all() and filled.any()


def test_what_is_filled_has_the_colors_that_are_around_it_now(holed):
    blender, obj, (points, _) = holed
    colors = np.tile(np.array([10, 200, 90, 255], np.float32) / 255, len(points))
    obj.data.color_attributes["Reflectance_Gray"].data.foreach_set("color_srgb", colors)
    obj.data.update()
    assert (color_values(shown(blender, obj), "Reflectance_Gray") == [10, 200, 90]).all()


def test_holes_are_shown_where_that_is_wanted(holed):
    blender, obj, (_, faces) = holed
    blender.context.scene.reflcolor.picture_filled = False
    assert len(shown(blender, obj).polygons) == faces
    blender.ops.reflcolor.set_up_render()
    assert "Shown Surface" not in obj.modifiers
    assert not blender.data.node_groups and len(blender.data.meshes) == 1


@pytest.mark.parametrize("look", ["archive", "lit"])
def test_another_look_is_taken_up_at_once(holed, look):
    blender, obj, _ = holed
    blender.context.scene.reflcolor.picture_look = look
    strength = [node.inputs["Strength"] for node in obj.active_material.node_tree.nodes if node.type == "EMISSION"]
    assert [socket.is_linked for socket in strength] == [look == "lit"]


@pytest.mark.parametrize("filled", [True, False])
@pytest.mark.parametrize("look", ["archive", "lit"])
def test_a_picture_shows_the_same_when_all_else_was_removed(holed, tmp_path, look, filled):
    blender, obj, _ = holed
    scene = blender.context.scene
    scene.reflcolor.picture_look, scene.reflcolor.picture_filled = look, filled
    add_shades(obj)
    scene.render.resolution_percentage, scene.cycles.samples = 20, 1
    pictures = []
    for number in range(2):
        scene.render.filepath = str(tmp_path / f"{number}.png")
        blender.ops.render.render(write_still=True)
        pictures.append(cv2.imread(scene.render.filepath))
        if number == 0:
            module = importlib.import_module(f"{EXTENSION}.operators.scene.picture_only")
            module.leave_picture_only(blender.context, [obj])
    assert "reflectance" not in obj.data.attributes and not obj.modifiers
    assert len(np.unique(pictures[0])) > 20
    np.testing.assert_array_equal(*pictures)


@pytest.mark.parametrize("room", [True, False])
def test_a_picture_in_tiles_shows_the_same_even_without_room_for_them(holed, tmp_path, monkeypatch, room):
    blender, _, _ = holed
    module = importlib.import_module(f"{EXTENSION}.operators.scene.picture_only")
    scene = blender.context.scene
    scene.render.resolution_percentage, scene.cycles.samples = 20, 1
    sides = scene.render.resolution_x * 0.2, scene.render.resolution_y * 0.2
    monkeypatch.setattr(module, "_TILE", int(min(sides) / 2))
    module.render(blender.context, tmp_path / "whole.png")
    temporary = Path(blender.app.tempdir)
    aside = temporary.rename(temporary.with_name("aside")) if not room else None
    try:
        module.render_in_tiles(blender.context, tmp_path / "tiles.png")
    finally:
        if aside is not None:
            aside.rename(temporary)
    assert (scene.cycles.tile_size < min(sides)) == room
    np.testing.assert_array_equal(*(cv2.imread(str(tmp_path / f"{name}.png")) for name in ("whole", "tiles")))


def add_shades(obj):
    levels = np.linspace(0.1, 0.9, 4 * len(obj.data.vertices), dtype=np.float32)
    obj.data.color_attributes["Reflectance_Gray"].data.foreach_set("color_srgb", levels)


def test_the_panel_knows_that_holes_and_mixed_returns_need_another_set_up(startup_scan):
    properties, render = (
        importlib.import_module(f"{EXTENSION}.operators.scene.{name}") for name in ("properties", "render")
    )
    scene, chosen = startup_scan.context.scene, startup_scan.context.scene.reflcolor

    def lacks():
        return render.lacks_surface(scene, properties.scene_picture(scene))

    assert not lacks()
    chosen.picture_filled = chosen.picture_drop_mixed = False
    found = []
    for filled, drop_mixed in ((False, False), (True, False), (True, True)):
        startup_scan.ops.reflcolor.set_up_render()
        before = lacks()
        chosen.picture_filled, chosen.picture_drop_mixed = filled, drop_mixed
        found.append((before, lacks()))
    assert found == [(False, False), (False, True), (False, True)]
    chosen.picture_filled = chosen.picture_drop_mixed = False
    assert not lacks()
