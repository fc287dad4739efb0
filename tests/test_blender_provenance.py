"""Where colors are from, kept in Blender through the installed zip."""

import hashlib
import importlib
import json
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx

from reflcolor_addon import Settings
from reflcolor_addon.version import __version__


@pytest.fixture
def scan_file(tmp_path):
    return write_small_ptx(tmp_path / "wall.ptx", random_scan(3))


@pytest.fixture
def photo_file(tmp_path):
    photo = np.random.default_rng(0).integers(0, 256, (30, 40, 3), np.uint8)
    cv2.imwrite(str(tmp_path / "view.png"), photo)
    return tmp_path / "view.png"


@pytest.fixture
def colorized(blender, scan_file, photo_file):
    """bpy with a scan colorized from a seed by hand and one from a photo."""
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    blender.ops.reflcolor.load_photo(filepath=str(photo_file))
    blender.ops.reflcolor.add_seed(row=0, col=0, color=(1, 0, 0))
    blender.ops.reflcolor.add_seed(row=4, col=7, photo="view.png", photo_xy=(12.5, 7.25))
    blender.ops.reflcolor.colorize(alpha=2.0)
    return blender


def report(bpy):
    return json.loads(bpy.context.active_object["reflcolor_provenance"])


def hashed(path):
    data = path.read_bytes()
    return {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}


def test_the_object_keeps_inputs_settings_seeds_versions_and_time(colorized, scan_file, photo_file):
    found = report(colorized)
    assert found["inputs"] == [
        {"role": "scan", "path": str(scan_file)} | hashed(scan_file),
        {"role": "photo", "path": str(photo_file), "image": "view.png"} | hashed(photo_file),
    ]
    assert found["settings"] == Settings.preset("Natural", alpha=2.0).as_dict()
    assert [(seed["row"], seed["photo"], seed["x"]) for seed in found["seeds"]] == [
        (0, None, None),
        (4, "view.png", 12.5),
    ]
    assert found["versions"]["reflcolor"] == __version__
    assert found["versions"]["blender"] == colorized.app.version_string
    assert found["created"].endswith("Z") and len(found["created"]) == 20
    assert (found["scan"]["name"], found["scan"]["index"], found["scan"]["returns"]) == ("wall", 1, 60)


def test_the_hash_is_that_of_the_file_as_it_was_imported(blender, scan_file):
    expected = hashed(scan_file)
    blender.ops.reflcolor.import_scan(filepath=str(scan_file))
    scan_file.unlink()
    blender.ops.reflcolor.add_seed(row=0, col=0)
    blender.ops.reflcolor.colorize()
    assert {key: report(blender)["inputs"][0][key] for key in expected} == expected


def test_how_the_grid_was_turned_is_told(blender, scan_file):
    blender.ops.reflcolor.import_scan(filepath=str(scan_file), flip_vertical=True)
    blender.ops.reflcolor.add_seed(row=0, col=0)
    blender.ops.reflcolor.colorize()
    assert report(blender)["scan"]["flipped"] == ["vertical"]


def test_a_file_of_seeds_is_an_input(colorized, tmp_path):
    path = tmp_path / "wall.json"
    colorized.ops.reflcolor.save_seeds(filepath=str(path))
    colorized.ops.reflcolor.load_seeds(filepath=str(path))
    colorized.ops.reflcolor.load_seeds(filepath=str(path), replace=False)
    colorized.ops.reflcolor.colorize()
    seeds = [entry for entry in report(colorized)["inputs"] if entry["role"] == "seeds"]
    assert seeds == [{"role": "seeds", "path": str(path)} | hashed(path)] * 2
    colorized.ops.reflcolor.load_seeds(filepath=str(path))
    colorized.ops.reflcolor.colorize()
    assert len([entry for entry in report(colorized)["inputs"] if entry["role"] == "seeds"]) == 1


def test_it_is_saved_and_follows_undo_and_copies(colorized, tmp_path):
    bpy = colorized
    before = bpy.context.active_object["reflcolor_provenance"]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    assert bpy.context.active_object["reflcolor_provenance"] == before
    assert bpy.context.active_object.copy()["reflcolor_provenance"] == before
    bpy.ops.ed.undo_push(message="opened")
    bpy.ops.reflcolor.colorize(alpha=3.0)
    bpy.ops.ed.undo_push(message="colorized")
    assert report(bpy)["settings"]["alpha"] == 3.0
    bpy.ops.ed.undo()
    assert bpy.context.active_object["reflcolor_provenance"] == before


