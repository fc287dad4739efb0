"""Menus, search and dropped files in Blender through the installed zip."""

import importlib
import json

import cv2
import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx

# They need a place, a row of a list, or a color that is picked; the tools and lists call them.
CALLED_BY_OTHERS = {"copy_notice", "drop_color", "pick_color", "place_seed", "select_seed", "show_notice"}
SUBMENUS = {"show_look", "apply_preset"}


@pytest.fixture
def menus(installed_blender):
    return importlib.import_module(f"{EXTENSION}.panels.menus")


@pytest.fixture
def files(tmp_path):
    """A folder with two scans, two photos, and seeds."""
    for number in (1, 2):
        write_small_ptx(tmp_path / f"scan{number}.ptx", random_scan(number))
        cv2.imwrite(str(tmp_path / f"photo{number}.png"), np.full((8, 8, 3), 40 * number, np.uint8))
    seeds = {"format": "reflcolor-seeds", "version": 1, "seeds": [{"row": 1, "col": 2, "rgb": [9, 8, 7]}]}
    (tmp_path / "seeds.json").write_text(json.dumps(seeds))
    return tmp_path


@pytest.fixture
def drop(blender):
    """A function that drops files on an editor, as Blender does it once the mouse is released."""

    def dropped(kind, folder, *names):
        window = blender.context.window_manager.windows[0]
        area = window.screen.areas[0]
        area.type = kind
        region = next(region for region in area.regions if region.type == "WINDOW")
        with blender.context.temp_override(window=window, area=area, region=region):
            return blender.ops.wm.drop_import_file(
                "INVOKE_DEFAULT", directory=str(folder), files=[{"name": name} for name in names]
            )

    return dropped


def test_every_act_is_in_the_menu_that_search_looks_into(blender, menus):
    registered = {
        name.removeprefix("REFLCOLOR_OT_")
        for name in dir(blender.types)
        if name.startswith("REFLCOLOR_OT_") and "REGISTER" in getattr(blender.types, name).bl_options
    }
    listed = [name for names in menus.ACTS for name in names]
    assert len(set(listed)) == len(listed)
    assert set(listed) | CALLED_BY_OTHERS | SUBMENUS == registered


@pytest.mark.parametrize("name", ["VIEW3D_MT_object", "IMAGE_MT_image", "VIEW3D_MT_object_context_menu"])
def test_the_menu_is_in_those_of_blender(blender, menus, name):
    drawn = getattr(blender.types, name).draw._draw_funcs
    assert menus.draw_submenu in drawn or menus.draw_context_menu in drawn


def test_several_photos_are_loaded_at_once(blender, files):
    blender.ops.reflcolor.load_photo(directory=str(files), files=[{"name": "photo1.png"}, {"name": "photo2.png"}])
    assert [photo.image.name for photo in blender.context.scene.reflcolor.photos] == ["photo1.png", "photo2.png"]


def test_scans_dropped_on_the_view_are_imported(blender, drop, files):
    drop("VIEW_3D", files, "scan1.ptx", "scan2.ptx")
    assert sorted(obj.name for obj in blender.data.objects if obj.reflcolor.rows) == ["scan1", "scan2"]


def test_photos_dropped_on_the_image_editor_can_be_loaded_where_a_scan_is_active(blender, drop, files):
    def offered():
        return handler.poll_drop(blender.context)

    handler = blender.types.REFLCOLOR_FH_photo
    assert ".png" in handler.bl_file_extensions.split(";") and handler.bl_import_operator == "reflcolor.load_photo"
    # Without a scan Blender opens them; with one it asks, because both could be meant.
    drop("IMAGE_EDITOR", files, "photo1.png")
    area = blender.context.window_manager.windows[0].screen.areas[0]
    with blender.context.temp_override(window=blender.context.window_manager.windows[0], area=area):
        assert not offered()
        blender.ops.reflcolor.import_scan(filepath=str(files / "scan1.ptx"))
        assert offered()
        blender.ops.reflcolor.load_photo(
            "INVOKE_DEFAULT",
            filepath=str(files / "photo1.png"),
            directory=str(files),
            files=[{"name": "photo1.png"}, {"name": "photo2.png"}],
        )
    assert len(blender.context.scene.reflcolor.photos) == 2


def test_seeds_dropped_on_the_image_editor_are_loaded(blender, drop, files):
    blender.ops.reflcolor.import_scan(filepath=str(files / "scan1.ptx"))
    drop("IMAGE_EDITOR", files, "seeds.json")
    assert [(seed.row, seed.col) for seed in blender.context.active_object.reflcolor.seeds] == [(1, 2)]
