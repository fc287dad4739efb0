"""What the viewport shows of a scan, in Blender through the installed zip."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import srgb, values, write_small_ptx

from reflcolor_addon import Seeds, Settings, colorize, read_scans
from reflcolor_addon.view.colormaps import UNKNOWN, limits_of, painted, region_colors

SEEDS = Seeds([0, 5, 3], [0, 9, 3], np.array([[200, 80, 40], [20, 90, 220], [90, 200, 60]], np.uint8))
MAPS = {
    "confidence": "Confidence_Map",
    "nearest_seed": "Nearest_Seed_Map",
    "range": "Range_Map",
    "error": "Error_Map",
}


@pytest.fixture
def scan_file(tmp_path):
    """A scan of 6 x 10 pixels with colors of its own; one of them black, which is none."""
    color = np.random.default_rng(1).integers(1, 256, (6, 10, 3), np.uint8)
    color[4, 4] = 0
    return write_small_ptx(tmp_path / "wall.ptx", replace(random_scan(3), color=color))


@pytest.fixture
def imported(blender, scan_file):
    """bpy with that scan and its seeds, not colorized."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    for row, col, rgb in zip(SEEDS.rows, SEEDS.cols, SEEDS.rgb / 255, strict=True):
        blender.ops.reflcolor.add_seed(row=int(row), col=int(col), color=rgb.tolist())
    return blender


@pytest.fixture
def colorized(imported):
    """bpy with that scan, colorized and evaluated."""
    imported.ops.reflcolor.colorize()
    imported.ops.reflcolor.evaluate()
    return imported


@pytest.fixture
def legend(installed_blender):
    return importlib.import_module(f"{EXTENSION}.operators.overlays.legend")


def shown(bpy):
    return bpy.context.active_object.data.color_attributes.active_color_name


def test_confidence_and_nearest_seed_of_every_vertex_are_the_cores(colorized, scan_file):
    obj, result = colorized.context.active_object, colorize(read_scans(scan_file)[0], SEEDS, Settings.preset("Natural"))
    # The mesh holds the points in single precision.
    np.testing.assert_allclose(values(obj, "confidence"), result.confidence.ravel(), rtol=1e-4)
    np.testing.assert_array_equal(values(obj, "nearest_seed", np.int32), result.nearest_seed.ravel())


def test_confidence_and_nearest_seed_survive_saving_and_undo(colorized, tmp_path):
    bpy = colorized
    before = [values(bpy.context.active_object, name).tobytes() for name in ("confidence", "error")]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    assert [values(bpy.context.active_object, name).tobytes() for name in ("confidence", "error")] == before
    bpy.ops.ed.undo_push(message="opened")
    bpy.ops.reflcolor.remove_seed(index=0)
    bpy.ops.reflcolor.colorize()
    bpy.ops.ed.undo_push(message="colorized")
    assert values(bpy.context.active_object, "confidence").tobytes() != before[0]
    bpy.ops.ed.undo()
    assert values(bpy.context.active_object, "confidence").tobytes() == before[0]


@pytest.mark.parametrize(("look", "gradient"), [("confidence", "viridis"), ("range", "turbo"), ("error", "inferno")])
def test_a_map_paints_the_values_by_its_gradient(colorized, look, gradient):
    colorized.ops.reflcolor.show_look(look=look)
    obj = colorized.context.active_object
    found = values(obj, look)
    found = np.where(found < 0, np.nan, found)
    limits = (0.0, 1.0) if look == "confidence" else limits_of(found)
    assert shown(colorized) == MAPS[look]
    np.testing.assert_array_equal(srgb(obj, MAPS[look]), painted(found, gradient, limits))


def test_regions_have_colors_of_their_own(colorized):
    colorized.ops.reflcolor.show_look(look="nearest_seed")
    obj = colorized.context.active_object
    expected = region_colors(values(obj, "nearest_seed", np.int32))
    np.testing.assert_array_equal(srgb(obj, "Nearest_Seed_Map"), expected)


def test_where_no_truth_is_known_the_error_is_gray(colorized):
    colorized.ops.reflcolor.show_look(look="error")
    obj = colorized.context.active_object
    unknown = values(obj, "error") < 0
    assert unknown.sum() == 1
    assert tuple(srgb(obj, "Error_Map")[unknown][0]) == UNKNOWN


@pytest.mark.parametrize("look", [*MAPS, "scanned"])
def test_looking_changes_neither_renders_nor_materials(colorized, look):
    colorized.ops.reflcolor.show_look(look=look)
    mesh = colorized.context.active_object.data
    attributes = mesh.color_attributes
    assert attributes[attributes.render_color_index].name == "Colorized"
    nodes = mesh.materials[0].node_tree.nodes
    assert [node.attribute_name for node in nodes if node.type == "ATTRIBUTE"] == ["Colorized"]


