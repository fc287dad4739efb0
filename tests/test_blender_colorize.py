"""Seeds and colorizing in Blender through the installed zip."""

import json
import struct
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import pixels, srgb, values, write_small_ptx

from reflcolor_addon import Seeds, Settings, colorize, read_scans

PLACES = ((0, 0), (2, 7), (5, 9), (3, 3))
COLORS = ((200, 80, 40), (20, 90, 220), (240, 240, 30), (128, 128, 128))


@pytest.fixture
def scan_file(tmp_path):
    """A scan of 6 x 10 pixels, every one with a return."""
    return write_small_ptx(tmp_path / "wall.ptx", random_scan(3))


@pytest.fixture
def wall(blender, scan_file):
    """bpy with that scan imported and active."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    return blender


@pytest.fixture
def seeded(wall):
    """bpy with four seeds on it."""
    for (row, col), color in zip(PLACES, COLORS, strict=True):
        wall.ops.reflcolor.add_seed(row=row, col=col, color=[value / 255 for value in color])
    return wall


def seeds_in(bpy):
    return [(seed.row, seed.col) for seed in bpy.context.active_object.reflcolor.seeds]


def expected(scan_file, **settings):
    seeds = Seeds(*np.transpose(PLACES), np.array(COLORS, np.uint8))
    return colorize(read_scans(scan_file)[0], seeds, Settings.preset("Natural", **settings))


@pytest.mark.parametrize("settings", [{}, {"beta": 0.0, "neighbors": 4}, {"alpha": 2.0, "color_space": "cielab"}])
def test_colors_equal_the_cores(seeded, scan_file, settings):
    options = settings | ({"neighbors": str(settings["neighbors"])} if "neighbors" in settings else {})
    seeded.ops.reflcolor.colorize(**options)
    obj = seeded.context.active_object
    rgb = expected(scan_file, **settings).rgb
    rows, cols = values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)
    difference = srgb(obj, "Colorized").astype(int) - rgb[rows, cols]
    assert np.abs(difference).max() <= 1
    image = np.rint(pixels(obj.reflcolor.colorized_image)[..., :3] * 255).astype(int)
    assert np.abs(image - rgb).max() <= 1


def test_settings_not_given_come_from_the_scene(seeded, scan_file):
    seeded.context.scene.reflcolor.alpha = 1.5
    seeded.ops.reflcolor.colorize()
    rgb = expected(scan_file, alpha=1.5).rgb.reshape(-1, 3).astype(int)
    assert np.abs(srgb(seeded.context.active_object, "Colorized") - rgb).max() <= 1


def test_colors_are_active_for_viewport_render_and_material(seeded):
    seeded.ops.reflcolor.colorize()
    mesh = seeded.context.active_object.data
    attributes = mesh.color_attributes
    assert attributes.active_color_name == attributes[attributes.render_color_index].name == "Colorized"
    nodes = mesh.materials[0].node_tree.nodes
    assert [node.attribute_name for node in nodes if node.type == "ATTRIBUTE"] == ["Colorized"]
    assert attributes["Colorized"].domain == "POINT"


def test_the_reflectance_stays_untouched(seeded):
    obj = seeded.context.active_object
    before = values(obj, "reflectance").tobytes(), srgb(obj, "Reflectance_Gray").tobytes()
    seeded.ops.reflcolor.colorize()
    assert (values(obj, "reflectance").tobytes(), srgb(obj, "Reflectance_Gray").tobytes()) == before


def test_colors_survive_saving_and_loading(seeded, tmp_path):
    seeded.ops.reflcolor.colorize()
    before = srgb(seeded.context.active_object, "Colorized")
    seeded.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    seeded.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    obj = seeded.context.active_object
    np.testing.assert_array_equal(srgb(obj, "Colorized"), before)
    assert seeds_in(seeded) == list(PLACES)
    image = np.rint(pixels(obj.reflcolor.colorized_image)[..., :3] * 255).astype(np.uint8)
    np.testing.assert_array_equal(image.reshape(-1, 3), before)


def test_colorizing_again_replaces_attribute_and_image(seeded):
    seeded.ops.reflcolor.colorize()
    seeded.ops.reflcolor.remove_seed(index=1)
    seeded.ops.reflcolor.colorize()
    obj = seeded.context.active_object
    assert [name for name in obj.data.color_attributes.keys() if "Colorized" in name] == ["Colorized"]  # noqa: SIM118
    assert len([image for image in seeded.data.images if "Colorized" in image.name]) == 1


def test_a_mesh_that_lost_its_grid_says_so(seeded):
    obj = seeded.context.active_object
    obj.data.attributes.remove(obj.data.attributes["grid_row"])
    with pytest.raises(RuntimeError, match="lost its attribute grid_row"):
        seeded.ops.reflcolor.colorize()
    assert "Colorized" not in obj.data.color_attributes


@pytest.mark.parametrize("act", ["colorize", "evaluate"])
def test_in_edit_mode_the_operator_says_to_leave_it(seeded, act):
    seeded.ops.reflcolor.colorize()
    seeded.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match=r"[Ll]eave Edit Mode first"):
        getattr(seeded.ops.reflcolor, act)()


def test_deleted_vertices_keep_their_neighbors_colors_in_place(seeded, scan_file):
    import bmesh

    obj = seeded.context.active_object
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    edited.verts.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=[edited.verts[14]], context="VERTS")
    edited.to_mesh(obj.data)
    edited.free()
    seeded.ops.reflcolor.colorize()
    rows, cols = values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)
    image = np.rint(pixels(obj.reflcolor.colorized_image)[..., :3] * 255).astype(np.uint8)
    np.testing.assert_array_equal(srgb(obj, "Colorized"), image[rows, cols])


def test_without_seeds_the_operator_says_what_is_missing(wall):
    with pytest.raises(RuntimeError, match="Add a seed first"):
        wall.ops.reflcolor.colorize()


def test_seeds_are_moved_removed_and_cleared(seeded):
    seeded.ops.reflcolor.move_seed(index=1, row=4, col=4)
    assert seeds_in(seeded) == [(0, 0), (4, 4), (5, 9), (3, 3)]
    seeded.ops.reflcolor.remove_seed(index=0)
    assert seeds_in(seeded) == [(4, 4), (5, 9), (3, 3)]
    seeded.ops.reflcolor.clear_seeds()
    assert seeds_in(seeded) == []


@pytest.mark.parametrize("act", ["add_seed", "move_seed"])
def test_a_seed_outside_the_grid_is_refused(seeded, act):
    with pytest.raises(RuntimeError, match="row 6, column 0 is outside the scan's grid"):
        getattr(seeded.ops.reflcolor, act)(row=6, col=0)
    assert seeds_in(seeded) == list(PLACES)


def test_seeds_are_undone_and_redone(wall):
    wall.ops.ed.undo_push(message="start")
    wall.ops.reflcolor.add_seed(row=1, col=2, color=(1, 0, 0))
    wall.ops.ed.undo_push(message="seed")
    wall.ops.reflcolor.clear_seeds()
    wall.ops.ed.undo_push(message="clear")
    assert seeds_in(wall) == []
    wall.ops.ed.undo()
    assert seeds_in(wall) == [(1, 2)]
    wall.ops.ed.undo()
    assert seeds_in(wall) == []
    wall.ops.ed.redo()
    assert seeds_in(wall) == [(1, 2)]


def test_seeds_saved_and_loaded_are_the_same(seeded, tmp_path):
    path = tmp_path / "wall.json"
    seeded.ops.reflcolor.save_seeds(filepath=str(path))
    assert json.loads(path.read_text())["seeds"][0] == {"row": 0, "col": 0, "rgb": [200, 80, 40]}
    seeded.ops.reflcolor.clear_seeds()
    seeded.ops.reflcolor.load_seeds(filepath=str(path))
    colors = [
        tuple(round(value * 255) for value in seed.color) for seed in seeded.context.active_object.reflcolor.seeds
    ]
    assert seeds_in(seeded) == list(PLACES) and tuple(colors) == COLORS


def test_a_photo_gives_a_seed_its_color(wall, tmp_path):
    photo = np.random.default_rng(0).integers(0, 256, (30, 40, 3), np.uint8)
    cv2.imwrite(str(tmp_path / "view.png"), photo[..., ::-1])
    wall.ops.reflcolor.load_photo(filepath=str(tmp_path / "view.png"))
    image = wall.context.scene.reflcolor.photos[0].image
    wall.ops.reflcolor.add_seed(row=1, col=1, photo=image.name, photo_xy=(12.5, 7.25))
    seed = wall.context.active_object.reflcolor.seeds[-1]
    assert [round(value * 255) for value in seed.color] == photo[7, 12].tolist()
    assert seed.photo == image and tuple(seed.photo_xy) == (12.5, 7.25)
    with pytest.raises(RuntimeError, match="no color at 41, 7"):
        wall.ops.reflcolor.add_seed(row=1, col=1, photo=image.name, photo_xy=(41, 7))


def test_a_photo_lying_on_its_side_is_turned_upright(wall, tmp_path):
    photo = np.zeros((32, 48, 3), np.uint8)
    photo[:16, :16] = (250, 20, 20)
    data = cv2.imencode(".jpg", photo[..., ::-1])[1].tobytes()
    # Orientation 6: turn by 90 degrees clockwise to see it as it was held.
    exif = b"Exif\0\0" + struct.pack("<2sHIHHHIHHI", b"II", 42, 8, 1, 0x0112, 3, 1, 6, 0, 0)
    segment = b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif
    (tmp_path / "turned.jpg").write_bytes(data[:2] + segment + data[2:])
    wall.ops.reflcolor.load_photo(filepath=str(tmp_path / "turned.jpg"))
    image = wall.context.scene.reflcolor.photos[0].image
    assert tuple(image.size) == (32, 48)
    red = pixels(image)[..., 0]
    assert red[:12, -12:].min() > 0.8 and red[:12, :12].max() < 0.2 and red[-12:].max() < 0.2


def test_what_is_no_photo_is_one_line(wall, tmp_path):
    (tmp_path / "note.jpg").write_text("no picture")
    with pytest.raises(RuntimeError, match=r"note\.jpg"):
        wall.ops.reflcolor.load_photo(filepath=str(tmp_path / "note.jpg"))
    assert not wall.context.scene.reflcolor.photos


def test_deleting_images_breaks_nothing(seeded):
    seeded.ops.reflcolor.colorize()
    for image in list(seeded.data.images):
        seeded.data.images.remove(image)
    seeded.ops.reflcolor.colorize()
    assert seeded.context.active_object.reflcolor.colorized_image is not None
    with pytest.raises(RuntimeError, match="was deleted"):
        seeded.ops.reflcolor.open_reflectance()


def test_a_preset_sets_the_settings_of_the_scene(seeded, scan_file):
    settings = seeded.context.scene.reflcolor
    seeded.ops.reflcolor.apply_preset(preset="Enhanced")
    assert (settings.alpha, settings.blend, settings.nearest) == (3.0, "nearest", 8)
    seeded.ops.reflcolor.colorize()
    rgb = colorize(
        read_scans(scan_file)[0], Seeds(*np.transpose(PLACES), np.array(COLORS)), Settings.preset("Enhanced")
    )
    difference = srgb(seeded.context.active_object, "Colorized").astype(int) - rgb.rgb.reshape(-1, 3)
    assert np.abs(difference).max() <= 1
    seeded.ops.reflcolor.apply_preset(preset="Paper")
    assert (settings.alpha, settings.beta, settings.smoothing, settings.blend) == (6.0, 1.0, 0.0, "auto")


def test_photos_are_listed_and_taken_off(wall, tmp_path):
    for name in ("a.png", "b.png"):
        cv2.imwrite(str(tmp_path / name), np.zeros((20, 20, 3), np.uint8))
        wall.ops.reflcolor.load_photo(filepath=str(tmp_path / name))
    settings = wall.context.scene.reflcolor
    assert [photo.image.name for photo in settings.photos] == ["a.png", "b.png"] and settings.active_photo == 1
    wall.ops.reflcolor.remove_photo()
    wall.ops.reflcolor.remove_photo()
    assert not settings.photos
    with pytest.raises(RuntimeError, match="Load a photo first"):
        wall.ops.reflcolor.match_photos()


def test_seeds_are_found_in_a_photo_and_hand_picked_ones_stay(blender):
    cones = Path(__file__).resolve().parent.parent / "examples" / "cones"
    blender.ops.reflcolor.import_scan(filepath=str(cones / "cones.scan.json"))
    blender.ops.reflcolor.load_photo(filepath=str(cones / "photo.jpg"))
    blender.ops.reflcolor.add_seed(row=10, col=20, color=(0.1, 0.2, 0.9))
    blender.ops.reflcolor.match_photos()
    state = blender.context.active_object.reflcolor
    found = [seed for seed in state.seeds if seed.reason == "pose"]
    assert len(found) > 100 and all(seed.photo.name == "photo.jpg" for seed in found)
    assert (state.seeds[0].row, state.seeds[0].col, state.seeds[0].reason) == (10, 20, "hand")
    (verdict,) = state.verdicts
    assert verdict.verified and verdict.image.name == "photo.jpg" and "verified" in verdict.note
    assert state.matches_image.size[0] > 400
    # Again: what was found before is replaced, not added to.
    count = len(state.seeds)
    blender.ops.reflcolor.match_photos()
    assert len(state.seeds) == count