def test_a_photo_that_was_not_loaded_here_is_named_without_a_hash(colorized):
    image = colorized.data.images.new("painted", 8, 8)
    colorized.context.active_object.reflcolor.seeds[0].photo = image
    colorized.ops.reflcolor.colorize()
    unseen = {"role": "photo", "path": "painted", "image": "painted", "bytes": None, "sha256": None}
    assert unseen in report(colorized)["inputs"]


@pytest.mark.parametrize("spoiled", [None, "no JSON", "[1]", 7])
def test_an_object_without_its_import_still_is_colorized_and_told(colorized, scan_file, spoiled):
    obj = colorized.context.active_object
    if spoiled is None:
        del obj["reflcolor_import"]
    else:
        obj["reflcolor_import"] = spoiled
    colorized.ops.reflcolor.colorize()
    found = report(colorized)
    assert found["inputs"][0] == {"role": "scan", "path": str(scan_file), "bytes": None, "sha256": None}
    assert (found["scan"]["returns"], found["scan"]["index"]) == (60, None)


def test_the_panel_and_the_clipboard_have_the_same_report(colorized):
    panel = importlib.import_module(f"{EXTENSION}.panels.provenance")
    text = colorized.context.active_object["reflcolor_provenance"]
    found, problem = panel._outline(text)
    assert problem is None and found.sources == {"photo": 1, "hand": 1} and found.inferred == 58
    assert panel._outline("{}")[0] is None
    del colorized.context.active_object["reflcolor_provenance"]
    with pytest.raises(RuntimeError, match="Colorize the scan first"):
        colorized.ops.reflcolor.copy_provenance()


def test_the_command_prints_it_from_a_file(colorized, blender_command, tmp_path):
    expected = report(colorized)
    colorized.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"), compress=True)
    done = blender_command("provenance", tmp_path / "kept.blend", "--object", "wall", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout[done.stdout.index("{") :])
    assert document["objects"] == [{"name": "wall", "provenance": expected}]
    done = blender_command("provenance", tmp_path / "kept.blend")
    assert f"SHA-256 {expected['inputs'][0]['sha256']}" in done.stdout, done.stderr
    (tmp_path / "bad.blend").write_text("no scene")
    done = blender_command("provenance", tmp_path / "bad.blend")
    assert done.returncode == 1
    assert "bad.blend: Blender could not read it" in done.stderr.strip().splitlines()[-1]


def test_how_seeds_were_found_is_told_while_such_seeds_are_there(colorized):
    provenance = importlib.import_module(f"{EXTENSION}.operators.scene.provenance")
    obj = colorized.context.active_object
    match = SimpleNamespace(name="view.png", verified=True, tested=True, reason="pose", note="verified: 90 % agree")
    provenance.record_matching(obj, SimpleNamespace(photos=[match]), Settings(slic_segments=77), ("slic_segments",))
    colorized.ops.reflcolor.colorize()
    assert report(colorized)["photos"] == [] and report(colorized)["settings"]["slic_segments"] == 500
    obj.reflcolor.seeds[1].reason = "pose"
    colorized.ops.reflcolor.colorize()
    found = report(colorized)
    assert found["photos"] == [vars(match) | {"observed": 0}]
    assert found["settings"]["slic_segments"] == 77
    assert [entry["role"] for entry in found["inputs"]] == ["scan", "photo"]


def test_the_images_that_a_description_names_are_inputs_too(blender):
    cones = Path(__file__).resolve().parent.parent / "examples" / "cones"
    blender.ops.reflcolor.import_scan(filepath=str(cones / "cones.scan.json"))
    blender.ops.reflcolor.add_seed(row=150, col=200)
    blender.ops.reflcolor.colorize()
    inputs = report(blender)["inputs"]
    assert [Path(entry["path"]).name for entry in inputs] == [
        "cones.scan.json",
        "cones.range.png",
        "cones.reflectance.png",
    ]
    assert [{key: entry[key] for key in ("bytes", "sha256")} for entry in inputs] == [
        hashed(Path(entry["path"])) for entry in inputs
    ]
