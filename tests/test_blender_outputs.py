"""The files that the command line writes through Blender, read back by other means."""

import json
import struct
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Seeds, colorize, read_scans
from reflcolor_addon.files.writers.ptx import write_ptx

READ_BLEND = """
import bpy, json, os, sys
import numpy as np
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
(obj,) = [o for o in bpy.data.objects if o.type == "MESH"]
colors = obj.data.color_attributes
rgba = np.empty(4 * len(obj.data.vertices), np.float32)
colors["Colorized"].data.foreach_get("color_srgb", rgba)
shading = [a.spaces.active.shading for s in bpy.data.screens for a in s.areas if a.type == "VIEW_3D"]
facts = {
    "rgb": np.rint(rgba.reshape(-1, 4)[:, :3] * 255).astype(int).tolist(),
    "active": colors.active_color_name,
    "images": sorted(i.name for i in bpy.data.images if i.packed_file),
    "provenance": json.loads(obj["reflcolor_provenance"])["format"],
    "camera": bpy.context.scene.camera is not None,
    "render_path": bpy.context.scene.render.filepath,
    "shading": sorted({s.color_type for s in shading}),
}
open(sys.argv[2], "w").write(json.dumps(facts))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def results(blender_command, tmp_path_factory):
    """A small scan colorized by the command into every kind of file: (folder, rgb of every vertex)."""
    folder = tmp_path_factory.mktemp("results")
    scan, valid = random_scan(5, (8, 12)), np.ones((8, 12), bool)
    valid[3, 4] = False
    write_ptx(type(scan)(name="wall", points=scan.points, reflectance=scan.reflectance, valid=valid), folder / "w.ptx")
    seeds = Seeds([0, 7, 4], [0, 11, 2], np.array([[220, 60, 30], [30, 90, 200], [60, 180, 60]], np.uint8))
    seeds.save(folder / "seeds.json")
    outputs = [part for suffix in ("png", "blend", "glb", "ply") for part in ("-o", folder / f"wall.{suffix}")]
    done = blender_command(
        *("colorize", folder / "w.ptx", "--seeds", folder / "seeds.json", *outputs),
        *("--render", folder / "render.png", "--report", folder / "report.json"),
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    (read,) = read_scans(folder / "w.ptx")
    return folder, colorize(read, seeds).rgb[read.valid].astype(int)


def test_only_the_results_are_left(results):
    names = {path.name for path in results[0].iterdir()}
    kinds = {f"wall.{suffix}" for suffix in ("png", "blend", "glb", "ply")}
    assert names == kinds | {"w.ptx", "seeds.json", "render.png", "report.json"}


def test_the_blend_holds_the_colors_and_is_ready_to_render(results, tmp_path):
    folder, rgb = results
    script, facts = tmp_path / "read.py", tmp_path / "facts.json"
    script.write_text(READ_BLEND)
    subprocess.run([sys.executable, script, folder / "wall.blend", facts], check=True, capture_output=True, timeout=120)
    read = json.loads(facts.read_text())
    assert np.abs(np.array(read["rgb"]) - rgb).max() <= 1
    assert read["active"] == "Colorized" and read["camera"]
    assert [name.split(" ")[-1] for name in read["images"]] == ["Colorized", "Range", "Reflectance"]
    assert read["provenance"] == "reflcolor-report"
    assert "reflcolor-" not in read["render_path"]
    assert "VERTEX" in read["shading"] and "MATERIAL" not in read["shading"]


def test_the_glb_holds_the_colors(results):
    folder, rgb = results
    # They are linear.
    colors = glb_attribute(folder / "wall.glb", "COLOR_0")[:, :3]
    assert np.abs(encoded(colors) - rgb[glb_places(folder)]).max() <= 1


@pytest.fixture(scope="module")
def trust(results):
    """Confidence and index of the nearest seed, of every vertex, by the core."""
    folder, _ = results
    (scan,) = read_scans(folder / "w.ptx")
    result = colorize(scan, Seeds.load(folder / "seeds.json"))
    return result.confidence[scan.valid], result.nearest_seed[scan.valid]


def test_the_glb_holds_confidence_and_nearest_seed(results, trust):
    vertex = glb_places(results[0])
    confidence, nearest = (
        glb_attribute(results[0] / "wall.glb", name)[:, 0] for name in ("_CONFIDENCE", "_NEAREST_SEED")
    )
    np.testing.assert_allclose(confidence, trust[0][vertex], rtol=1e-4)
    np.testing.assert_array_equal(nearest, trust[1][vertex])


def test_the_ply_holds_confidence_and_nearest_seed(results, trust):
    table, vertex = ply_vertices(results[0])
    np.testing.assert_allclose(table["confidence"], trust[0][vertex], rtol=1e-4)
    np.testing.assert_array_equal(table["nearest_seed"], trust[1][vertex])


def test_the_ply_holds_the_colors(results):
    folder, rgb = results
    table, vertex = ply_vertices(folder)
    colors = np.stack([table["red"], table["green"], table["blue"]], axis=-1).astype(int)
    assert np.abs(colors - rgb[vertex]).max() <= 1


def ply_vertices(folder):
    """The table of the PLY's vertices, and which return of the scan each of them is."""
    header, _, body = (folder / "wall.ply").read_bytes().partition(b"end_header\n")
    names = [line.split()[-1].decode() for line in header.splitlines() if line.startswith(b"property")]
    kinds = [line.split()[1].decode() for line in header.splitlines() if line.startswith(b"property")]
    count = int(next(line for line in header.splitlines() if line.startswith(b"element vertex")).split()[-1])
    dtype = np.dtype(
        [
            (n, {"float": "<f4", "uchar": "u1", "int": "<i4"}[k])
            for n, k in zip(names, kinds, strict=True)
            if k != "list"
        ]
    )
    table = np.frombuffer(body, dtype, count)
    (scan,) = read_scans(folder / "w.ptx")
    world = np.stack([table["x"], table["y"], table["z"]], axis=-1)
    vertex = np.argmin(((world[:, None] - scan.points[scan.valid][None]) ** 2).sum(axis=-1), axis=1)
    assert np.abs(world - scan.points[scan.valid][vertex]).max() < 1e-4
    return table, vertex


