"""Which Image Editor an image is shown in, in Blender through the installed zip."""

import cv2
import numpy as np
import pytest
from small_scans import random_scan
from test_blender_import import write_small_ptx


@pytest.fixture
def scan(blender, tmp_path):
    """bpy with a scan, two Image Editors that show nothing, and a photo's file."""
    blender.ops.wm.read_homefile(use_factory_startup=True)
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    for area in blender.context.window.screen.areas[:2]:
        area.type = "IMAGE_EDITOR"
        area.spaces.active.image = None
    cv2.imwrite(str(tmp_path / "photo.png"), np.zeros((8, 8, 3), np.uint8))
    return blender


def shown(bpy):
    areas = [area for area in bpy.context.window.screen.areas if area.type == "IMAGE_EDITOR"]
    return [area.spaces.active.image and area.spaces.active.image.name for area in areas]


def test_a_photo_leaves_the_scan_its_editor(scan, tmp_path):
    scan.ops.reflcolor.open_reflectance()
    scan.ops.reflcolor.load_photo(filepath=str(tmp_path / "photo.png"))
    assert sorted(shown(scan)) == ["photo.png", "wall Reflectance"]


def test_the_scan_leaves_a_photo_its_editor(scan, tmp_path):
    scan.ops.reflcolor.load_photo(filepath=str(tmp_path / "photo.png"))
    scan.ops.reflcolor.open_reflectance()
    assert sorted(shown(scan)) == ["photo.png", "wall Reflectance"]


def test_a_second_photo_takes_the_place_of_the_first(scan, tmp_path):
    scan.ops.reflcolor.open_reflectance()
    for name in ("photo.png", "other.png"):
        cv2.imwrite(str(tmp_path / name), np.zeros((8, 8, 3), np.uint8))
        scan.ops.reflcolor.load_photo(filepath=str(tmp_path / name))
    assert sorted(shown(scan)) == ["other.png", "wall Reflectance"]


def test_an_image_that_is_shown_stays_where_it_is(scan, tmp_path):
    scan.ops.reflcolor.open_reflectance()
    before = shown(scan)
    scan.ops.reflcolor.open_reflectance()
    assert shown(scan) == before
