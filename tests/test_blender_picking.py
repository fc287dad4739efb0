"""The acts of the seed tools, as operators: place, pick, keep gray, select, lock, delete, and their undo."""

import importlib
from types import SimpleNamespace

import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx

PHOTO = np.zeros((40, 60, 3), np.float32)
PHOTO[:, :30] = (1.0, 0.0, 0.0)
PHOTO[:, 30:] = (0.0, 0.0, 1.0)


@pytest.fixture
def scan_file(tmp_path):
    """A scan of 6 x 10 pixels, of which a corner has no return."""
    valid = np.ones((6, 10), bool)
    valid[4:, 7:] = False
    return write_small_ptx(tmp_path / "wall.ptx", random_scan(3, valid=valid))


@pytest.fixture
def scan(blender, scan_file):
    """Blender with a scan and a photo that is red at the left and blue at the right."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    image = blender.data.images.new("photo.png", 60, 40)
    rgba = np.ones((40, 60, 4), np.float32)
    rgba[..., :3] = PHOTO[::-1]
    image.pixels.foreach_set(rgba.ravel())
    image.pack()
    return blender


def seeds(bpy):
    return bpy.context.active_object.reflcolor.seeds


def settings(bpy):
    return bpy.context.scene.reflcolor


def color(seed):
    return tuple(round(value, 3) for value in seed.color)


def test_a_place_waits_for_the_color_that_is_picked_next(scan):
    scan.ops.reflcolor.place_seed(row=2, col=3)
    (seed,) = seeds(scan)
    assert (seed.row, seed.col, seed.has_color, seed.select) == (2, 3, False, True)
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(45, 10))
    (seed,) = seeds(scan)
    assert (color(seed), seed.has_color, seed.select) == ((0, 0, 1), True, False)
    assert (seed.photo.name, tuple(seed.photo_xy), seed.reason) == ("photo.png", (45, 10), "hand")
    assert not settings(scan).picked


def test_few_seeds_that_a_person_picked_are_told_from_many_and_from_found_ones(scan):
    told = importlib.import_module(f"{EXTENSION}.operators.scene.seed_list").seeds_are_few_and_picked
    obj = scan.context.active_object
    assert not told(None) and not told(obj)
    scan.ops.reflcolor.add_seed(row=0, col=0, color=(1, 0, 0))
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    assert told(obj)
    seeds(scan)[1].reason = "pose"
    assert not told(obj)
    seeds(scan)[1].reason = "hand"
    for _ in range(30):
        seeds(scan).add()
    assert not told(obj)


def test_a_picked_color_is_given_to_every_place_until_it_is_dropped(scan):
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10))
    scan.ops.reflcolor.place_seed(row=1, col=1)
    scan.ops.reflcolor.place_seed(row=2, col=5)
    scan.ops.reflcolor.drop_color()
    scan.ops.reflcolor.place_seed(row=3, col=7)
    assert [color(seed) for seed in seeds(scan)][:2] == [(1, 0, 0), (1, 0, 0)]
    assert [seed.has_color for seed in seeds(scan)] == [True, True, False]


def test_only_the_first_place_of_a_picked_color_has_the_photos_point(scan):
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10))
    scan.ops.reflcolor.place_seed(row=1, col=1)
    scan.ops.reflcolor.place_seed(row=2, col=5)
    assert [seed.photo.name if seed.photo else None for seed in seeds(scan)] == ["photo.png", None]


def test_picking_in_a_photo_puts_it_on_the_list(scan):
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10))
    assert [photo.image.name for photo in settings(scan).photos] == ["photo.png"]


def test_sampling_takes_a_color_without_a_point_or_a_selected_seed(scan):
    scan.ops.reflcolor.place_seed(row=1, col=1)
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10), sample_only=True)
    assert settings(scan).picked and settings(scan).picked_photo is None
    assert not seeds(scan)[0].has_color and not settings(scan).photos


def test_a_point_outside_the_photo_is_refused(scan):
    with pytest.raises(RuntimeError, match=r"photo photo.png has no color at 80, 10"):
        scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(80, 10))


def test_keep_gray_arms_gray_or_grays_the_selected_seeds(scan):
    scan.ops.reflcolor.keep_gray()
    scan.ops.reflcolor.place_seed(row=1, col=1)
    assert color(seeds(scan)[0]) == (0.5, 0.5, 0.5) and seeds(scan)[0].has_color
    scan.ops.reflcolor.drop_color()
    scan.ops.reflcolor.add_seed(row=2, col=2, color=(1, 0, 0))
    scan.ops.reflcolor.keep_gray()
    assert color(seeds(scan)[1]) == (0.5, 0.5, 0.5)


def test_a_neutral_seed_keeps_the_scan_gray(scan):
    scan.ops.reflcolor.keep_gray()
    scan.ops.reflcolor.place_seed(row=1, col=1)
    scan.ops.reflcolor.colorize()
    image = scan.context.active_object.reflcolor.colorized_image
    pixels = np.array(image.pixels[:]).reshape(-1, 4)[:, :3]
    assert np.ptp(pixels, axis=1).max() < 1.5 / 255


def test_a_place_without_a_return_is_snapped_to_the_nearest_that_has_one(scan):
    obj = scan.context.active_object
    shape = obj.reflcolor.rows, obj.reflcolor.cols
    valid = np.zeros(shape, bool)
    rows, cols = (np.empty(len(obj.data.vertices), np.int32) for _ in range(2))
    obj.data.attributes["grid_row"].data.foreach_get("value", rows)
    obj.data.attributes["grid_col"].data.foreach_get("value", cols)
    valid[rows, cols] = True
    row, col = next(zip(*np.nonzero(~valid), strict=True))
    scan.ops.reflcolor.place_seed(row=int(row), col=int(col))
    seed = seeds(scan)[0]
    squared = (rows - row) ** 2 + (cols - col) ** 2
    assert valid[seed.row, seed.col] and (seed.row - row) ** 2 + (seed.col - col) ** 2 == squared.min()


def test_seeds_without_a_color_color_nothing(scan):
    scan.ops.reflcolor.place_seed(row=2, col=3)
    with pytest.raises(RuntimeError, match="poll"):
        scan.ops.reflcolor.colorize()
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    scan.ops.reflcolor.colorize()
    nearest = scan.context.active_object.data.attributes["nearest_seed"].data
    assert {item.value for item in nearest} <= {0, -1}


def test_what_is_chosen_in_the_list_is_what_is_selected(scan):
    for col in range(3):
        scan.ops.reflcolor.add_seed(row=1, col=col + 1, color=(1, 0, 0))
    scan.context.active_object.reflcolor.active_seed = 1
    assert [seed.select for seed in seeds(scan)] == [False, True, False]
    scan.ops.reflcolor.select_seed(index=2, extend=True)
    assert [seed.select for seed in seeds(scan)] == [False, True, True]


def test_selecting_by_kind(scan):
    for reason, confidence in (("hand", 1.0), ("pose", 0.9), ("appearance", 0.2)):
        scan.ops.reflcolor.add_seed(row=1, col=len(seeds(scan)) + 1, color=(1, 0, 0))
        seeds(scan)[-1].reason, seeds(scan)[-1].confidence = reason, confidence
    expected = {
        "all": [True, True, True],
        "none": [False, False, False],
        "found": [False, True, True],
        "unsure": [False, False, True],
        "uncolored": [False, False, False],
    }
    for which, selected in expected.items():
        scan.ops.reflcolor.select_all_seeds(which=which)
        assert [seed.select for seed in seeds(scan)] == selected, which


def test_deleting_takes_the_selected_seeds_only(scan):
    for col in range(4):
        scan.ops.reflcolor.add_seed(row=1, col=col + 1, color=(1, 0, 0))
    scan.ops.reflcolor.select_seed(index=1)
    scan.ops.reflcolor.select_seed(index=3, extend=True)
    scan.ops.reflcolor.delete_seeds()
    assert [seed.col for seed in seeds(scan)] == [1, 3]


def test_locking_is_of_the_selected_seeds(scan):
    for col in range(2):
        scan.ops.reflcolor.add_seed(row=1, col=col + 1, color=(1, 0, 0))
    scan.ops.reflcolor.lock_seeds()
    assert [seed.locked for seed in seeds(scan)] == [False, True]
    scan.ops.reflcolor.lock_seeds(unlock=True)
    assert not any(seed.locked for seed in seeds(scan))


def test_a_color_typed_in_counts_as_one(scan):
    scan.ops.reflcolor.place_seed(row=2, col=3)
    seeds(scan)[0].color = (0.1, 0.2, 0.3)
    assert seeds(scan)[0].has_color


def test_a_copied_object_has_seeds_of_its_own(scan):
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    original = scan.context.active_object
    copy = original.copy()
    copy.data = original.data.copy()
    scan.context.collection.objects.link(copy)
    copy.reflcolor.seeds[0].row = 5
    assert original.reflcolor.seeds[0].row == 1


def test_a_copy_is_colorized_into_an_image_of_its_own(scan):
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    scan.ops.reflcolor.colorize()
    original = scan.context.active_object
    before = np.array(original.reflcolor.colorized_image.pixels[:])
    copy = original.copy()
    copy.data = original.data.copy()
    scan.context.collection.objects.link(copy)
    scan.context.view_layer.objects.active = copy
    copy.reflcolor.seeds[0].color = (0, 0, 1)
    scan.ops.reflcolor.colorize()
    original = scan.data.objects[original.name]
    assert copy.reflcolor.colorized_image != original.reflcolor.colorized_image
    np.testing.assert_array_equal(np.array(original.reflcolor.colorized_image.pixels[:]), before)


@pytest.fixture
def library(scan, tmp_path):
    """A file that holds the scan with one seed."""
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    path = tmp_path / "library.blend"
    scan.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def link(bpy, path):
    """Link the scan of a library into an empty file; return its name."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(path), link=True) as (source, target):
        target.objects = source.objects
    return target.objects[0]


