"""Set Up Render: a camera that shows the scan, and light."""

import math

import numpy as np
import pytest
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon.files.writers.ptx import write_ptx


def import_scan(blender, folder, scan):
    write_ptx(scan, folder / "scan.ptx")
    blender.ops.reflcolor.import_scan(filepath=str(folder / "scan.ptx"))
    return blender.context.active_object


def seen_by_camera(blender, obj):
    """(N, 2) places of the vertices in the camera's picture, 0..1, and (N,) their depths."""
    from bpy_extras.object_utils import world_to_camera_view

    blender.context.view_layer.update()
    scene = blender.context.scene
    seen = np.array([world_to_camera_view(scene, scene.camera, obj.matrix_world @ v.co) for v in obj.data.vertices])
    return seen[:, :2], seen[:, 2]


def test_the_camera_has_all_of_a_narrow_scan_in_its_picture(blender, tmp_path):
    scan = random_scan(1, (20, 30))
    scan.pose[:3, 3] = 3, -4, 1
    obj = import_scan(blender, tmp_path, scan)
    blender.ops.reflcolor.set_up_render()
    seen, depth = seen_by_camera(blender, obj)
    camera = blender.context.scene.camera
    assert seen.min() >= 0 and seen.max() <= 1
    assert np.ptp(seen, axis=0).max() > 0.9
    assert camera.data.clip_start < depth.min() and depth.max() < camera.data.clip_end
    assert (camera.location - obj.location).length < 0.6 * np.percentile(scan.range, 5)


def test_the_camera_is_the_same_when_set_up_in_edit_mode(blender, tmp_path):
    import_scan(blender, tmp_path, random_scan())
    places = []
    for mode in ("OBJECT", "EDIT"):
        blender.ops.object.mode_set(mode=mode)
        blender.ops.reflcolor.set_up_render()
        places.append(tuple(blender.context.scene.camera.location))
    assert places[0] == places[1]


def test_the_camera_looks_down_at_a_scan_all_around(blender, tmp_path):
    scan = scan_from_ranges(np.full((12, 72), 4.0), np.zeros((12, 72)), azimuth_deg=360)
    obj = import_scan(blender, tmp_path, scan)
    blender.ops.reflcolor.set_up_render()
    seen, _ = seen_by_camera(blender, obj)
    assert seen.min() >= 0 and seen.max() <= 1
    assert blender.context.scene.camera.location.z > 4


@pytest.mark.parametrize("scale_length", [1.0, 0.01])
def test_what_was_set_up_before_makes_room(blender, tmp_path, scale_length):
    blender.context.scene.unit_settings.scale_length = scale_length
    import_scan(blender, tmp_path, random_scan())
    for _ in range(2):
        blender.ops.reflcolor.set_up_render()
        added = [other.type for other in blender.data.objects if other.type != "MESH"]
        assert sorted(added) == ["CAMERA", "LIGHT", "LIGHT", "LIGHT"]
    assert math.degrees(blender.context.scene.camera.data.angle) < 100