@pytest.mark.parametrize(("look", "name"), [("gray", "Reflectance_Gray"), ("colorized", "Colorized")])
def test_gray_and_colorized_go_to_renders_too(colorized, look, name):
    colorized.ops.reflcolor.show_look(look="range")
    colorized.ops.reflcolor.show_look(look=look)
    mesh = colorized.context.active_object.data
    attributes = mesh.color_attributes
    assert attributes.active_color_name == attributes[attributes.render_color_index].name == name
    assert [node.attribute_name for node in mesh.materials[0].node_tree.nodes if node.type == "ATTRIBUTE"] == [name]


def test_there_is_one_map_at_most(colorized):
    for look in (*MAPS, "gray"):
        colorized.ops.reflcolor.show_look(look=look)
        names = colorized.context.active_object.data.color_attributes.keys()
        assert [name for name in names if name.endswith("Map")] == [MAPS[look] for _ in [0] if look in MAPS]


@pytest.mark.parametrize(
    ("look", "message"),
    [
        ("colorized", "Colorize first"),
        ("confidence", "Colorize first"),
        ("nearest_seed", "Colorize first"),
        ("error", "Evaluate first"),
    ],
)
def test_what_cannot_be_shown_says_what_to_do(imported, look, message):
    with pytest.raises(RuntimeError, match=message):
        imported.ops.reflcolor.show_look(look=look)
    assert shown(imported) == "Reflectance_Gray"


def test_a_map_follows_undo_and_redo(colorized):
    bpy = colorized
    bpy.ops.ed.undo_push(message="colorized")
    bpy.ops.reflcolor.show_look(look="confidence")
    bpy.ops.ed.undo_push(message="confidence")
    bpy.ops.reflcolor.show_look(look="range")
    bpy.ops.ed.undo_push(message="range")
    bpy.ops.ed.undo()
    assert shown(bpy) == "Confidence_Map"
    bpy.ops.ed.undo()
    assert shown(bpy) == "Colorized"
    bpy.ops.ed.redo()
    assert shown(bpy) == "Confidence_Map"


def test_a_copy_has_a_map_of_its_own(colorized, legend):
    bpy = colorized
    bpy.ops.reflcolor.show_look(look="range")
    first = bpy.context.active_object
    copy = first.copy()
    copy.data = first.data.copy()
    bpy.context.collection.objects.link(copy)
    bpy.context.view_layer.objects.active = copy
    assert legend.legend_of(copy)["title"] == "Range (m)"
    bpy.ops.reflcolor.show_look(look="confidence")
    assert legend.legend_of(copy)["title"] == "Confidence"
    assert legend.legend_of(first)["title"] == "Range (m)"


def test_colorizing_again_shows_the_colors(colorized):
    colorized.ops.reflcolor.show_look(look="confidence")
    colorized.ops.reflcolor.colorize()
    assert shown(colorized) == "Colorized"
    assert "Confidence_Map" not in colorized.context.active_object.data.color_attributes


def test_evaluating_again_renews_the_map_of_the_error(colorized):
    colorized.ops.reflcolor.show_look(look="error")
    colorized.context.active_object.reflcolor.truth_image = colorized.data.images.new("black", 10, 6)
    colorized.ops.reflcolor.evaluate()
    obj = colorized.context.active_object
    found = values(obj, "error")
    assert shown(colorized) == "Error_Map"
    np.testing.assert_array_equal(srgb(obj, "Error_Map"), painted(found, "inferno", limits_of(found)))


def test_in_edit_mode_it_asks_to_leave_it(colorized):
    colorized.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Leave Edit Mode first"):
        colorized.ops.reflcolor.show_look(look="range")
    colorized.ops.object.mode_set(mode="OBJECT")


def test_the_legend_names_the_ends_of_the_gradient(colorized, legend):
    obj = colorized.context.active_object
    assert legend.legend_of(obj) is None
    colorized.ops.reflcolor.show_look(look="range")
    low, high = limits_of(values(obj, "range"))
    said = legend.legend_of(obj)
    assert [float(label) for label in said["labels"]] == pytest.approx([low, (low + high) / 2, high], abs=0.006)
    assert said["unknown"] is None


def test_the_legend_counts_regions_and_explains_gray(colorized, legend):
    obj = colorized.context.active_object
    colorized.ops.reflcolor.show_look(look="nearest_seed")
    said = legend.legend_of(obj)
    assert said["labels"] == ("Seed 1", "3") and len(said["colors"]) == 3
    colorized.ops.reflcolor.show_look(look="error")
    assert legend.legend_of(obj)["unknown"] == "Not known"


@pytest.mark.parametrize(
    ("value", "span", "text"),
    [(0.5, 1.0, "0.50"), (12.3456, 2.0, "12.35"), (1234.5, 900, "1234"), (0.01234, 0.01, "0.0123"), (3.0, 0.0, "3.00")],
)
def test_numbers_have_the_decimals_that_tell_them_apart(legend, value, span, text):
    assert legend.number(value, span) == text


def test_disabling_takes_the_legend_off(installed_blender, legend):
    assert len(legend._handles) == 1
    legend.unregister()
    assert not legend._handles
    legend.register()
