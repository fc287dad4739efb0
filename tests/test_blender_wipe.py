"""Before and after in Blender through the installed zip: what is laid over what."""

import importlib

import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx


@pytest.fixture
def wipe(installed_blender):
    return importlib.import_module(f"{EXTENSION}.operators.overlays.wipe")


@pytest.fixture
def imported(blender, tmp_path):
    """bpy with a scan and a seed, not colorized; the line shown, a quarter from the left."""
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    blender.ops.reflcolor.add_seed(row=1, col=2, color=(1, 0, 0))
    state = blender.context.window_manager.reflcolor_wipe
    state.show, state.position = True, 0.25
    yield blender
    blender.context.window_manager.reflcolor_wipe.show = False


def laid_over(wipe, bpy, name):
    obj = bpy.context.active_object
    return wipe.overlay(obj, getattr(obj.reflcolor, name), bpy.context.window_manager.reflcolor_wipe)


def test_it_is_off_by_default(blender):
    assert not blender.types.WindowManager.bl_rna.properties["reflcolor_wipe"].fixed_type.properties["show"].default


def test_without_colors_nothing_is_laid_over(imported, wipe):
    assert laid_over(wipe, imported, "reflectance_image") is None


@pytest.mark.parametrize("shown", ["reflectance_image", "range_image"])
def test_the_colors_lie_right_of_the_line(imported, wipe, shown):
    imported.ops.reflcolor.colorize()
    colors = imported.context.active_object.reflcolor.colorized_image
    assert laid_over(wipe, imported, shown) == (colors, 0.25, 1.0)


def test_over_the_colors_the_reflectance_lies_left_of_the_line(imported, wipe):
    imported.ops.reflcolor.colorize()
    state = imported.context.active_object.reflcolor
    assert laid_over(wipe, imported, "colorized_image") == (state.reflectance_image, 0.0, 0.25)
    imported.data.images.remove(state.reflectance_image)
    assert laid_over(wipe, imported, "colorized_image") is None


def test_switched_off_nothing_is_laid_over_but_a_preview_is(imported, wipe):
    imported.ops.reflcolor.colorize()
    imported.context.window_manager.reflcolor_wipe.show = False
    assert laid_over(wipe, imported, "reflectance_image") is None
    state = imported.context.active_object.reflcolor
    state.preview_image = imported.data.images.new("preview", 10, 6)
    assert laid_over(wipe, imported, "reflectance_image") == (state.preview_image, 0.0, 1.0)
    imported.context.window_manager.reflcolor_wipe.show = True
    assert laid_over(wipe, imported, "range_image") == (state.preview_image, 0.25, 1.0)


def test_disabling_takes_it_away(installed_blender):
    window_manager = installed_blender.types.WindowManager
    assert hasattr(window_manager, "reflcolor_wipe")
    installed_blender.ops.preferences.addon_disable(module=EXTENSION)
    try:
        assert not hasattr(window_manager, "reflcolor_wipe")
    finally:
        installed_blender.ops.preferences.addon_enable(module=EXTENSION)
