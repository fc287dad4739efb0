"""Colored scans in GLB, held against the Khronos validator and read by trimesh and by the specification."""

import io
from dataclasses import replace

import cv2
import numpy as np
import pytest
import trimesh
from colored_scans import colored_turn, colored_wall, surface_of, tilted_pose, world_points
from gltf_files import Glb, encoded

from reflcolor_addon.errors import Cancelled, OutputError
from reflcolor_addon.files.writers import glb as glb_module
from reflcolor_addon.files.writers.glb import check_glb_size, write_glb
from reflcolor_addon.scan.scan import Scan
from reflcolor_addon.srgb import srgb8_to_linear


@pytest.fixture
def wall(tmp_path):
    """A colored wall with holes, tilted, and its GLB: (scan, rgb, values, path)."""
    scan, rgb, values = colored_wall(pose=tilted_pose())
    write_glb([surface_of(scan, rgb, values)], tmp_path / "wall.glb")
    return scan, rgb, values, tmp_path / "wall.glb"


def test_khronos_has_nothing_to_say(gltf_validator, wall, tmp_path):
    scan, rgb, values, path = wall
    # Sides of a power of two: it mentions others.
    drum, colors = colored_turn((8, 16))
    textured = surface_of(drum, colors, split_seam=True)
    far = replace(scan, pose=tilted_pose((4_500_123.25, -512_345.5, 301.0)))
    sheared = scan.pose.copy()
    sheared[0] *= -1.5
    write_glb([textured, surface_of(drum, colors)], tmp_path / "two.glb", textures=[png(colors), None])
    write_glb([surface_of(far, rgb, values)], tmp_path / "far.glb")
    write_glb([surface_of(replace(scan, pose=sheared), rgb)], tmp_path / "sheared.glb")
    for made in (path, tmp_path / "two.glb", tmp_path / "far.glb", tmp_path / "sheared.glb"):
        assert gltf_validator(made)["issues"]["messages"] == []


def test_every_return_is_there_at_its_place(wall):
    scan, *_, path = wall
    glb = Glb(path)
    np.testing.assert_allclose(glb.world_points(), world_points(scan), atol=1e-5)
    in_faces = np.unique(glb.array(glb.primitive()["indices"]))
    points = glb.array(glb.primitive(mode=0)["indices"])[:, 0]
    np.testing.assert_array_equal(np.sort(np.concatenate([in_faces, points])), np.arange(scan.valid.sum()))
    assert scan.valid[0, 0] and 0 in points


def test_colors_come_back_to_the_byte_from_linear_light(wall):
    scan, rgb, _, path = wall
    np.testing.assert_array_equal(encoded(Glb(path).attribute("COLOR_0")), rgb[scan.valid])


def test_each_of_the_256_levels_comes_back(tmp_path):
    scan, rgb, _ = colored_wall(shape=(16, 16))
    scan, rgb = replace(scan, valid=np.ones((16, 16), bool)), np.repeat(np.arange(256).reshape(16, 16, 1), 3, axis=2)
    write_glb([surface_of(scan, rgb.astype(np.uint8))], tmp_path / "levels.glb")
    colors = Glb(tmp_path / "levels.glb").attribute("COLOR_0")
    np.testing.assert_array_equal(encoded(colors), rgb.reshape(-1, 3))


def test_values_are_attributes_of_an_application(wall):
    scan, _, values, path = wall
    glb, rows_cols = Glb(path), np.argwhere(scan.valid)
    for name, expected in {
        "_CONFIDENCE": values["confidence"][scan.valid],
        "_NEAREST_SEED": values["nearest_seed"][scan.valid],
        "_REFLECTANCE": scan.reflectance[scan.valid],
        "_GRID_ROW": rows_cols[:, 0],
        "_GRID_COL": rows_cols[:, 1],
    }.items():
        np.testing.assert_array_equal(glb.attribute(name)[:, 0], expected)


def test_trimesh_reads_surface_and_points(wall):
    scan, *_, path = wall
    parts = trimesh.load(path, process=False).dump()
    meshes = [part for part in parts if isinstance(part, trimesh.Trimesh)]
    clouds = [part for part in parts if isinstance(part, trimesh.PointCloud)]
    assert len(meshes) == len(clouds) == 1
    surface = surface_of(scan, np.zeros((*scan.shape, 3), np.uint8))
    assert len(meshes[0].faces) == 2 * surface.face_count
    # Y is up in glTF; seen from the scanner, so that the faces look at it.
    towards = (scan.pose[:3, 3] * [1, 1, 1])[[0, 2, 1]] * [1, 1, -1] - meshes[0].triangles_center
    assert (np.einsum("ij,ij->i", meshes[0].face_normals, towards) > 0).all()


