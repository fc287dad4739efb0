"""A batch: every scan is colorized once, and one scan's fault never affects another."""

import csv
import json
from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np
import pytest
from archives import HEAD, damage_points, make_archive, table_of
from gltf_files import Glb
from small_scans import random_scan

from benchmarks.rooms import Room
from reflcolor_addon import Seeds, Settings, read_scans
from reflcolor_addon.batch.archive.costs import Costs
from reflcolor_addon.batch.archive.done import Done
from reflcolor_addon.batch.archive.estimate import estimate
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.batch.archive.options import Options
from reflcolor_addon.batch.pipeline import run_plan
from reflcolor_addon.batch.plan import IMAGE, MESH, Output, Plan
from reflcolor_addon.batch.plan_document import as_document, from_document
from reflcolor_addon.batch.read import safe_label
from reflcolor_addon.batch.session import Session
from reflcolor_addon.cli.main import main
from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.images import read_image, write_jpeg, write_png
from reflcolor_addon.files.memory import readable
from reflcolor_addon.files.readers.options import ReadOptions
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.report.provenance import read_report
from reflcolor_addon.report.verification import WHOLE, verify_outputs
from reflcolor_addon.view.picture import Picture


def test_all_scans_are_colorized_and_a_second_run_does_nothing_again(archive, batch):
    status, out, err = batch("--jobs", "2")
    assert (status, err) == (0, "")
    assert "3 done" in out
    for number in range(3):
        report = archive / "colored" / "reports" / f"hall_{number}.json"
        assert {part.state for part in verify_outputs(read_report(report), report)} == {WHOLE}
    times = {path: path.stat().st_mtime_ns for path in (archive / "colored").glob("hall_*")}
    status, out, _ = batch("--resume")
    assert status == 0 and "0 done, 3 done before" in out
    assert times == {path: path.stat().st_mtime_ns for path in (archive / "colored").glob("hall_*")}


def test_what_changed_is_done_again_and_nothing_else(archive, batch):
    batch()
    Seeds([3], [3], [[9, 9, 9]]).save(archive / "hall_1.seeds.json")
    (archive / "colored" / "hall_2.png").write_bytes(b"damaged")
    status, out, _ = batch("--resume")
    assert status == 0 and "2 done, 1 done before" in out
    assert "hall_1: done" in out and "hall_2: done" in out


