"""Evaluating colors in Blender through the installed zip."""

import re
from dataclasses import replace

import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import values, write_small_ptx

from reflcolor_addon import Seeds, Settings, colorize, evaluate, read_scans
from reflcolor_addon.color.evaluation import error_map
from reflcolor_addon.files.images import write_png

NATURAL = Settings.preset("Natural")
SEEDS = Seeds([0, 5], [0, 9], np.array([[200, 80, 40], [20, 90, 220]], np.uint8))


@pytest.fixture
def scan_file(tmp_path):
    """A scan of 6 x 10 pixels with colors of its own: one pixel without return, one black."""
    valid = np.ones((6, 10), bool)
    valid[2, 3] = False
    color = np.random.default_rng(1).integers(1, 256, (6, 10, 3), np.uint8)
    color[4, 4] = 0
    return write_small_ptx(tmp_path / "wall.ptx", replace(random_scan(3, valid=valid), color=color))


@pytest.fixture
def colorized(blender, scan_file):
    """bpy with that scan, colorized from two seeds."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    for row, col, rgb in zip(SEEDS.rows, SEEDS.cols, SEEDS.rgb / 255, strict=True):
        blender.ops.reflcolor.add_seed(row=int(row), col=int(col), color=rgb.tolist())
    blender.ops.reflcolor.colorize()
    return blender


def by_vertex(obj, image):
    return image[values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)]


def test_the_error_of_every_vertex_is_the_cores(colorized, scan_file):
    assert colorized.ops.reflcolor.evaluate() == {"FINISHED"}
    obj, (scan,) = colorized.context.active_object, read_scans(scan_file)
    seen = scan.valid & scan.color.any(axis=-1)
    expected = by_vertex(obj, np.nan_to_num(error_map(colorize(scan, SEEDS, NATURAL).rgb, scan.color, seen), nan=-1))
    found = values(obj, "error")
    # A level more or less in 8 bits, on the way through Blender's colors.
    assert found == pytest.approx(expected, abs=0.7)
    assert (found < 0).sum() == 1


def test_mean_and_percentile_are_reported(colorized, scan_file, capfd):
    (scan,) = read_scans(scan_file)
    figures = evaluate(colorize(scan, SEEDS, NATURAL).rgb, scan.color, scan.valid & scan.color.any(axis=-1))["as_is"]
    colorized.ops.reflcolor.evaluate()
    found = values(colorized.context.active_object, "error")
    assert found[found >= 0].mean() == pytest.approx(figures["ciede2000_mean"], abs=0.1)
    said = re.search(r"wall: mean CIEDE2000 ([\d.]+), below ([\d.]+) at 95 % of 58", capfd.readouterr().out)
    reported = [float(number) for number in said.groups()]
    assert reported == pytest.approx([figures["ciede2000_mean"], figures["ciede2000_p95"]], abs=0.3)


def test_an_image_of_the_grids_size_is_the_truth(colorized, scan_file, tmp_path):
    (scan,) = read_scans(scan_file)
    truth = np.random.default_rng(2).integers(0, 256, (6, 10, 3), np.uint8)
    write_png(tmp_path / "truth.png", truth)
    image = colorized.data.images.load(str(tmp_path / "truth.png"))
    obj = colorized.context.active_object
    expected = by_vertex(obj, error_map(colorize(scan, SEEDS, NATURAL).rgb, truth, scan.valid))
    colorized.ops.reflcolor.evaluate(truth=image.name)
    by_name = values(obj, "error")
    assert by_name == pytest.approx(expected, abs=0.7)
    obj.reflcolor.truth_image = image
    colorized.ops.reflcolor.evaluate()
    assert (values(obj, "error") == by_name).all()


def test_deleting_vertices_leaves_the_others_errors(colorized):
    import bmesh

    colorized.ops.reflcolor.evaluate()
    obj = colorized.context.active_object
    before = values(obj, "error")[5:]
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    edited.verts.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=edited.verts[:5], context="VERTS")
    edited.to_mesh(obj.data)
    edited.free()
    colorized.ops.reflcolor.evaluate()
    assert values(obj, "error") == pytest.approx(before)


def test_it_can_be_undone_as_one_step(colorized):
    colorized.ops.ed.undo_push(message="before")
    colorized.ops.reflcolor.evaluate()
    colorized.ops.ed.undo_push(message="evaluated")
    colorized.ops.ed.undo()
    assert "error" not in colorized.context.active_object.data.attributes


def test_images_of_another_size_or_none_are_one_clear_line(colorized):
    colorized.data.images.new("small", 4, 3)
    with pytest.raises(RuntimeError, match="small: is 4 x 3 pixels, but the scan wall has 10 columns x 6 rows"):
        colorized.ops.reflcolor.evaluate(truth="small")
    with pytest.raises(RuntimeError, match="there is no image gone; open it first"):
        colorized.ops.reflcolor.evaluate(truth="gone")
    assert "error" not in colorized.context.active_object.data.attributes


def test_a_scan_without_colors_needs_an_image(colorized):
    mesh = colorized.context.active_object.data
    mesh.color_attributes.remove(mesh.color_attributes["Scanned_Color"])
    with pytest.raises(RuntimeError, match="the scan came without colors; choose an image"):
        colorized.ops.reflcolor.evaluate()


def test_it_says_what_is_missing(blender, scan_file):
    with pytest.raises(RuntimeError, match="Import a scan"):
        blender.ops.reflcolor.evaluate()
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    with pytest.raises(RuntimeError, match="Colorize the scan first"):
        blender.ops.reflcolor.evaluate()