def test_trimesh_reads_the_linear_colors(wall):
    scan, rgb, *_, path = wall
    linear = srgb8_to_linear(rgb[scan.valid])
    surface, points = trimesh.load(path, process=False).geometry.values()
    np.testing.assert_allclose(surface.visual.vertex_attributes["color"], linear, atol=1e-6)
    np.testing.assert_array_equal(points.colors[:, :3], np.rint(255 * linear))


def test_the_shift_of_a_far_scan_is_told_and_keeps_millimeters(tmp_path):
    scan, rgb, _ = colored_wall(pose=tilted_pose((4_500_123.25, -512_345.5, 301.0)))
    write_glb([surface_of(scan, rgb)], tmp_path / "far.glb")
    glb = Glb(tmp_path / "far.glb")
    assert glb.document["scenes"][0]["extras"]["reflcolor_shift"] == [4_500_000, -512_000, 0]
    np.testing.assert_allclose(glb.world_points(), world_points(scan), atol=1e-4)


def test_scans_of_a_site_are_nodes_of_one_scene(tmp_path):
    scan, rgb, _ = colored_wall(pose=tilted_pose())
    drum, colors = colored_turn()
    write_glb([surface_of(scan, rgb), surface_of(drum, colors)], tmp_path / "site.glb")
    glb = Glb(tmp_path / "site.glb")
    assert [node["name"] for node in glb.document["nodes"]] == ["wall", "drum"]
    np.testing.assert_allclose(glb.world_points(1), world_points(drum), atol=1e-5)


def test_a_pose_that_mirrors_keeps_the_faces_turned_to_the_scanner(tmp_path):
    scan, rgb, _ = colored_wall(pose=np.diag([1.0, -1.0, 1.0, 1.0]))
    write_glb([surface_of(scan, rgb)], tmp_path / "mirrored.glb")
    glb = Glb(tmp_path / "mirrored.glb")
    np.testing.assert_allclose(glb.world_points(), world_points(scan), atol=1e-5)
    points = glb.attribute("POSITION")[glb.array(glb.primitive()["indices"]).reshape(-1, 3)]
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    assert (np.einsum("ij,ij->i", normals, points.mean(axis=1)) < 0).all()


def test_a_scan_of_one_row_is_points(tmp_path, gltf_validator):
    scan, rgb, _ = colored_wall()
    row = Scan(name="row", points=scan.points[5:6], reflectance=scan.reflectance[5:6], valid=scan.valid[5:6])
    write_glb([surface_of(row, rgb[5:6])], tmp_path / "row.glb")
    glb = Glb(tmp_path / "row.glb")
    assert glb.primitive() is None and len(glb.array(glb.primitive(mode=0)["indices"])) == 12
    assert gltf_validator(tmp_path / "row.glb")["issues"]["messages"] == []


def test_a_texture_is_embedded_and_lies_on_the_grid(tmp_path):
    drum, colors = colored_turn()
    surface, image = surface_of(drum, colors, split_seam=True), png(colors)
    write_glb([surface], tmp_path / "drum.glb", textures=[image])
    glb = Glb(tmp_path / "drum.glb")
    assert "COLOR_0" not in glb.primitive()["attributes"]
    uv = glb.attribute("TEXCOORD_0")[glb.array(glb.primitive()["indices"]).reshape(-1, 3)]
    np.testing.assert_allclose(np.ptp(uv[..., 0], axis=1), 1 / 16, atol=1e-6)
    (stored,) = glb.document["images"]
    assert glb.bytes_of(stored["bufferView"]) == image


def test_what_does_not_fit_into_4_gib_is_refused_by_its_size_and_with_the_way_out(monkeypatch, tmp_path):
    scan, rgb, values = colored_wall()
    surface = surface_of(scan, rgb, values)
    write_glb([surface], tmp_path / "fits.glb")
    size = (tmp_path / "fits.glb").stat().st_size
    monkeypatch.setattr(glb_module, "_JSON_PER_SCAN", 0)
    monkeypatch.setattr(glb_module, "_LARGEST", size // 2)
    with pytest.raises(OutputError, match=r"wall\.glb: .*4 GiB.*--faces"):
        write_glb([surface], tmp_path / "wall.glb")
    monkeypatch.setattr(glb_module, "_LARGEST", size)
    check_glb_size([surface], tmp_path / "wall.glb")
    assert not (tmp_path / "wall.glb").exists()


def test_nothing_is_left_of_a_cancelled_file(tmp_path):
    scan, rgb, _ = colored_wall()
    asked = iter([False, False, True])
    with pytest.raises(Cancelled):
        write_glb([surface_of(scan, rgb)], tmp_path / "wall.glb", cancelled=lambda: next(asked))
    assert list(tmp_path.iterdir()) == []


def png(image):
    """The PNG file of an image."""
    return io.BytesIO(cv2.imencode(".png", image[..., ::-1])[1]).getvalue()
