"""Importing scans into Blender through the installed zip."""

import math
from dataclasses import replace

import numpy as np
import pytest
from e57_samples import e57_with_photo
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import read_scans
from reflcolor_addon.files.writers.ptx import write_ptx
from reflcolor_addon.scan.grid_mesh import grid_mesh


def write_small_ptx(path, scan, pose=None):
    write_ptx(replace(scan, pose=scan.pose if pose is None else pose), path)
    return path


def values(obj, name, dtype=np.float32):
    attribute = obj.data.attributes[name]
    array = np.empty(len(attribute.data), dtype)
    attribute.data.foreach_get("value", array)
    return array


def coordinates(obj):
    array = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", array)
    return array.reshape(-1, 3)


def srgb(obj, name):
    attribute = obj.data.color_attributes[name]
    array = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color_srgb", array)
    return np.rint(array.reshape(-1, 4)[:, :3] * 255).astype(np.uint8)


def pixels(image):
    array = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(array)
    return array.reshape(image.size[1], image.size[0], -1)[::-1]


@pytest.fixture
def small(tmp_path):
    """A scan file of 6 x 10 pixels, one of them without return."""
    valid = np.ones((6, 10), bool)
    valid[2, 3] = False
    flat = scan_from_ranges(np.full((6, 10), 3.0), np.linspace(0, 1, 60).reshape(6, 10), valid)
    return write_small_ptx(tmp_path / "small.ptx", flat)


def test_a_vertex_stands_for_every_return_with_its_attributes(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    obj, (scan,) = blender.context.active_object, read_scans(small)
    rows, cols = values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)
    assert len(rows) == 59 and (2, 3) not in set(zip(rows.tolist(), cols.tolist(), strict=True))
    np.testing.assert_allclose(coordinates(obj), scan.points[rows, cols], atol=1e-6)
    np.testing.assert_array_equal(values(obj, "reflectance"), scan.reflectance[rows, cols])
    np.testing.assert_allclose(values(obj, "range"), scan.range[rows, cols], rtol=1e-6)


