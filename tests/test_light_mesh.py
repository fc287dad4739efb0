"""Light meshes: few faces, on which an image of the scan's grid lies as it does on the scan's own."""

import json

import numpy as np
import pytest
from colored_scans import colored_turn
from command_line import COLORIZE, blender_tasks
from gltf_files import Glb
from small_scans import scan_from_ranges

from reflcolor_addon import Cancelled, OutputError, Scan
from reflcolor_addon.files.writers.glb import check_glb_size
from reflcolor_addon.matching import grid_texture
from reflcolor_addon.scan.mesh_surface import split_at_seams
from reflcolor_addon.scan.surface import ScanSurface
from reflcolor_addon.view.fewer_faces import light_mesh

SHAPE = (20, 30)
# Angle and pixels, from left to right and from the top down.
DOWN_A_WALL = ((60, 30), (40, 20))


def untouched(coordinates, corners, sizes, fixed, faces, **_):
    """In place of Blender's decimation: all of its triangles, of faces with four corners."""
    assert set(sizes.tolist()) == {4}
    quads = corners.reshape(-1, 4)
    return coordinates, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def room(valid=None):
    """A wall, and half a meter before it a board."""
    right, up = np.meshgrid(np.arange(SHAPE[1]) - 14.5, 9.5 - np.arange(SHAPE[0]))
    points = 5 * np.stack([right * 0.01, np.ones(SHAPE), up * 0.01], axis=-1)
    points[5:15, 10:20] *= 0.5
    valid = np.ones(SHAPE, bool) if valid is None else valid
    return Scan(name="room", points=points, reflectance=np.arange(600.0).reshape(SHAPE), valid=valid)


def test_a_mesh_of_few_faces_keeps_returns_places_and_numbers():
    scan = room()
    light = light_mesh(scan, 10**6, None, filled=False)
    number = light.places.round().astype(int) @ [SHAPE[1], 1]
    np.testing.assert_array_equal(light.pixel, number)
    np.testing.assert_allclose(light.points, scan.points.reshape(-1, 3)[number], rtol=1e-6)
    values = light.values({"photo": np.arange(600).reshape(SHAPE) - 1})
    np.testing.assert_array_equal(values["photo"], number - 1)
    np.testing.assert_array_equal(values["grid_row"] * SHAPE[1] + values["grid_col"], number)
    assert values["photo"].dtype == np.int32 and values["reflectance"].dtype == np.float32


def test_moved_vertices_keep_their_place_in_the_image_and_take_numbers_of_their_own_surface():
    scan = room()

    def moved(coordinates, corners, sizes, fixed, faces, **_):
        # Near the middle of the pixel's right border.
        found, triangles = untouched(coordinates, corners, sizes, fixed, faces)
        return found + np.float32([0.45, 0, 0]), triangles

    light = light_mesh(scan, 100, moved, filled=False)
    rays = scan.points / np.linalg.norm(scan.points, axis=-1, keepdims=True)
    row, col = np.floor(light.places + 1e-4).astype(int).T
    inside = col < SHAPE[1] - 1
    between = 0.55 * rays[row, col] + 0.45 * rays[row, np.minimum(col + 1, SHAPE[1] - 1)]
    along = np.einsum("ij,ij->i", light.points, between) / np.linalg.norm(light.points, axis=1)
    np.testing.assert_allclose(along[inside], np.linalg.norm(between, axis=1)[inside], rtol=1e-9)
    nearest = np.linalg.norm(scan.points.reshape(-1, 3)[light.pixel] - light.points, axis=1)
    assert nearest.max() < 0.1


def space_of(scan):
    """The vertices (H, W, 3) as they are given to be merged, of a scan with all returns."""
    given = []

    def seen(coordinates, corners, sizes, fixed, faces, **_):
        given.append(coordinates)
        return untouched(coordinates, corners, sizes, fixed, faces)

    light_mesh(scan, 100, seen, filled=False, max_incidence_deg=90)
    return given[0].reshape(*scan.shape, 3)


def test_where_faces_are_merged_a_wall_is_nearly_flat():
    azimuth, elevation = (np.radians(span) * (0.5 - (np.arange(count) + 0.5) / count) for span, count in DOWN_A_WALL)
    ranges = 5 / (np.cos(azimuth) * np.cos(elevation[:, None]))
    space = space_of(scan_from_ranges(ranges, np.ones(ranges.shape))).reshape(-1, 3).astype(float)
    flat = space - space.mean(axis=0)
    off = np.abs(flat @ np.linalg.svd(flat)[2][2])
    # With the logarithm of the range alone it would be more than ten times as much.
    assert off.max() < 0.05 * np.ptp(np.log(ranges)) / np.radians(60 / 30)


def test_where_faces_are_merged_a_circle_around_the_scanner_is_not_straight():
    row = space_of(scan_from_ranges(np.full((8, 30), 5.0), np.ones((8, 30))))[-1]
    chord = row[0] + np.linspace(0, 1, 30)[:, None] * (row[-1] - row[0])
    step = np.radians(60 / 30)
    # As far from its chord as a circle of this radius, in pixels, is.
    expected = (1 - np.cos(np.radians(30))) / step
    assert np.abs(row - chord)[:, 2].max() == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("shape", [(20, 48), (21, 50)])
