"""A colored scan handed out strip by strip: nothing is lost between strips, at holes and at a full turn's seam."""

from dataclasses import replace

import numpy as np
import pytest
from colored_scans import colored_turn, colored_wall, surface_of

from reflcolor_addon.scan import grid_mesh as grid_module
from reflcolor_addon.scan.grid_mesh import grid_mesh


@pytest.fixture(params=[1 << 18, 20], ids=["one strip", "strips of a row or two"])
def strips(request, monkeypatch):
    """Both ways to cut a scan; a result must not depend on it."""
    monkeypatch.setattr(grid_module, "_STRIP_PIXELS", request.param)


@pytest.mark.usefixtures("strips")
@pytest.mark.parametrize("full_turn", [False, True])
def test_vertices_and_faces_are_those_of_the_grid_mesh(full_turn):
    scan, rgb = colored_turn() if full_turn else colored_wall()[:2]
    surface, mesh = surface_of(scan, rgb), grid_mesh(scan)
    blocks = list(surface.vertex_blocks())
    np.testing.assert_array_equal(np.concatenate([block.points for block in blocks]), scan.points[scan.valid])
    np.testing.assert_array_equal(np.concatenate([block.rgb for block in blocks]), rgb[scan.valid])
    np.testing.assert_array_equal(np.concatenate([block.values["grid_row"] for block in blocks]), mesh.rows)
    np.testing.assert_array_equal(np.concatenate([block.values["grid_col"] for block in blocks]), mesh.cols)
    np.testing.assert_array_equal(np.concatenate(list(surface.face_blocks())), mesh.quads)
    assert (surface.vertex_count, surface.face_count) == (len(mesh.rows), len(mesh.quads))


@pytest.mark.parametrize("full_turn", [False, True])
def test_every_edge_of_a_face_is_there_once_and_the_faces_know_theirs(full_turn):
    scan, _ = colored_turn() if full_turn else colored_wall()[:2]
    mesh = grid_mesh(scan)
    ends = np.sort(np.stack([mesh.quads, np.roll(mesh.quads, -1, axis=1)], axis=-1), axis=-1)
    edges = np.sort(mesh.edges)
    np.testing.assert_array_equal(edges[mesh.face_edges], ends)
    assert len(edges) == len(np.unique(edges, axis=0)) == len(np.unique(ends.reshape(-1, 2), axis=0))


@pytest.mark.usefixtures("strips")
@pytest.mark.parametrize("full_turn", [False, True])
def test_every_vertex_is_in_a_face_or_loose(full_turn):
    scan, rgb = colored_turn() if full_turn else colored_wall()[:2]
    surface = surface_of(scan, rgb)
    loose = np.concatenate(list(surface.loose_blocks()))
    in_faces = np.unique(np.concatenate(list(surface.face_blocks())))
    np.testing.assert_array_equal(np.sort(np.concatenate([loose, in_faces])), np.arange(surface.vertex_count))
    assert (len(loose) > 0) != full_turn


@pytest.mark.usefixtures("strips")
def test_a_face_is_cut_along_its_shorter_diagonal_without_turning_it():
    scan, rgb, _ = colored_wall()
    surface = surface_of(scan, rgb)
    points = scan.points[scan.valid]
    quads = np.concatenate(list(surface.face_blocks()))
    triangles = np.concatenate(list(surface.triangle_blocks())).reshape(-1, 2, 3)
    for quad, pair in zip(quads, triangles, strict=True):
        first, second = (set(triangle.tolist()) for triangle in pair)
        assert first | second == set(quad.tolist()) and len(first & second) == 2
        across, other = sorted(first & second), sorted(set(quad.tolist()) - (first & second))
        assert np.linalg.norm(np.subtract(*points[across])) <= np.linalg.norm(np.subtract(*points[other]))
        for triangle in pair:
            a, b, c = points[triangle]
            assert np.cross(b - a, c - a) @ (a + b + c) < 0, "seen from behind"


@pytest.mark.usefixtures("strips")
def test_normals_are_those_of_a_plane_and_of_a_cylinder():
    scan, rgb = colored_turn()
    normals = np.concatenate(list(surface_of(scan, rgb).normal_blocks())).reshape(*scan.shape, 3)
    expected = -scan.points * [1, 1, 0] / 3
    np.testing.assert_allclose(normals, expected, atol=1e-6)


@pytest.mark.usefixtures("strips")
def test_a_vertex_in_no_face_looks_at_the_scanner():
    scan, rgb, _ = colored_wall()
    surface = surface_of(scan, rgb)
    normals = np.concatenate(list(surface.normal_blocks()))
    loose = np.concatenate(list(surface.loose_blocks()))
    points = scan.points[scan.valid][loose]
    np.testing.assert_allclose(normals[loose], -points / np.linalg.norm(points, axis=1)[:, None], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)


@pytest.mark.usefixtures("strips")
def test_a_split_seam_has_places_that_go_on_to_the_right():
    scan, rgb = colored_turn()
    scan = replace(scan, valid=np.where(np.arange(6)[:, None] == 2, np.arange(16) % 5 != 0, True))
    surface = surface_of(scan, rgb, split_seam=True)
    blocks = list(surface.vertex_blocks())
    uv = np.concatenate([block.uv for block in blocks])
    assert sum(len(block.points) for block in blocks) == surface.vertex_count == scan.valid.sum() + 5
    quads = np.concatenate(list(surface.face_blocks()))
    np.testing.assert_allclose(np.ptp(uv[quads, 0], axis=1), 1 / 16, atol=1e-6)
    np.testing.assert_allclose(np.ptp(uv[quads, 1], axis=1), 1 / 6, atol=1e-6)
    points = np.concatenate([block.points for block in blocks])
    plain = scan.points[scan.valid][np.concatenate(list(surface_of(scan, rgb).face_blocks()))]
    np.testing.assert_array_equal(points[quads], plain)
    assert len(np.concatenate(list(surface.normal_blocks()))) == surface.vertex_count


def test_values_are_kept_as_float_or_int():
    scan, rgb, values = colored_wall()
    surface = surface_of(scan, rgb, {**values, "observed": values["confidence"].astype(np.float64)})
    (block,) = surface.vertex_blocks()
    assert {name: array.dtype for name, array in block.values.items()} == surface.value_types
    np.testing.assert_array_equal(block.values["nearest_seed"], values["nearest_seed"][scan.valid])
    np.testing.assert_allclose(block.values["range"], scan.range[scan.valid], rtol=1e-6)
