"""Scans that Blender's Join made one object."""

import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import write_small_ptx
from test_blender_site import activate, select

NAMES = ("wall", "floor")


@pytest.fixture
def seeded(blender, tmp_path):
    """bpy with two scans of 6 x 10 pixels and two seeds on each of them; both are selected."""
    for number, name in enumerate(NAMES):
        write_small_ptx(tmp_path / f"{name}.ptx", random_scan(number), np.eye(4))
        blender.ops.reflcolor.import_scan(filepath=str(tmp_path / f"{name}.ptx"))
        activate(blender, name)
        for row in (1, 4):
            blender.ops.reflcolor.add_seed(row=row, col=3, color=[0.8, 0.3, 0.1 + 0.7 * number])
    select(blender, *NAMES)
    return blender


def test_scans_that_are_joined_keep_their_colors_and_are_no_longer_taken_for_one_scan(seeded):
    seeded.ops.reflcolor.colorize()
    colors = [colors_of(seeded.data.objects[name]) for name in NAMES]
    seeded.ops.object.join()
    np.testing.assert_array_equal(colors_of(seeded.data.objects["wall"]), np.concatenate(colors))
    with pytest.raises(RuntimeError, match="another mesh was joined to the scan; undo that, or separate them by mater"):
        seeded.ops.reflcolor.colorize()


def test_scans_that_are_joined_are_rendered_together(seeded):
    points = sum(len(seeded.data.objects[name].data.vertices) for name in NAMES)
    seeded.ops.object.join()
    assert seeded.ops.reflcolor.set_up_render() == {"FINISHED"}
    assert seeded.context.scene.camera is not None
    assert len(seeded.data.objects["wall"].data.vertices) == points


def colors_of(obj):
    attribute = obj.data.color_attributes["Colorized"].data
    rgba = np.empty(4 * len(attribute), np.float32)
    attribute.foreach_get("color_srgb", rgba)
    return rgba