def test_faces_look_at_the_scanner_and_spare_missing_corners(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    mesh = blender.context.active_object.data
    assert len(mesh.polygons) == 5 * 9 - 4
    assert not mesh.validate()
    assert all(polygon.normal.dot(polygon.center) < 0 for polygon in mesh.polygons)


def test_the_mesh_is_what_blender_makes_of_its_vertices_and_faces_one_by_one(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    (scan,) = read_scans(small)
    plain = blender.data.meshes.new("plain")
    plain.from_pydata(scan.points[scan.valid].astype(np.float32), [], grid_mesh(scan).quads)
    meshes = blender.context.active_object.data, plain
    for elements, name, dtype, width in (
        ("vertices", "co", np.float32, 3),
        ("vertices", "normal", np.float32, 3),
        ("loops", "vertex_index", np.int32, 1),
        ("polygons", "loop_start", np.int32, 1),
        ("polygons", "loop_total", np.int32, 1),
        ("polygons", "normal", np.float32, 3),
    ):
        found, expected = (np.empty(width * len(getattr(mesh, elements)), dtype) for mesh in meshes)
        for mesh, array in zip(meshes, (found, expected), strict=True):
            getattr(mesh, elements).foreach_get(name, array)
        np.testing.assert_array_equal(found, expected, err_msg=f"{elements}.{name}")
    # The order of edges is ours; each is there once, and every corner has its own.
    ends = [np.sort([tuple(edge.vertices) for edge in mesh.edges]) for mesh in meshes]
    np.testing.assert_array_equal(*(np.unique(each, axis=0) for each in ends))
    assert len(ends[0]) == len(ends[1])
    corners = [each[[loop.edge_index for loop in mesh.loops]] for each, mesh in zip(ends, meshes, strict=True)]
    np.testing.assert_array_equal(*corners)


def test_a_scan_of_a_single_return_has_a_vertex_and_no_face(blender, tmp_path):
    valid = np.zeros((6, 10), bool)
    valid[2, 3] = True
    path = write_small_ptx(tmp_path / "one.ptx", replace(random_scan(), valid=valid))
    blender.ops.reflcolor.import_scan(filepath=str(path))
    mesh = blender.context.active_object.data
    assert (len(mesh.vertices), len(mesh.edges), len(mesh.polygons)) == (1, 0, 0)
    (scan,) = read_scans(path)
    np.testing.assert_array_equal(
        coordinates(blender.context.active_object), scan.points[scan.valid].astype(np.float32)
    )


def test_the_uv_map_is_the_scan_grid(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    obj = blender.context.active_object
    rows, cols = values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)
    for loop, uv in zip(obj.data.loops, obj.data.uv_layers.active.uv, strict=True):
        row, col = rows[loop.vertex_index], cols[loop.vertex_index]
        assert uv.vector.x == pytest.approx((col + 0.5) / 10) and uv.vector.y == pytest.approx(1 - (row + 0.5) / 6)


def test_a_jump_edge_has_no_face_until_the_grazing_angle_allows_it():
    ranges = np.full((4, 10), 3.0)
    ranges[:, 5:] = 90.0
    scan = scan_from_ranges(ranges, np.zeros((4, 10)))
    assert len(grid_mesh(scan).quads) == 3 * 8
    assert len(grid_mesh(scan, max_incidence_deg=90).quads) == 3 * 9


def test_a_full_turn_closes_its_seam_without_turning_the_texture_back():
    scan = scan_from_ranges(np.full((4, 36), 3.0), np.zeros((4, 36)), azimuth_deg=360)
    mesh = grid_mesh(scan)
    assert len(mesh.quads) == 3 * 36
    assert np.ptp(mesh.uv[..., 0], axis=1).max() == pytest.approx(1 / 36)


def test_the_gray_of_the_reflectance_is_seen_at_once(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    obj = blender.context.active_object
    attributes = obj.data.color_attributes
    assert attributes.active_color_name == attributes[attributes.render_color_index].name == "Reflectance_Gray"
    gray = srgb(obj, "Reflectance_Gray")
    assert gray[0].max() == 0 and gray[-1].min() == 255 and (np.diff(gray[:, 0].astype(int)) >= 0).all()
    nodes = obj.data.materials[0].node_tree.nodes
    assert [node.attribute_name for node in nodes if node.type == "ATTRIBUTE"] == ["Reflectance_Gray"]


def test_reflectance_and_range_images_stay_in_the_file(blender, small, tmp_path):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    state = blender.context.active_object.reflcolor
    for image in (state.reflectance_image, state.range_image):
        assert image.packed_file and tuple(image.size) == (10, 6)
    # The reflectance is to be looked at, beside its colors; the range is numbers.
    assert not state.reflectance_image.colorspace_settings.is_data
    assert state.range_image.colorspace_settings.is_data
    shown = pixels(state.reflectance_image)[..., 0]
    assert shown[0, 0] == 0 and shown[5, 9] == 1 and shown[2, 3] == 0


def test_the_pose_becomes_the_objects_matrix(blender, tmp_path):
    pose = np.array([[0, -1, 0, 5.0], [1, 0, 0, -2.0], [0, 0, 1, 0.5], [0, 0, 0, 1]])
    path = write_small_ptx(tmp_path / "posed.ptx", random_scan(), pose)
    blender.ops.reflcolor.import_scan(filepath=str(path))
    np.testing.assert_allclose(np.array(blender.context.active_object.matrix_world), pose, atol=1e-6)


def test_far_coordinates_are_shifted_and_the_shift_is_kept(blender, tmp_path):
    poses = [np.eye(4), np.eye(4)]
    poses[0][:3, 3], poses[1][:3, 3] = (637_012.25, 849_028.5, 431.5), (637_018.75, 849_020.0, 431.5)
    for index, pose in enumerate(poses):
        path = write_small_ptx(tmp_path / f"far{index}.ptx", random_scan(index), pose)
        blender.ops.reflcolor.import_scan(filepath=str(path))
    for index, pose in enumerate(poses):
        obj = blender.data.objects[f"far{index}"]
        place = np.array(obj.matrix_world)[:3, 3]
        assert np.abs(place).max() < 10_000
        np.testing.assert_allclose(place + np.array(obj["reflcolor_shift"]), pose[:3, 3], atol=1e-3)
    shifts = {tuple(obj["reflcolor_shift"]) for obj in blender.data.objects}
    assert len(shifts) == 1


def test_points_stored_in_world_coordinates_keep_their_millimeters(blender, data_dir):
    path = data_dir / "robust" / "ptx" / "1.2-with-color.ptx"
    blender.ops.reflcolor.import_scan(filepath=str(path))
    obj, (scan,) = blender.context.active_object, read_scans(path)
    world = coordinates(obj) + np.array(obj.matrix_world)[:3, 3] + np.array(obj["reflcolor_shift"])
    rows, cols = values(obj, "grid_row", np.int32), values(obj, "grid_col", np.int32)
    np.testing.assert_allclose(world, scan.points[rows, cols], atol=2e-3)


def test_meters_follow_the_scenes_unit_scale(blender, small):
    blender.context.scene.unit_settings.scale_length = 0.01
    blender.ops.reflcolor.import_scan(filepath=str(small))
    np.testing.assert_allclose(np.linalg.norm(coordinates(blender.context.active_object), axis=1), 300, rtol=1e-5)


def test_several_scans_of_a_file_become_an_object_each(blender, tmp_path):
    path = tmp_path / "site.ptx"
    write_ptx([random_scan(index) for index in range(3)], path)
    blender.ops.reflcolor.import_scan(filepath=str(path))
    assert len([obj for obj in blender.data.objects if obj.reflcolor.rows == 6]) == 3


def test_two_images_picked_together_are_described_and_imported(blender, tmp_path):
    import cv2

    depth = np.full((8, 16), 2000, np.uint16)
    cv2.imwrite(str(tmp_path / "depth.png"), depth)
    cv2.imwrite(str(tmp_path / "ir.png"), np.tile(np.arange(16, dtype=np.uint16) * 1000, (8, 1)))
    blender.ops.reflcolor.import_scan(
        filepath=str(tmp_path / "ir.png"),
        directory=str(tmp_path),
        files=[{"name": "ir.png"}, {"name": "depth.png"}],
        sensor="spherical",
        azimuth_left=math.radians(-40),
        azimuth_right=math.radians(40),
        elevation_bottom=math.radians(-20),
        elevation_top=math.radians(20),
        range_scale=0.001,
    )
    obj = blender.context.active_object
    assert (obj.reflcolor.rows, obj.reflcolor.cols) == (8, 16)
    np.testing.assert_allclose(np.linalg.norm(coordinates(obj), axis=1), 2.0, rtol=1e-5)
    (described,) = tmp_path.glob("*.scan.json")
    again = read_scans(described)[0]
    np.testing.assert_allclose(again.points[again.valid], coordinates(obj), atol=1e-5)


def test_photos_picked_with_a_pair_or_with_a_scan_are_put_on_the_list(blender, small, tmp_path):
    import cv2

    images = {"depth.png": np.full((8, 16), 2000, np.uint16), "ir.png": np.full((8, 16), 9, np.uint8)}
    for name, pixels in (images | {"view.png": np.full((30, 40, 3), 9, np.uint8)}).items():
        cv2.imwrite(str(tmp_path / name), pixels)
    for picked in (("depth.png", "ir.png", "view.png"), (small.name, "view.png")):
        blender.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        blender.ops.reflcolor.import_scan(
            filepath=str(tmp_path / picked[0]), directory=str(tmp_path), files=[{"name": name} for name in picked]
        )
        (photo,) = blender.context.scene.reflcolor.photos
        assert photo.image.name == "view.png" and len([obj for obj in blender.data.objects if obj.reflcolor.rows]) == 1
    # Those that a description names are no photos.
    (described,) = tmp_path.glob("*.scan.json")
    blender.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    names = (described.name, "depth.png", "ir.png", "view.png")
    blender.ops.reflcolor.import_scan(
        filepath=str(described), directory=str(tmp_path), files=[{"name": name} for name in names]
    )
    assert [photo.image.name for photo in blender.context.scene.reflcolor.photos] == ["view.png"]


def test_flipping_mirrors_the_grid_and_keeps_the_points(blender, small):
    blender.ops.reflcolor.import_scan(filepath=str(small))
    plain = blender.context.active_object
    blender.ops.reflcolor.import_scan(filepath=str(small), flip_vertical=True)
    turned = blender.context.active_object
    np.testing.assert_array_equal(values(plain, "grid_row", np.int32)[0], 0)
    top = {tuple(point) for point in coordinates(plain)[values(plain, "grid_row", np.int32) == 0].tolist()}
    bottom = {tuple(point) for point in coordinates(turned)[values(turned, "grid_row", np.int32) == 5].tolist()}
    assert top == bottom


@pytest.mark.parametrize("content", ["", "3\n2\nnonsense\n", "1000000\n1000000\n0 0 0\n"])
def test_a_bad_file_is_one_line_and_leaves_nothing(blender, tmp_path, content):
    path = tmp_path / "bad.ptx"
    path.write_text(content)
    before = len(blender.data.objects), len(blender.data.meshes), len(blender.data.images)
    with pytest.raises(RuntimeError, match=r"bad\.ptx") as error:
        blender.ops.reflcolor.import_scan(filepath=str(path))
    assert "Traceback" not in str(error.value)
    assert (len(blender.data.objects), len(blender.data.meshes), len(blender.data.images)) == before


def test_the_scans_own_color_comes_along(blender, tmp_path):
    scan = random_scan()
    color = np.random.default_rng(1).integers(0, 256, (6, 10, 3), np.uint8)
    path = write_small_ptx(tmp_path / "colored.ptx", replace(scan, color=color))
    blender.ops.reflcolor.import_scan(filepath=str(path))
    np.testing.assert_array_equal(srgb(blender.context.active_object, "Scanned_Color"), color.reshape(-1, 3))


def test_a_guessed_sensor_is_enough_for_two_images(blender, tmp_path, capfd):
    import cv2

    cv2.imwrite(str(tmp_path / "depth.png"), np.full((24, 32), 2000, np.uint16))
    cv2.imwrite(str(tmp_path / "ir.png"), np.arange(768, dtype=np.uint16).reshape(24, 32))
    files = {"directory": str(tmp_path), "files": [{"name": "ir.png"}, {"name": "depth.png"}]}
    blender.ops.reflcolor.import_scan(filepath=str(tmp_path / "ir.png"), **files)
    obj = blender.context.active_object
    np.testing.assert_allclose(coordinates(obj)[:, 1], 2.0, rtol=1e-5)
    around = {"azimuth_left": -math.pi, "azimuth_right": math.pi, "range_scale": 1e-4}
    capfd.readouterr()
    blender.ops.reflcolor.import_scan(filepath=str(tmp_path / "ir.png"), **files, sensor="spherical", **around)
    assert "as in a bowl" in capfd.readouterr().out


def test_photos_inside_an_e57_are_put_on_the_list_with_their_place(blender, tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (40, 60, 3), np.uint8)
    path = e57_with_photo(tmp_path / "room.e57", picture)
    blender.ops.reflcolor.import_scan(filepath=str(path))
    (listed,) = blender.context.scene.reflcolor.photos
    np.testing.assert_array_equal(np.rint(pixels(listed.image)[..., :3] * 255), picture)
    np.testing.assert_allclose(listed.image["reflcolor_place"][9:], (1, 2, 3, 35))
    blender.ops.reflcolor.remove_photo()
    blender.ops.reflcolor.import_scan(filepath=str(path), photos_inside=False)
    assert not blender.context.scene.reflcolor.photos
    blender.ops.reflcolor.load_photo(filepath=str(path), swap_red_blue=True)
    (listed,) = blender.context.scene.reflcolor.photos
    np.testing.assert_array_equal(np.rint(pixels(listed.image)[..., :3] * 255), picture[..., ::-1])
