"""Colored scans in PLY, read by plyfile, meshio and trimesh."""

from dataclasses import replace

import meshio
import numpy as np
import pytest
import trimesh
from colored_scans import colored_turn, colored_wall, surface_of, tilted_pose, world_points
from plyfile import PlyData

from reflcolor_addon.errors import Cancelled
from reflcolor_addon.files.writers.ply import write_ply
from reflcolor_addon.scan.grid_mesh import grid_mesh


@pytest.fixture
def wall(tmp_path):
    """A colored wall with holes, far from the origin, and its PLY: (scan, rgb, values, path)."""
    scan, rgb, values = colored_wall(pose=tilted_pose((4_500_123.25, -512_345.5, 301.0)))
    write_ply([surface_of(scan, rgb, values)], tmp_path / "wall.ply")
    return scan, rgb, values, tmp_path / "wall.ply"


def test_plyfile_reads_every_return_once_in_the_order_of_the_grid(wall):
    scan, rgb, values, path = wall
    table = PlyData.read(path)["vertex"]
    points = np.stack([table[axis] for axis in "xyz"], axis=1)
    assert points.dtype == np.float64
    np.testing.assert_allclose(points, world_points(scan), rtol=0, atol=1e-9)
    np.testing.assert_array_equal(np.stack([table["grid_row"], table["grid_col"]], axis=1), np.argwhere(scan.valid))
    colors = np.stack([table[channel] for channel in ("red", "green", "blue")], axis=1)
    np.testing.assert_array_equal(colors, rgb[scan.valid])
    for name, grid in {**values, "reflectance": scan.reflectance}.items():
        np.testing.assert_array_equal(table[name], grid[scan.valid])
        assert table[name].dtype == grid.dtype


def test_plyfile_reads_the_faces(wall):
    faces = PlyData.read(wall[-1])["face"]["vertex_indices"]
    np.testing.assert_array_equal(np.stack(faces), grid_mesh(wall[0]).quads)


def test_meshio_reads_points_faces_and_values(wall):
    scan, rgb, values, path = wall
    mesh = meshio.read(path)
    np.testing.assert_allclose(mesh.points, world_points(scan), rtol=0, atol=1e-9)
    np.testing.assert_array_equal(mesh.cells_dict["quad"], grid_mesh(scan).quads)
    # It takes an unsigned byte for a signed one.
    np.testing.assert_array_equal(mesh.point_data["green"].view(np.uint8), rgb[scan.valid][:, 1])
    np.testing.assert_array_equal(mesh.point_data["confidence"], values["confidence"][scan.valid])


def test_trimesh_reads_points_faces_and_colors(wall):
    scan, rgb, _, path = wall
    mesh = trimesh.load(path, process=False)
    np.testing.assert_allclose(mesh.vertices, world_points(scan), rtol=0, atol=1e-9)
    assert len(mesh.faces) == 2 * len(grid_mesh(scan).quads)
    np.testing.assert_array_equal(mesh.visual.vertex_colors[:, :3], rgb[scan.valid])


def test_scans_of_a_site_are_told_apart_and_the_header_names_them(tmp_path):
    scan, rgb, values = colored_wall(pose=tilted_pose())
    drum, colors = colored_turn()
    drum = replace(drum, name="Trommel Süd\nelement x")
    write_ply([surface_of(scan, rgb, values), surface_of(drum, colors)], tmp_path / "site.ply")
    ply = PlyData.read(tmp_path / "site.ply")
    assert any("scan 1: 6 rows x 16 columns: Trommel S\\xfcd\\nelement x" in comment for comment in ply.comments)
    table, first = ply["vertex"], scan.valid.sum()
    np.testing.assert_array_equal(table["scan"], np.repeat([0, 1], [first, drum.valid.sum()]))
    np.testing.assert_array_equal(table["confidence"][first:], 0)
    faces = np.stack(ply["face"]["vertex_indices"])
    np.testing.assert_array_equal(faces[-drum.valid.sum() + 16 :], grid_mesh(drum).quads + first)


def test_the_header_gives_the_pose_back_exactly(wall):
    scan, *_, path = wall
    (line,) = [comment for comment in PlyData.read(path).comments if comment.startswith("pose of scan 0")]
    pose = np.array(line.partition(": ")[2].split(), np.float64).reshape(4, 4)
    np.testing.assert_array_equal(pose, scan.pose)


def test_a_scan_of_one_row_has_its_points(tmp_path):
    scan, rgb, _ = colored_wall()
    row = type(scan)(name="row", points=scan.points[5:6], reflectance=scan.reflectance[5:6], valid=scan.valid[5:6])
    write_ply([surface_of(row, rgb[5:6])], tmp_path / "row.ply")
    assert PlyData.read(tmp_path / "row.ply")["vertex"].count == 12


def test_nothing_is_left_of_a_cancelled_file(tmp_path):
    scan, rgb, _ = colored_wall()
    asked = iter([False, True])
    with pytest.raises(Cancelled):
        write_ply([surface_of(scan, rgb)], tmp_path / "wall.ply", cancelled=lambda: next(asked))
    assert list(tmp_path.iterdir()) == []