def test_a_linked_scan_says_that_its_seeds_are_another_files(scan, library):
    obj = link(scan, library)
    scan.context.collection.objects.link(obj)
    scan.context.view_layer.objects.active = obj
    assert len(obj.reflcolor.seeds) == 1
    with pytest.raises(RuntimeError, match="poll"):
        scan.ops.reflcolor.place_seed(row=2, col=2)
    assert len(obj.reflcolor.seeds) == 1


def test_seeds_added_to_a_library_override_are_saved_with_it(scan, library, tmp_path):
    linked = link(scan, library)
    scan.context.collection.objects.link(linked)
    # As in the window, of an object in the scene, where the override takes its place.
    obj = linked.override_create(remap_local_usages=True)
    scan.context.view_layer.objects.active = obj
    scan.ops.reflcolor.add_seed(row=2, col=3, color=(0, 1, 0))
    path = tmp_path / "shot.blend"
    scan.ops.wm.save_as_mainfile(filepath=str(path))
    scan.ops.wm.open_mainfile(filepath=str(path))
    kept = next(obj for obj in scan.data.objects if obj.library is None and obj.reflcolor.rows)
    assert [(seed.row, seed.col) for seed in kept.reflcolor.seeds] == [(1, 1), (2, 3)]


def test_a_deleted_photo_leaves_the_seeds_their_colors(scan):
    scan.ops.reflcolor.place_seed(row=2, col=3)
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(45, 10))
    scan.data.images.remove(scan.data.images["photo.png"])
    (seed,) = seeds(scan)
    assert color(seed) == (0, 0, 1) and seed.photo is None
    scan.ops.reflcolor.colorize()


