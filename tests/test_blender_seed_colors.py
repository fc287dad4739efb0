"""Where seeds get their colors: from the tool, from the scan itself; and what holds on to a photo that is renamed."""

import importlib

import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import write_small_ptx
from test_blender_picking import color, scan, scan_file, seeds, settings  # noqa: F401

from reflcolor_addon import Scan
from reflcolor_addon.files.writers import write_ptx

SCENE = "bl_ext.user_default.reflcolor.operators.scene"


def test_the_tools_color_goes_to_the_seed_that_waits_and_to_those_placed_next(scan):  # noqa: F811
    scan.ops.reflcolor.place_seed(row=2, col=3)
    assert not seeds(scan)[0].has_color
    # A color wheel that is turned gives many colors, one after another.
    for chosen in ((0.2, 0.4, 0.6), (1.0, 0.5, 0.0)):
        settings(scan).picked_color = chosen
    scan.ops.reflcolor.place_seed(row=1, col=1)
    settings(scan).picked_color = (0.0, 1.0, 0.0)
    scan.ops.reflcolor.place_seed(row=3, col=5)
    assert [color(seed) for seed in seeds(scan)] == [(1, 0.5, 0), (1, 0.5, 0), (0, 1, 0)]
    assert all(seed.has_color and seed.reason == "hand" and seed.photo is None for seed in seeds(scan))


def test_the_tools_color_leaves_selected_seeds_that_have_their_own(scan):  # noqa: F811
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10))
    scan.ops.reflcolor.place_seed(row=2, col=3)
    scan.ops.reflcolor.select_all_seeds(which="all")
    settings(scan).picked_color = (0.0, 1.0, 0.0)
    assert color(seeds(scan)[0]) == (1, 0, 0)


def test_a_seed_that_waits_is_given_a_color_in_the_list(scan):  # noqa: F811
    scan.ops.reflcolor.place_seed(row=2, col=3)
    seeds(scan)[0].color = (0.1, 0.2, 0.3)
    assert seeds(scan)[0].has_color


def test_renaming_a_photos_image_keeps_its_seeds_with_it(scan):  # noqa: F811
    scan.ops.reflcolor.place_seed(row=2, col=3)
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(45, 10))
    seed_list = importlib.import_module(f"{SCENE}.seed_list")
    assert seed_list.seeds_of(scan.context.active_object).photos == ("photo.png",)
    scan.data.images["photo.png"].name = "yard.png"
    assert seed_list.seeds_of(scan.context.active_object).photos == ("yard.png",)


def test_photos_are_there_in_another_scene(scan):  # noqa: F811
    scan.ops.reflcolor.pick_color(photo="photo.png", photo_xy=(5, 10))
    other = scan.data.scenes.new("Other")
    lists = importlib.import_module(f"{SCENE}.photo_list")
    assert [image.name for image in lists.listed_images(other)] == ["photo.png"]
    assert lists.active_image(other).name == "photo.png"


@pytest.fixture
def colored(blender, tmp_path):
    """Blender with a scan that came with colors."""
    plain = random_scan(1, (6, 10))
    rgb = np.random.default_rng(0).integers(1, 256, (6, 10, 3), np.uint8)
    hall = Scan(name="hall", points=plain.points, reflectance=plain.reflectance, valid=plain.valid, color=rgb)
    write_ptx(hall, tmp_path / "hall.ptx")
    blender.ops.reflcolor.import_scan(filepath=str(tmp_path / "hall.ptx"))
    return blender


def test_seeds_are_taken_from_the_scans_own_colors(colored):
    colored.ops.reflcolor.add_seed(row=0, col=0, color=(1, 0, 0))
    colored.ops.reflcolor.seeds_from_color(count=12)
    colored.ops.reflcolor.seeds_from_color(count=7)
    assert [seed.reason for seed in seeds(colored)] == ["hand"] + ["scan"] * 7


def test_a_scan_without_colors_gives_none(blender, tmp_path):
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    with pytest.raises(RuntimeError, match="The scan came without colors"):
        blender.ops.reflcolor.seeds_from_color()


def test_the_settings_that_were_used_are_those_of_the_sidebar(colored):
    colored.ops.reflcolor.seeds_from_color(count=12)
    colored.ops.reflcolor.colorize(alpha=9.0)
    assert settings(colored).alpha == 9.0
    settings(colored).alpha = 3.0
    colored.ops.reflcolor.colorize()
    assert settings(colored).alpha == 3.0


def test_the_example_opens_with_its_photo(blender):
    assert blender.ops.reflcolor.open_example() == {"FINISHED"}
    assert blender.context.active_object.name == "cones"
    assert [photo.image.name for photo in settings(blender).photos] == ["photo.jpg"]