def test_the_render_shows_the_mesh_large_and_in_its_colors(results):
    folder, rgb = results
    picture = cv2.imread(str(folder / "render.png"))[..., ::-1].astype(int)
    background = picture[0, 0]
    shown = np.abs(picture - background).max(axis=-1) > 12
    rows, cols = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
    assert max(np.ptp(rows) / picture.shape[0], np.ptp(cols) / picture.shape[1]) > 0.85
    assert min(rows[0], cols[0], picture.shape[0] - 1 - rows[-1], picture.shape[1] - 1 - cols[-1]) > 0
    hues = picture[shown] - picture[shown].mean(axis=-1, keepdims=True)
    truth = rgb - rgb.mean(axis=-1, keepdims=True)
    assert np.abs(hues.mean(axis=0) - truth.mean(axis=0)).max() < 20


def test_an_unwritable_place_is_refused_before_the_work(blender_command, results, tmp_path):
    folder, _ = results
    done = blender_command(
        "colorize", folder / "w.ptx", "--seeds", folder / "seeds.json", "-o", tmp_path / "missing" / "a.blend"
    )
    assert done.returncode == 1
    assert "Traceback" not in done.stderr and "missing" in done.stderr.strip().splitlines()[-1]


def glb_places(folder):
    """Which return of the scan each vertex of the GLB is."""
    (scan,) = read_scans(folder / "w.ptx")
    # glTF has Y up.
    world = glb_attribute(folder / "wall.glb", "POSITION")[:, [0, 2, 1]] * (1, -1, 1)
    return np.argmin(((world[:, None] - scan.points[scan.valid][None]) ** 2).sum(axis=-1), axis=1)


def glb_attribute(path, name):
    """(N, width) values of an attribute of the only primitive of a GLB."""
    data = Path(path).read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    (mesh,) = document["meshes"]
    (primitive,) = mesh["primitives"]
    accessor = document["accessors"][primitive["attributes"][name]]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    array = np.frombuffer(binary, kind, accessor["count"] * width, start).reshape(-1, width)
    return array / np.iinfo(kind).max if accessor.get("normalized") else array


def encoded(linear):
    """sRGB 0..255 of linear colors."""
    low = linear <= 0.0031308
    return np.rint(255 * np.where(low, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055))