def test_a_drag_that_edit_mode_keeps_from_ending_is_told_in_one_line_and_puts_the_seed_back(scan):
    pointer, dragging = (
        importlib.import_module(f"{EXTENSION}.operators.window.{name}") for name in ("pointer", "drag_seeds")
    )
    scan.ops.reflcolor.add_seed(row=1, col=1, color=(1, 0, 0))
    obj, told = scan.context.active_object, []
    view = SimpleNamespace(to_image=lambda place: place)
    image = obj.reflcolor.reflectance_image
    side = SimpleNamespace(obj=obj, image=image, is_scan=True, view=view, marks=lambda: (None, [True]))

    class Held(pointer.PointerOperator):
        def report(self, _kind, text):
            told.append(text)

    held = Held()
    held._region, held._area = SimpleNamespace(x=0, y=0), SimpleNamespace(tag_redraw=lambda: None)
    held._drag = dragging.DragSeeds(side, 0, (1, 1))
    pointer._following.append(held)
    scan.ops.object.mode_set(mode="EDIT")
    event = SimpleNamespace(mouse_x=4, mouse_y=3, type="LEFTMOUSE", value="RELEASE")
    assert held.modal(SimpleNamespace(workspace=None), event) == {"CANCELLED"}
    scan.ops.object.mode_set(mode="OBJECT")
    assert told == ["wall: leave Edit Mode first"]
    assert not pointer._following
    assert [(seed.row, seed.col) for seed in seeds(scan)] == [(1, 1)]


def test_tools_of_the_window_say_so_without_one(scan):
    with pytest.raises(RuntimeError, match=r"poll\(\) .*window"):
        scan.ops.reflcolor.open_seed_picking()
