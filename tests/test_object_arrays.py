"""A scan as the arrays that an object of Blender is made of."""

from dataclasses import replace

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon.scan.grid_mesh import grid_mesh
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.scan.object_arrays import object_arrays

SHAPE = (12, 18)


@pytest.fixture
def scan():
    """A scan with holes, a pose and colors of its own."""
    random = np.random.default_rng(3)
    pose = np.array([[0, -1, 0, 50.0], [1, 0, 0, -20.0], [0, 0, 1, 5.0], [0, 0, 0, 1]])
    color = random.integers(0, 256, (*SHAPE, 3), np.uint8)
    return replace(random_scan(2, SHAPE), valid=random.random(SHAPE) > 0.2, pose=pose, color=color)


def test_every_array_is_as_blender_stores_it(scan):
    arrays, mesh, valid = object_arrays(scan), grid_mesh(scan), scan.valid
    luminance, _ = normalize(scan.reflectance, valid)
    expected = {
        "coordinates": scan.points[valid].astype(np.float32).ravel(),
        "corners": mesh.quads.astype(np.int32).ravel(),
        "edges": mesh.edges.astype(np.int32).ravel(),
        "corner_edges": mesh.face_edges.astype(np.int32).ravel(),
        "uv": mesh.uv.astype(np.float32).ravel(),
        "gray": np.tile(np.rint(luminance[valid]).astype(np.uint8)[:, None], 3),
        "scanned": scan.color[valid],
        "reflectance_image": luminance / np.float32(255),
        "range_image": normalize(scan.range, valid)[0] / np.float32(255),
    }
    for name, array in expected.items():
        found = getattr(arrays, name)
        assert found.dtype == array.dtype and found.flags.c_contiguous, name
        np.testing.assert_array_equal(found, array, err_msg=name)
    rows, cols = np.nonzero(valid)
    values = {"reflectance": scan.reflectance[valid], "range": scan.range[valid], "grid_row": rows, "grid_col": cols}
    assert list(arrays.values) == list(values)
    for name, found in arrays.values.items():
        assert found.dtype == (np.int32 if name.startswith("grid") else np.float32)
        np.testing.assert_array_equal(found, values[name].astype(found.dtype))


def test_coordinates_are_in_blenders_units_and_the_pose_in_meters(scan):
    arrays = object_arrays(scan, units_per_meter=100.0)
    np.testing.assert_array_equal(arrays.coordinates.reshape(-1, 3), (scan.points[scan.valid] * 100).astype(np.float32))
    np.testing.assert_array_equal(arrays.pose, scan.pose)
    assert arrays.units_per_meter == 100


def test_points_in_world_coordinates_are_measured_from_a_center_that_the_pose_holds(scan):
    far = replace(scan, points=scan.points + [637_012.25, 849_028.5, 31.5])
    arrays = object_arrays(far)
    assert np.abs(arrays.coordinates).max() < 1000
    world = arrays.coordinates.reshape(-1, 3).astype(np.float64) @ arrays.pose[:3, :3].T + arrays.pose[:3, 3]
    np.testing.assert_allclose(world, far.points[far.valid] @ scan.pose[:3, :3].T + scan.pose[:3, 3], atol=1e-4)


def test_the_grazing_angle_decides_which_faces_there_are(scan):
    assert (
        object_arrays(scan, max_incidence_deg=90).corners.size > object_arrays(scan, max_incidence_deg=10).corners.size
    )


def test_a_scan_without_colors_has_none(scan):
    assert object_arrays(replace(scan, color=None)).scanned is None