def test_of_a_very_large_scan_every_nth_row_and_column_is_taken_and_its_whole_image_lies_on_it(monkeypatch, shape):
    monkeypatch.setattr("reflcolor_addon.view.thinned_scan.MOST_PIXELS", 110)
    scan, _ = colored_turn(shape)
    light = light_mesh(scan, 10, untouched, filled=False)
    # 960 and 1,050 pixels: every 3rd and every 4th.
    step = {960: 3, 1050: 4}[scan.valid.size]
    row, col = np.divmod(light.pixel, shape[1])
    assert light.scan is scan and not (row % step).any() and not (col % step).any()
    np.testing.assert_allclose(light.places[: light.own], np.stack([row, col], axis=1)[: light.own], atol=1e-4)
    np.testing.assert_allclose(light.points, scan.points.reshape(-1, 3)[light.pixel], rtol=1e-5)
    # The seam is closed, and the image goes on to its right edge there.
    np.testing.assert_allclose(light.places[light.own :, 1], shape[1], atol=1e-4)
    assert len(light.points) - light.own == -(-shape[0] // step)
    assert light.whole == 2 * (shape[0] - 1) * shape[1]


def test_what_has_no_return_gives_no_numbers():
    valid = np.ones(SHAPE, bool)
    valid[8:11, 12:15] = valid[2, 3] = False
    light = light_mesh(room(valid), 10**6, None)
    assert valid.ravel()[light.pixel].all()
    assert light.whole == len(light.triangles)


def test_a_full_turn_is_closed_without_repeating_a_vertex_and_an_image_wraps():
    scan, rgb = colored_turn((6, 16))
    fixed_ones = []

    def seen(coordinates, corners, sizes, fixed, faces, **_):
        fixed_ones.append(coordinates[fixed])
        return untouched(coordinates, corners, sizes, fixed, faces)

    light = light_mesh(scan, 100, seen, filled=False)
    assert sorted(set(fixed_ones[0][:, 0].tolist())) == [0, 16]
    assert light.own == 96 and len(light.points) == 96 + 6
    whole, split = (light.surface(rgb, {}, split_seam=split) for split in (False, True))
    whole_triangles = np.concatenate(list(whole.triangle_blocks()))
    edges = np.sort(np.concatenate([whole_triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]))
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert np.count_nonzero(uses == 1) == 2 * 16
    np.testing.assert_allclose(
        np.concatenate(list(split.normal_blocks()))[96:], np.concatenate(list(whole.normal_blocks()))[light.same[96:]]
    )
    (block,) = split.vertex_blocks()
    wide = np.ptp(block.uv[light.triangles, 0], axis=1)
    assert wide.max() == pytest.approx(1 / 16)
    np.testing.assert_array_equal(block.rgb[light.same], block.rgb)


def test_vertices_are_split_where_an_image_goes_on_elsewhere():
    triangles = np.array([[0, 1, 2], [2, 1, 3]])
    uv = np.float32([[[0, 0], [1, 0], [0, 1]], [[0, 1], [0.5, 0], [1, 1]]])
    split = split_at_seams(4, triangles, uv)
    assert split.vertex.tolist() == [0, 1, 2, 3, 1]
    np.testing.assert_array_equal(split.uv[split.triangles], uv * np.float32([1, -1]) + np.float32([0, 1]))


def test_pixels_without_a_return_have_the_nearest_color_in_the_image():
    scan, rgb = room(), np.zeros((*SHAPE, 3), np.uint8)
    rgb[..., 0] = np.arange(SHAPE[1])
    valid = scan.valid.copy()
    valid[:, 25:] = False
    image = grid_texture(room(valid), rgb)
    assert image.shape == rgb.shape and (image[:, 25:, 0] == 24).all()
    np.testing.assert_array_equal(image[:, :25], rgb[:, :25])


def test_it_can_be_cancelled():
    with pytest.raises(Cancelled):
        light_mesh(room(), 10**6, None, cancelled=lambda: True)


def test_a_glb_that_is_too_large_fits_with_fewer_faces(tmp_path):
    surface = ScanSurface(room(), None)
    surface.vertex_count = 100_000_000
    with pytest.raises(OutputError, match="--faces"):
        check_glb_size([surface], tmp_path / "large.glb")
    check_glb_size([surface], tmp_path / "large.glb", faces=1_000_000)


def test_on_the_command_line_meshes_are_light_and_show_an_image(run_cli, cli_folder):
    outputs = [part for name in ("out.glb", "out.ply", "out.png") for part in ("-o", name)]
    blender = blender_tasks(decimate=untouched)
    status, _, err = run_cli(
        *COLORIZE, "--faces", "100", "--as-measured", *outputs, "--report", "out.json", blender=blender
    )
    assert (status, err) == (0, "")
    glb = Glb(cli_folder / "out.glb")
    assert "TEXCOORD_0" in glb.primitive()["attributes"] and len(glb.document["images"]) == 1
    report = json.loads((cli_folder / "out.json").read_text())
    assert report["mesh"]["faces"] <= report["mesh"]["faces_before"]
    assert report["mesh"]["faces"] == len(glb.array(glb.primitive()["indices"])) // 3
    assert f"element face {report['mesh']['faces']}".encode() in (cli_folder / "out.ply").read_bytes()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--faces", "99", "-o", "out.glb"], "expected a whole number from 100"),
        (["--faces", "200000", "-o", "out.png"], "--faces 200000: none of the outputs has a mesh"),
        (["--faces", "200000", "-o", "out.glb"], "--faces 200000 needs Blender"),
    ],
)
def test_what_cannot_be_made_lighter_is_refused(run_cli, given, said):
    status, _, err = run_cli(*COLORIZE, *given)
    assert status in (1, 2) and said in err