def test_one_scan_that_fails_costs_no_other(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    status, out, err = batch("--keep-going")
    assert status == 1
    assert "2 done, 0 done before, 1 failed" in out
    assert "batch.toml: 1 of 3 failed: hall_0" in err
    rows = table_of(archive)
    assert [rows[f"hall_{number}"]["state"] for number in range(3)] == ["failed", "done", "done"]
    assert "hall_0.ptx: line 1" in rows["hall_0"]["note"]
    assert "hall_0.ptx: line 1" in (archive / "colored" / "logs" / "hall_0.log").read_text(encoding="utf-8")


def test_without_keep_going_nothing_more_is_begun(archive, batch):
    damage_points(archive / "hall_0.ptx")
    status, out, _ = batch()
    assert status == 1 and "2 not begun" in out
    assert not (archive / "colored" / "hall_1.png").exists()


def test_a_slice_of_the_manifest(archive, batch):
    status, out, _ = batch("--index", "2-3")
    assert status == 0 and "2 done" in out
    assert not (archive / "colored" / "hall_0.png").exists()
    assert batch("--index", "4")[0] == 2


def test_check_alone_touches_nothing(archive, batch):
    status, out, _ = batch("--check")
    assert status == 0 and "scans: 3" in out and "memory" in out
    assert out.splitlines()[-1] == "batch.toml: nothing wrong was found"
    assert "earlier run" not in out and "earlier run" in batch("--check", "--resume")[1]
    assert not (archive / "colored").exists()


def test_a_scan_and_a_photo_that_cannot_be_used_are_named_before_anything_is_begun(archive, batch):
    (archive / "hall_1.ptx").write_text("no scan\n")
    write_jpeg(archive / "a.jpg", np.full((64, 64, 3), 90, np.uint8))
    data = (archive / "a.jpg").read_bytes()
    (archive / "a.jpg").write_bytes(data[: len(data) // 2])
    (archive / "b.png").write_bytes(b"no photo")
    names = (archive / "batch.toml").read_text(encoding="utf-8")
    text = names.replace(
        'output = "colored"\n', 'output = "colored"\nphotos = ["a.jpg", "b.png"]\nscans = "hall_?.ptx"\n'
    )
    (archive / "batch.toml").write_text(text.replace('seeds = "hall_0.seeds.json"\n', ""), encoding="utf-8")
    status, out, err = batch("--check")
    assert status == 2 and "scans: 3" not in out
    found = [line.removeprefix("error: batch.toml: ") for line in err.splitlines()]
    assert found[0].startswith("line 4: a.jpg: ") and "damaged" in found[0]
    assert found[1].startswith("line 4: b.png: is not an image that can be read")
    assert found[2].startswith("line 10: hall_1.ptx: line 1: expected the number of columns")
    assert found[3:] == [
        "3 things are wrong, see above; mend these files or take them out, or go on without them by --keep-going"
    ]
    status, out, _ = batch("--check", "--keep-going")
    assert status == 2 and "scans: 2, about" in out
    status, out, err = batch()
    assert status == 2 and "go on without them by --keep-going" in err
    assert not (archive / "colored").exists()


def test_a_scan_without_a_grid_is_told_the_way_out_that_a_manifest_has(archive, batch):
    (archive / "old").mkdir()
    (archive / "old" / "cloud.pts").write_text("1 2 3 4\n2 3 4 5\n")
    (archive / "batch.toml").write_text(HEAD + 'scans = "old/*"\nseeds = "hall_0.seeds.json"\n', encoding="utf-8")
    status, _, err = batch("--check")
    assert status == 2 and "line 4: old/cloud.pts: scan 'cloud' has no grid" in err
    assert 'in the manifest: reading = { grid = "angle" }' in err


def test_a_scan_that_a_file_does_not_hold_is_told_before_anything_is_begun(archive, batch):
    text = HEAD + '[[scan]]\nfile = "hall_0.ptx"\nseeds = "hall_0.seeds.json"\nscan = '
    (archive / "batch.toml").write_text(text + "1\n", encoding="utf-8")
    assert batch("--check")[0] == 0
    (archive / "batch.toml").write_text(text + "2\n", encoding="utf-8")
    status, _, err = batch("--check")
    assert status == 2 and "batch.toml: line 4: hall_0.ptx: holds 1 scan, so scan 2 is none" in err


def test_of_the_photos_of_an_archive_seeds_open_only_those_that_they_name(archive, batch):
    for name, level in (("a.png", 60), ("b.png", 200)):
        write_png(archive / name, np.full((40, 60, 3), level, np.uint8))
    Seeds([1], [2], [[0, 0, 0]], photos=["a.png"], photo_xy=[[5.0, 5.0]]).save(archive / "hall_0.seeds.json")
    text = HEAD + 'write = "png"\nscans = "hall_0.ptx"\nphotos = "?.png"\nseeds = "{scan}.seeds.json"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    status, out, err = batch()
    assert status == 0 and "hall_0: done in" in out and "warning" not in out + err
    report = read_report(archive / "colored" / "reports" / "hall_0.json")
    assert [entry["path"] for entry in report["inputs"] if entry["role"] == "photo"] == ["a.png"]
    # Another photo in the archive changes nothing for it.
    write_png(archive / "c.png", np.full((40, 60, 3), 90, np.uint8))
    assert "1 done before" in batch("--resume")[1]


def test_what_is_there_twice_is_worked_on_once_and_told(archive, batch):
    rng = np.random.default_rng(0)
    write_png(archive / "a.png", rng.integers(0, 256, (40, 60, 3)).astype(np.uint8))
    for name, copy in (("a.png", "a (copy).png"), ("hall_0.ptx", "b.ptx")):
        (archive / copy).write_bytes((archive / name).read_bytes())
    (archive / "batch.toml").write_text(HEAD + 'scans = ["hall_0.ptx", "b.ptx"]\nphotos = "a*.png"\n', encoding="utf-8")
    told = batch("--check")[1]
    assert "a (copy).png: the same photo as a.png" in told and "hall_0.ptx: the same scan as b.ptx" in told
    status, out, _ = batch()
    assert status == 0
    assert "a (copy).png: the same photo as a.png, so it is left out\n" in out
    assert "hall_0.ptx: the same scan as b.ptx\n" in out
    assert "b: the photo tried does not show it for certain (scan 1 of 1)" in out and "1 the same as another" in out
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        notes = {
            (row["scan"], row["photo"]): row["note"] for row in csv.DictReader(file) if row["shows"] == "not tried"
        }
    assert notes == {
        ("b", "a (copy).png"): "the same file as a.png",
        ("hall_0", "a (copy).png"): "the same file as a.png",
        ("hall_0", "a.png"): "the same scan as b",
    }
    row = table_of(archive)["hall_0"]
    assert (row["state"], row["file"]) == ("duplicate", "hall_0.ptx")
    assert row["note"] == "the same as b, whose results are its own, too"


def test_the_same_scan_with_other_settings_is_worked_on(archive, batch):
    (archive / "hall_1.ptx").write_bytes((archive / "hall_0.ptx").read_bytes())
    status, out, _ = batch()
    assert status == 0 and "hall_1.ptx: the same scan as hall_0.ptx" in out and "3 done" in out


def test_the_estimate_rests_on_the_sizes_in_the_headers(archive, batch):
    # A scan without returns is a small file.
    zero = "0 0 0 0\n" * 2_000_000
    head = "2000\n1000\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
    (archive / "hall_0.ptx").write_text(head + zero)
    assert "scans: 3, about 2.0 megapixels together" in batch("--check")[1]


def test_a_scan_that_cannot_be_read_fails_also_where_photos_are_looked_for(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    write_png(archive / "a.png", np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_0.ptx"\nphotos = "a.png"\n', encoding="utf-8")
    status, out, err = batch("--keep-going")
    assert status == 1 and "1 failed: hall_0" in err.replace("1 of 1 failed", "1 failed"), out + err
    assert "hall_0.ptx: line 1" in table_of(archive)["hall_0"]["note"]


def test_a_slice_knows_what_others_have_found_for_their_scans(archive, batch):
    write_png(archive / "a.png", np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_[01].ptx"\nphotos = "a.png"\n', encoding="utf-8")
    assert batch("--stage", "match", "--index", "1")[0] == 0
    assert batch("--stage", "color", "--index", "2")[0] == 0
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        shows = {row["scan"]: row["shows"] for row in csv.DictReader(file)}
    assert shows == {"hall_0": "cannot be tested", "hall_1": "cannot be tested"}


def test_a_scan_that_no_photo_shows_any_more_is_told_so(archive, batch):
    batch()
    folder = BatchFolder(Path("colored"))
    folder.remember("items", "hall_1", {"outcome": "unshown", "error": "", "left_out": ["hall_1"]})
    assert main(["report", "colored"]) == 0
    assert table_of(archive)["hall_1"]["state"] == "unshown"


@pytest.mark.parametrize("killed", [False, True])
def test_what_was_colored_earlier_is_deleted_where_no_photo_shows_the_scan_any_more(archive, batch, killed):
    batch()
    results = archive / "colored"
    if killed:
        # As a batch leaves it that was killed after it had begun the scan.
        Done(BatchFolder(Path("colored")), None).begin("hall_0", "color")
    (results / "hall_1.png").write_bytes(b"painted over by hand")
    write_png(archive / "a.png", np.zeros((40, 60, 3), np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_[01].ptx"\nphotos = "a.png"\n', encoding="utf-8")
    status, out, err = batch("--resume")
    assert status == 0 and "2 without a certain photo" in out
    assert (
        "hall_1: no photo shows it for certain any more, but what was changed" in err and "stays: hall_1.png\n" in err
    )
    assert "hall_0: deleted what an earlier run had colored" in out
    left = {
        path.relative_to(results).as_posix() for path in results.rglob("hall_[01]*") if "batch-state" not in path.parts
    }
    # What was changed by hand stays.
    assert {name for name in left if not name.startswith("logs/")} == {
        "hall_1.png",
        "reports/hall_0.jpg",
        "reports/hall_1.jpg",
    }
    # What the manifest does not name any more is not touched.
    assert (results / "hall_2.png").is_file()
    # Looks and matches that said nothing leave no empty logs.
    assert all(log.stat().st_size for log in (results / "logs").iterdir())


def test_names_in_the_table_of_pairs_that_the_batch_does_not_have_are_told(archive, batch):
    write_png(archive / "a b.png", np.zeros((40, 60, 3), np.uint8))
    text = HEAD + 'pairs = "mine.csv"\nscans = "hall_0.ptx"\nphotos = "*.png"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    rows = "".join(f"other {number},a b.png,no\n" for number in range(20))
    (archive / "mine.csv").write_text(f"scan,photo,shows\nhal_0,a b.png,yes\nhall_0,a_b.png,yes\n{rows}")
    status, out, err = batch("--check")
    assert status == 0 and "batch.toml: no error was found, but look at the warnings" in out
    assert "mine.csv: line 2: 'hal_0' is no scan of this batch" in err and "did you mean hall_0?" in err
    assert "mine.csv: 2 more names are of no scan or photo" in err
    (archive / "mine.csv").write_text("scan,photo,shows\nhall_0,a_b.png,yes\n")
    assert "mine.csv: line 2: 'a_b.png' is no photo of this batch" in batch("--check")[2]
    (archive / "photos").mkdir()
    (archive / "a b.png").rename(archive / "photos" / "a b.png")
    (archive / "batch.toml").write_text(text.replace("*.png", "photos/*.png"), encoding="utf-8")
    (archive / "mine.csv").write_text("scan,photo,shows\nhall_0,a b.png,yes\n")
    assert "did you mean photos/a b.png?" in batch("--check")[2]


def test_a_yes_that_has_no_effect_because_the_photo_is_not_verified_is_told(archive, batch):
    noise = np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8)
    write_png(archive / "a.png", noise)
    text = HEAD + 'pairs = "mine.csv"\nscans = "hall_[01].ptx"\nphotos = "*.png"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    (archive / "mine.csv").write_text("scan,photo,shows\nhall_0,a.png,yes\nhall_1,a.png,no\n")
    status, _, err = batch()
    assert status == 0
    assert "a.png: shows hall_0, as mine.csv says, but is not verified there, so it gives no colors" in err
    assert "hall_1, as mine.csv says" not in err
    # The report and the table tell so, too.
    said = "a.png: is not verified, so it gives no colors, although mine.csv says yes"
    notes = {name: row["note"] for name, row in table_of(archive).items()}
    assert notes["hall_0"].startswith(said) and notes["hall_1"].startswith("a.png: gives no colors, as mine.csv says")
    assert f"hall_0: {said.removeprefix('a.png: ')}" in (archive / "colored" / "report.html").read_text("utf-8")
    assert "; yes as mine.csv says" in (archive / "colored" / "pairs.csv").read_text("utf-8")


def test_a_table_of_pairs_that_is_fed_back_as_it_is_changes_nothing(archive, batch):
    noise = np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8)
    write_png(archive / "a.png", noise)
    text = HEAD + 'scans = "hall_[01].ptx"\nphotos = "*.png"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    for number in range(2):
        write_ptx(Room(number).scan(40, 65, 1.2), archive / f"hall_{number}.ptx")
    assert batch()[0] == 0
    table = (archive / "colored" / "pairs.csv").read_bytes()
    assert table.count(b",no,") == 2
    (archive / "mine.csv").write_bytes(table)
    (archive / "batch.toml").write_text(text + 'pairs = "mine.csv"\n', encoding="utf-8")
    assert batch("--resume")[0] == 0
    assert (archive / "colored" / "pairs.csv").read_bytes() == table


def test_a_texture_of_each_scan(archive, batch):
    text = (archive / "batch.toml").read_text(encoding="utf-8")
    (archive / "batch.toml").write_text(text.replace("write =", "texture = 64\nwrite ="), encoding="utf-8")
    assert batch()[0] == 0
    made = read_image(archive / "colored" / "hall_0.png")
    assert max(made.shape) == 64
    # A picture is rendered from it, with the same image on the mesh.
    colors = Output("-o", Path("again.glb"), MESH)
    plan = {"scans": (Path("hall_0.ptx"),), "outputs": (colors,), "colors": Path("colored/hall_0.png")}
    run_plan(Plan(**plan, texture=64), Session())
    np.testing.assert_array_equal(Glb("again.glb").image(), made)
    with pytest.raises(ScanError, match="expected 16 x 12"):
        run_plan(Plan(**plan), Session())


def test_seeds_of_each_scan_of_a_file_count_for_what_was_done(archive, batch):
    one, two = (random_scan(number, (12, 16)) for number in range(2))
    write_ptx([one, two], archive / "pair.ptx")
    names = [scan.name for scan in read_scans(archive / "pair.ptx")]
    labels = [f"pair+{safe_label(name)}" for name in names]
    for label in labels:
        Seeds([1], [2], [[200, 80, 40]]).save(archive / f"{label}.seeds.json")
    text = HEAD + '[[scan]]\nfile = "pair.ptx"\nseeds = "{scan}.seeds.json"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    assert batch()[0] == 0
    assert "0 done, 1 done before" in batch("--resume")[1]
    Seeds([1], [2], [[20, 80, 240]]).save(archive / f"{labels[1]}.seeds.json")
    _, out, err = batch("--resume")
    assert "1 done, 0 done before" in out, err


def test_a_plan_comes_whole_out_of_its_document():
    plan = Plan(
        scans=(Path("a.ptx"), Path("b.ptx")),
        outputs=(Output("write", Path("{scan}.png"), IMAGE),),
        settings=Settings.preset("Natural", alpha=5),
        wanted="2",
        name="hall",
        seeds=Path("s.json"),
        hand=Path("h.json"),
        from_color=7,
        photos=(Path("p.jpg"),),
        colors=Path("c.png"),
        outside_files=True,
        reading=ReadOptions(turn_deg=90, step=2, position=(1.0, 2.0, 3.0)),
        texture=512,
        faces=5000,
        picture=Picture(look="lit", filled=False),
        left_out=("hall+2",),
        skip_unshown=True,
    )
    assert all(getattr(plan, field.name) != field.default for field in fields(plan) if field.default is not MISSING)
    assert from_document(json.loads(json.dumps(as_document(plan)))) == plan


def test_the_estimate_of_memory_counts_photos_that_are_open_together_not_all_that_may_be_tried(archive):
    make_archive(archive, count=12)
    for number in range(24):
        (archive / f"{number}.jpg").write_bytes(b"")
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_*.ptx"\nphotos = "*.jpg"\n', encoding="utf-8")
    manifest = load_manifest(archive / "batch.toml", pytest.fail)
    costs = Costs(photos=dict.fromkeys(manifest.photos, 50_000_000))
    said = estimate(manifest, Options(workers=1, memory=1 << 40), costs)[1]
    scans = manifest.items[0].plan.scans
    assert said.values["memory"] == readable(costs.memory(scans, manifest.photos[:6]))
