"""What photos saw, kept with a scan's object, and the texture, in Blender through the installed zip."""

import importlib
import json
from types import SimpleNamespace

import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import srgb, values, write_small_ptx

from reflcolor_addon import Seeds, Settings, colorize, read_scans
from reflcolor_addon.color.observed import Observed

SHAPE = (6, 10)
SEEDS = Seeds([0], [0], [[200, 80, 40]])


@pytest.fixture
def scan_file(tmp_path):
    return write_small_ptx(tmp_path / "wall.ptx", random_scan(3, SHAPE))


@pytest.fixture
def observed():
    """A photo that saw the right half."""
    weight = np.zeros(SHAPE, np.float32)
    weight[:, 5:] = 1
    rgb = np.random.default_rng(0).integers(1, 255, (*SHAPE, 3)).astype(np.uint8)
    return Observed(rgb * (weight > 0)[..., None], weight, np.where(weight > 0, 0, -1).astype(np.int16))


@pytest.fixture
def colorized(blender, scan_file, observed):
    """bpy with a scan colorized from a seed and from what a photo saw, as Match Photos keeps it."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    module.keep_observed(blender.context.active_object, observed)
    blender.ops.reflcolor.add_seed(row=0, col=0, color=[value / 255 for value in (200, 80, 40)])
    blender.ops.reflcolor.colorize()
    return blender


def test_what_was_prepared_for_other_vertices_is_not_written(colorized, observed):
    obj = colorized.context.active_object
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    before, key = values(obj, ".seen_rgb", np.int32), module.observed_key(obj)
    rows, cols = (values(obj, name, np.int32) for name in ("grid_row", "grid_col"))
    other = module.ObservedArrays.of(observed, (rows[::-1], cols[::-1]))
    assert not np.array_equal(other.values[".seen_rgb"], before)
    list(module.keep_observed_by_steps(obj, observed, other))
    np.testing.assert_array_equal(values(obj, ".seen_rgb", np.int32), before)
    assert module.observed_key(obj) == key


def expected(scan_file, observed):
    return colorize(read_scans(scan_file)[0], SEEDS, Settings.preset("Natural"), observed)


def test_colorize_takes_what_photos_saw(colorized, scan_file, observed):
    obj, result = colorized.context.active_object, expected(scan_file, observed)
    np.testing.assert_array_equal(srgb(obj, "Colorized"), result.rgb.reshape(-1, 3))
    np.testing.assert_array_equal(values(obj, "observed"), result.observed.ravel())
    np.testing.assert_array_equal(values(obj, "photo", np.int32), result.photo.ravel())
    assert json.loads(obj["reflcolor_provenance"])["result"]["observed"] == 30


def test_under_paper_it_takes_nothing_of_it(colorized, scan_file):
    colorized.ops.reflcolor.apply_preset(preset="Paper")
    colorized.ops.reflcolor.colorize()
    assert not values(colorized.context.active_object, "observed").any()


def test_what_photos_saw_survives_saving_and_goes_with_the_seeds(colorized, scan_file, observed, tmp_path):
    bpy = colorized
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.reflcolor.colorize()
    np.testing.assert_array_equal(
        srgb(bpy.context.active_object, "Colorized"), expected(scan_file, observed).rgb.reshape(-1, 3)
    )
    bpy.ops.reflcolor.clear_seeds()
    bpy.ops.reflcolor.add_seed(row=0, col=0, color=(1, 0, 0))
    bpy.ops.reflcolor.colorize()
    assert not values(bpy.context.active_object, "observed").any()


@pytest.mark.parametrize(("look", "colors"), [("observed", "Observed_Map"), ("photo", "Photo_Map")])
def test_maps_show_what_was_observed_and_by_which_photo(colorized, look, colors):
    colorized.ops.reflcolor.show_look(look=look)
    obj = colorized.context.active_object
    assert obj.data.color_attributes.active_color_name == colors
    legend = importlib.import_module(f"{EXTENSION}.operators.overlays.legend").legend_of(obj)
    assert legend["title"] == {"observed": "Observed", "photo": "Photo"}[look]
    if look == "photo":
        assert legend["labels"][0] == "Photo 1" and legend["unknown"] == "Inferred"


def test_a_texture_is_shown_until_other_colors_are_wanted(colorized):
    colorized.ops.reflcolor.make_texture(pixels=128)
    obj = colorized.context.active_object
    nodes = obj.active_material.node_tree.nodes
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    node = shader.inputs["Base Color"].links[0].from_node
    assert node.type == "TEX_IMAGE" and max(node.image.size) == 128
    assert node.inputs["Vector"].links[0].from_node.uv_map == "Scan_Grid"
    colorized.ops.reflcolor.show_look(look="gray")
    assert shader.inputs["Base Color"].links[0].from_node.type == "ATTRIBUTE"


def test_cameras_come_back_and_what_is_spoiled_is_none(colorized):
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    obj = colorized.context.active_object
    for kept, found in (("nonsense", []), ("[null]", [None])):
        obj["reflcolor_cameras"] = kept
        module.use_cameras(obj, module.observed_cameras(obj))
        assert module.cameras_of(obj) == found


def test_a_later_search_in_photos_changes_no_camera_of_the_colors(colorized):
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    obj = colorized.context.active_object
    obj["reflcolor_cameras"] = "[null]"
    assert module.cameras_of(obj) == []
    colorized.ops.reflcolor.colorize()
    assert module.cameras_of(obj) == [None]
    module.keep_observed(obj, None)
    assert module.cameras_of(obj) == [None]


def test_the_photo_of_a_camera_is_known_whatever_its_image_is_called_now(colorized):
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    models = importlib.import_module(f"{EXTENSION}.reflcolor_addon.matching.models")
    obj, image = colorized.context.active_object, colorized.data.images.new("view.png", 4, 4)
    match = SimpleNamespace(name="view.png", model=models.GridHomography(np.eye(3), SHAPE, 4, 4))
    for images, found in (({"view.png": image}, image), (None, None)):
        image.name = "view.png"
        module.keep_cameras(obj, [match], images)
        module.use_cameras(obj, module.observed_cameras(obj))
        image.name = "renamed"
        assert module.camera_image(obj, 0) == found
    # A file made without its photos knows them by name alone.
    image.name = "view.png"
    assert module.camera_image(obj, 0) == image


def test_cameras_are_those_that_were_there_when_the_work_began(colorized):
    module = importlib.import_module(f"{EXTENSION}.operators.scene.photo_colors")
    obj = colorized.context.active_object
    obj["reflcolor_cameras"] = "[null]"
    seen = module.observed_cameras(obj)
    module.keep_observed(obj, None)
    module.use_cameras(obj, seen)
    assert module.cameras_of(obj) == [None]


def test_an_image_that_was_looked_at_shows_what_is_written_into_it_again(colorized):
    images = importlib.import_module(f"{EXTENSION}.operators.scene.images")
    image = None
    for level, shape in ((10, (4, 6, 3)), (200, (4, 6, 3)), (90, (8, 5, 3))):
        packed = images.packed_pixels(np.full(shape, level, np.uint8), "twice")
        image = images.write_packed(image, "twice", packed, is_data=False)
        assert tuple(image.size) == shape[1::-1]
        assert (images.read_image(image) == level).all()
