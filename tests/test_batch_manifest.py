"""The manifest of a batch: what it means, and how one is drafted."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from archives import HEAD, read_manifest
from small_scans import random_scan

from reflcolor_addon import Seeds
from reflcolor_addon.batch.archive import manifest_file
from reflcolor_addon.batch.archive.draft import draft
from reflcolor_addon.batch.archive.names import item_names
from reflcolor_addon.files.images import write_jpeg, write_png
from reflcolor_addon.files.readers import ReadOptions, read_scans
from reflcolor_addon.files.writers import write_ptx


def test_patterns_defaults_and_what_one_scan_has_of_its_own(folder):
    manifest, faults = read_manifest(
        folder,
        HEAD
        + 'scans = ["hall_*.ptx"]\nphotos = "photos/*.png"\npreset = "Enhanced"\n'
        + 'settings = { alpha = 20.0 }\nwrite = "png"\n'
        + '[[scan]]\nfile = "hall_1.ptx"\nname = "tower"\nseeds = "hall_1.seeds.json"\nwrite = ["ply"]\n'
        + "[scan.settings]\nbeta = 0\n"
        + '[[scan]]\nfile = "hall_2.ptx"\nskip = true\n',
    )
    assert faults == []
    first, tower = manifest.items
    assert (first.name, tower.name) == ("hall_0", "tower")
    assert first.offered and not tower.offered
    assert [path.name for path in first.plan.photos] == ["a.png", "b.png"]
    assert tower.plan.seeds == folder / "hall_1.seeds.json"
    assert first.plan.settings.alpha == tower.plan.settings.alpha == 20.0
    assert first.plan.settings.beta != 0 == tower.plan.settings.beta
    written = [output.of(tower.name).path for output in tower.plan.outputs if output.option == "write"]
    assert written == [folder / "colored" / "tower.ply"]


def test_how_scans_are_read_is_told_for_all_or_for_one(folder):
    text = (
        HEAD + 'scans = "hall_?.ptx"\nphotos = "photos/a.png"\nreading = { step = 2 }\n[[scan]]\nfile = "hall_1.ptx"\n'
    )
    manifest, faults = read_manifest(folder, text + 'reading = { grid = "angle", position = [1, 2, 3] }\n')
    assert faults == []
    first, other, _ = (item.plan.reading for item in manifest.items)
    assert first == ReadOptions(step=2)
    assert other == ReadOptions(step=2, grid="angle", position=(1.0, 2.0, 3.0))
    _, faults = read_manifest(folder, text + 'reading = { stp = 2, grid = "round", step = "2", position = [1] }\n')
    assert [fault.partition(": reading: ")[2].partition(" ")[0] for fault in faults] == [
        "unknown",
        "grid:",
        "step:",
        "position:",
    ]
    assert all(fault.startswith("line 9: ") for fault in faults)


def test_scans_of_one_site_are_one_item(folder):
    table = '[[scan]]\nfile = "hall_{}.ptx"\nsite = "hall"\n'
    manifest, faults = read_manifest(folder, HEAD + 'photos = "photos/a.png"\n' + table.format(0) + table.format(2))
    assert faults == []
    (item,) = manifest.items
    assert item.name == "hall"
    assert [path.name for path in item.plan.scans] == ["hall_0.ptx", "hall_2.ptx"]


def test_a_site_takes_what_any_of_its_scans_says_and_refuses_what_they_disagree_on(folder):
    table = '[[scan]]\nfile = "hall_{}.ptx"\nsite = "hall"\n'
    text = HEAD + 'photos = "photos/a.png"\n' + table.format(0) + table.format(2)
    manifest, faults = read_manifest(folder, text + 'preset = "Paper"\nwrite = ["glb"]\n')
    assert faults == []
    assert manifest.items[0].plan.settings.light == 0
    assert manifest.items[0].plan.outputs[0].path.suffix == ".glb"
    first = HEAD + 'photos = "photos/a.png"\n' + table.format(0) + 'preset = "Natural"\n' + table.format(2)
    _, faults = read_manifest(folder, first + 'preset = "Paper"\nscan = "1"\n')
    assert [fault[: fault.index(": ", 9)] for fault in faults] == ["line 13: scan", "line 12: preset"]


def test_what_counts_for_a_site_is_the_last_value_of_each_scan(folder):
    both = '[[scan]]\nfile = "hall_*.ptx"\npreset = "Natural"\n'
    site = '[[scan]]\nfile = "hall_*.ptx"\nsite = "hall"\npreset = "Paper"\n'
    manifest, faults = read_manifest(folder, HEAD + 'photos = "photos/a.png"\n' + both + site)
    assert faults == []
    assert manifest.items[0].plan.settings.light == 0


def test_scans_of_one_name_are_called_by_their_folders_too(folder):
    for name in ("east", "west"):
        (folder / name).mkdir()
        write_ptx(random_scan(), folder / name / "Hall 1.ptx")
    manifest, faults = read_manifest(folder, HEAD + 'scans = ["*/Hall 1.ptx"]\nphotos = "photos/a.png"\n')
    assert faults == []
    assert [item.name for item in manifest.items] == ["east_Hall_1", "west_Hall_1"]


@pytest.mark.parametrize(
    ("paths", "names"),
    [
        (["scan (2).ptx", "scan [2].ptx", "scan.ptx"], ["scan_(2)", "scan_[2]", "scan"]),
        (["a/x/s.ptx", "b/x/s.ptx", "t.ptx"], ["a_x_s", "b_x_s", "t"]),
        (["hall.ptx", "hall.e57", "Hall.scan.json"], ["hall.ptx", "hall.e57", "Hall.scan.json"]),
        (["A b.ptx", "A_b.ptx", "a&b.ptx"], ["A_b", "A_b_2", "a_b_3"]),
    ],
)
def test_names_say_which_file_they_come_from_and_no_two_are_the_same(paths, names):
    assert item_names([None] * len(paths), [Path(path) for path in paths]) == names


def test_results_never_take_the_place_of_inputs(folder):
    (folder / "colored").mkdir()
    write_png(folder / "colored" / "hall_0.png", np.zeros((4, 4, 3), np.uint8))
    _, faults = read_manifest(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "colored/hall_0.png"\n')
    assert any("would be overwritten" in fault for fault in faults), faults


def test_a_draft_names_every_scan_and_photo_and_is_a_manifest_without_faults(folder):
    (folder / "Bilder 2003 [alt]").mkdir()
    write_png(folder / "Bilder 2003 [alt]" / "dach.png", np.zeros((4, 4, 3), np.uint8))
    (folder / "batch.toml").unlink()
    manifest, faults = read_manifest(folder, draft(folder, folder / "batch.toml"))
    assert faults == []
    assert [item.plan.scans[0].name for item in manifest.items] == ["hall_0.ptx", "hall_1.ptx", "hall_2.ptx"]
    assert all(item.plan.seeds is not None for item in manifest.items)
    assert {path.name for path in manifest.photos} == {"a.png", "b.png", "dach.png"}


def test_a_draft_lists_what_else_may_be_said_and_that_works(folder):
    (folder / "batch.toml").unlink()
    lines = draft(folder, folder / "batch.toml").splitlines()
    said = [line.removeprefix("# ") for line in lines if re.match(r"# (texture|preset|settings|reading) = ", line)]
    assert len(said) == 4
    text = "\n".join(line for line in lines if not line.startswith("#"))
    manifest, faults = read_manifest(folder, text.replace("render = false", "\n".join(["render = false", *said])))
    assert all("needs Blender" in fault or "grid" in fault for fault in faults)
    assert {item.plan.texture for item in manifest.items} == {4096}


def test_the_page_on_manifests_lists_every_key():
    page = (Path(__file__).resolve().parent.parent / "docs" / "manifest.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (.*?) \|", page, re.MULTILINE))))
    keys = {*manifest_file._OF_ALL, *manifest_file._OF_EACH, *manifest_file._OF_ONE}
    assert listed - {"key"} == keys
    example = tomllib.loads(page.split("```toml")[1].split("```")[0])
    assert {*example, *(key for table in example["scan"] for key in table)} <= {*keys, "scan"}


def test_a_draft_leaves_out_images_that_belong_to_a_scan_and_results_of_a_batch(folder):
    (folder / "colored" / "batch-state").mkdir(parents=True)
    write_ptx(random_scan(), folder / "colored" / "old.ptx")
    text = draft(folder, folder / "batch.toml")
    assert "old.ptx" not in text and "colored/" not in text


def test_a_draft_leaves_out_a_colorized_image_beside_its_scan(folder):
    rows, columns = read_scans(folder / "hall_0.ptx")[0].shape
    write_png(folder / "hall_0.png", np.zeros((rows, columns, 3), np.uint8))
    write_png(folder / "hall_1.png", np.zeros((rows, columns + 1, 3), np.uint8))
    (folder / "hall_2.png").write_bytes(b"no picture")
    write_jpeg(folder / "hall_0.jpg", np.zeros((rows, columns, 3), np.uint8))
    text = draft(folder, folder / "batch.toml")
    assert 'colorized images of the scans beside them:\n#   "hall_0.png"\n' in text
    (folder / "batch.toml").unlink()
    manifest, _ = read_manifest(folder, text)
    assert {path.name for path in manifest.photos} >= {"hall_0.jpg", "hall_1.png", "hall_2.png"}
    assert "hall_0.png" not in {path.name for path in manifest.photos}


def test_a_draft_takes_a_text_of_points_for_a_scan_and_leaves_out_other_texts(folder):
    (folder / "README.txt").write_text("Hall, scanned in 2003 by Anna\n1 photo is missing\n\n12, 13\n")
    (folder / "cloud.txt").write_text("// x;y;z;intensity\n1.5;2.5;3.5;0.2\n")
    text = draft(folder, folder / "batch.toml")
    assert "cloud.txt" in text and "README.txt" not in text


def test_seeds_named_for_all_scans_may_be_missing_where_there_are_photos(folder):
    Seeds([1], [2], [[1, 2, 3]]).save(folder / "hall_0.json")
    manifest, faults = read_manifest(
        folder, HEAD + 'scans = "hall_*.ptx"\nphotos = "photos/a.png"\nseeds = "{scan}.json"\n'
    )
    assert faults == []
    assert [item.offered for item in manifest.items] == [False, True, True]
    assert manifest.items[0].plan.seeds == Path(folder / "{scan}.json")


def test_light_meshes_are_a_number_of_faces_and_need_blender_and_a_mesh(folder):
    text = HEAD + 'scans = "hall_0.ptx"\nphotos = "photos/a.png"\nwrite = ["{}"]\nfaces = {}\n'
    manifest, (fault,) = read_manifest(folder, text.format("glb", 5000))
    assert manifest.items[0].plan.faces == 5000 and "faces needs Blender" in fault
    assert "none of the outputs has a mesh" in read_manifest(folder, text.format("png", 5000))[1][0]
    assert read_manifest(folder, text.format("png", 99))[1][0] == (
        f"line {HEAD.count(chr(10)) + 4}: faces 99: expected a whole number from 100 to 100000000"
    )
