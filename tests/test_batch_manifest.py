"""The manifest of a batch: what it means, and that everything wrong with it is named at once."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from archives import HEAD, make_archive
from small_scans import random_scan

from reflcolor_addon import Seeds
from reflcolor_addon.batch.archive import manifest_file
from reflcolor_addon.batch.archive.check import check_manifest
from reflcolor_addon.batch.archive.draft import draft
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.batch.archive.names import item_names
from reflcolor_addon.batch.archive.pairs import read_pairs
from reflcolor_addon.errors import UsageError
from reflcolor_addon.files.images import write_jpeg, write_png
from reflcolor_addon.files.readers import ReadOptions, read_scans
from reflcolor_addon.files.writers import write_ptx


def read(folder, text):
    """The manifest of this text in a folder, and the lines of what is wrong with it."""
    path, faults = folder / "batch.toml", []
    path.write_text(text, encoding="utf-8")
    manifest = load_manifest(path, faults.append)
    if manifest is not None:
        check_manifest(manifest, None, faults.append)
    return manifest, [str(fault).removeprefix(f"{path}: ") for fault in faults]


@pytest.fixture
def folder(tmp_path):
    make_archive(tmp_path)
    (tmp_path / "photos").mkdir()
    for name in ("a.png", "b.png"):
        write_png(tmp_path / "photos" / name, np.full((8, 8, 3), 90, np.uint8))
    return tmp_path


def test_patterns_defaults_and_what_one_scan_has_of_its_own(folder):
    manifest, faults = read(
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
    manifest, faults = read(folder, text + 'reading = { grid = "angle", position = [1, 2, 3] }\n')
    assert faults == []
    first, other, _ = (item.plan.reading for item in manifest.items)
    assert first == ReadOptions(step=2)
    assert other == ReadOptions(step=2, grid="angle", position=(1.0, 2.0, 3.0))
    _, faults = read(folder, text + 'reading = { stp = 2, grid = "round", step = "2", position = [1] }\n')
    assert [fault.partition(": reading: ")[2].partition(" ")[0] for fault in faults] == [
        "unknown",
        "grid:",
        "step:",
        "position:",
    ]
    assert all(fault.startswith("line 9: ") for fault in faults)


def test_scans_of_one_site_are_one_item(folder):
    table = '[[scan]]\nfile = "hall_{}.ptx"\nsite = "hall"\n'
    manifest, faults = read(folder, HEAD + 'photos = "photos/a.png"\n' + table.format(0) + table.format(2))
    assert faults == []
    (item,) = manifest.items
    assert item.name == "hall"
    assert [path.name for path in item.plan.scans] == ["hall_0.ptx", "hall_2.ptx"]


def test_a_site_takes_what_any_of_its_scans_says_and_refuses_what_they_disagree_on(folder):
    table = '[[scan]]\nfile = "hall_{}.ptx"\nsite = "hall"\n'
    text = HEAD + 'photos = "photos/a.png"\n' + table.format(0) + table.format(2)
    manifest, faults = read(folder, text + 'preset = "Paper"\nwrite = ["glb"]\n')
    assert faults == []
    assert manifest.items[0].plan.settings.light == 0
    assert manifest.items[0].plan.outputs[0].path.suffix == ".glb"
    first = HEAD + 'photos = "photos/a.png"\n' + table.format(0) + 'preset = "Natural"\n' + table.format(2)
    _, faults = read(folder, first + 'preset = "Paper"\nscan = "1"\n')
    assert [fault[: fault.index(": ", 9)] for fault in faults] == ["line 13: scan", "line 12: preset"]


def test_what_counts_for_a_site_is_the_last_value_of_each_scan(folder):
    both = '[[scan]]\nfile = "hall_*.ptx"\npreset = "Natural"\n'
    site = '[[scan]]\nfile = "hall_*.ptx"\nsite = "hall"\npreset = "Paper"\n'
    manifest, faults = read(folder, HEAD + 'photos = "photos/a.png"\n' + both + site)
    assert faults == []
    assert manifest.items[0].plan.settings.light == 0


def test_scans_of_one_name_are_called_by_their_folders_too(folder):
    for name in ("east", "west"):
        (folder / name).mkdir()
        write_ptx(random_scan(), folder / name / "Hall 1.ptx")
    manifest, faults = read(folder, HEAD + 'scans = ["*/Hall 1.ptx"]\nphotos = "photos/a.png"\n')
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


def test_everything_wrong_is_named_at_once_with_its_line(folder):
    (folder / "broken.seeds.json").write_text("{", encoding="utf-8")
    lines = (
        'format = "reflcolor-batch"',
        "version = 1",
        'output = "colored"',
        'scans = ["hall_0.ptx", "missing_*.ptx"]',
        'photos = ["photos/c.png"]',
        'write = ["png", "tif"]',
        'preset = "Natrual"',
        "render = 1",
        "colour = true",
        "[settings]",
        "alpha = -1",
        "alhpa = 3",
        "[[scan]]",
        'file = "hall_0.ptx"',
        'seeds = "nowhere.json"',
        "[[scan]]",
        'file = "hall_1.ptx"',
        'seeds = "broken.seeds.json"',
        "[[scan]]",
        'name = "nameless"',
        "[[scan]]",
        'file = "hall_2.ptx"',
        'photos = "batch.toml"',
    )
    _, faults = read(folder, "\n".join(lines) + "\n")
    found = {}
    for fault in faults:
        number = int(re.match(r"line (\d+): ", fault)[1])
        found.setdefault(number, []).append(fault)
    for number, word in {
        4: "missing_*.ptx",
        5: "photos/c.png",
        6: "tif",
        7: "Natrual",
        8: "render",
        9: "colour",
        11: "alpha",
        12: "did you mean alpha?",
        15: "nowhere.json",
        16: "broken.seeds.json",
        19: "file: is missing",
        23: "no image by its name",
    }.items():
        assert any(word in fault for fault in found.get(number, [])), (number, word, faults)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("scans = [", "is not TOML"),
        ('output = "x"\n', "expected format = "),
        (HEAD, "no scan is named"),
        (HEAD + 'scans = "hall_0.ptx"\n', "has neither seeds nor photos"),
        ('format = "reflcolor-batch"\nversion = 1\n', "output: is missing"),
        (HEAD + 'pairs = "no.csv"\n', "there is no file no.csv"),
        (HEAD + 'pairs = "colored/pairs.csv"\n', "the batch writes colored/pairs.csv anew each time"),
        (HEAD.replace('"colored"', '"a\\u0000b"'), "holds a null character"),
        (HEAD + f"faces = {'9' * 5000}\n", "is not TOML"),
    ],
)
def test_what_cannot_be_worked_on(folder, text, expected):
    _, faults = read(folder, text)
    assert any(expected in fault for fault in faults), faults


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ('scans = "hal_0.ptx"\n', "hall_0.ptx"),
        ('scans = "hall_0.ptx"\nphotos = "a.png"\n', "photos/a.png"),
        ('[[scan]]\nfile = "hall_0.ptx"\nseeds = "seeds/{scan}.seeds.json"\n', "hall_0.seeds.json"),
        ('scans = "hall_0.ptx"\npairs = "Mine.csv"\n', "tables/mine.csv"),
    ],
)
def test_a_file_that_does_not_exist_is_told_with_one_that_may_be_meant(folder, text, meant):
    for name in ("tables/mine.csv", "hidden/batch-state/done", "hidden/hall_3.ptx", "hidden/a_.png"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    _, faults = read(folder, HEAD + text)
    assert any(f"did you mean {meant}?" in fault for fault in faults), faults
    # Neither a file of another kind, nor one with other digits, nor results of a batch; of a pattern only its capitals.
    for names in ("*.laz", "hall_9.ptx", "hall_3.ptx"):
        _, faults = read(folder, HEAD + f'scans = "{names}"\n')
        assert faults == [f"line 4: scan '{names}': there is no such file"]
    _, faults = read(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "hall_1.jpg"\n')
    assert faults == ["line 5: photo 'hall_1.jpg': there is no such file"]
    _, faults = read(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "photos/A*.PNG"\n')
    assert faults == ["line 5: photo 'photos/A*.PNG': there is no such file; capitals count: there is photos/a.png"]


def test_what_people_write_by_mistake_is_told_with_what_to_write(folder):
    def told(text):
        return [fault.partition(": ")[2] for fault in read(folder, HEAD + text)[1]]

    scan = '[[scan]]\nfile = "hall_0.ptx"\n'
    assert told(scan + 'photos = "photos"\n') == ["photo 'photos': is a folder; write \"photos/*\""]
    assert told(scan + 'photos = ""\n') == ["photo '': there is no such file"]
    assert told(scan + f'hand = "{"h" * 300}"\nphotos = "photos/a.png"\n')[0].startswith("hand 'hhh")
    # What else is wrong with a scan that does not exist is told, too, and what follows from an error is not.
    other = 'photos = "photos/c.png"\nskip = "yes"\nsettings = { alpha = -1 }\nseeds = "a.json"\n'
    assert told('[[scan]]\nfile = "hal_0.ptx"\n' + other) == [
        "scan 'hal_0.ptx': there is no such file; did you mean hall_0.ptx?",
        "skip: expected true or false, found 'yes'",
        "photo 'photos/c.png': there is no such file",
        f"seeds 'a.json': there is no file {folder / 'a.json'}",
        "alpha: expected a number from 0.1 to 64, found -1",
    ]
    assert told(scan + 'photos = "photos/c.png"\n') == ["photo 'photos/c.png': there is no such file"]
    assert read(folder, HEAD + scan + 'photos = "photos/a.png"\nscan = 1\n')[0].items[0].plan.wanted == "1"
    assert told(scan + 'photos = "photos/a.png"\nscan = 0\n') == ["scan 0: expected a name, or a number from 1"]
    assert told('photos = "photos/a.png"\n' + scan + "photos = []\n") == [
        f"{folder / 'hall_0.ptx'}: has neither seeds nor photos; give one of them"
    ]
    assert told(scan + f'photos = "photos/a.png"\nscan = 0x{"f" * 5000}\n') == ["a number is too large"]
    assert told(scan + 'photos = "photos/a.png"\npairs = "a.csv"\n') == [
        "pairs: is said of the whole batch; write it at the top"
    ]
    assert told('tone = 1.2\nscans = "hall_0.ptx"\nphotos = "photos/a.png"\n') == [
        "tone: is a setting; write settings = { tone = ... }"
    ]
    assert "found '2'" in told(scan + 'photos = "photos/a.png"\nreading = { step = "2" }\n')[0]
    named = "".join(f'[[scan]]\nfile = "hall_{number}.ptx"\nname = "Halle"\n' for number in range(2))
    assert told('photos = "photos/a.png"\n' + named) == ["name 'Halle': line 7 has it, too; give each its own"]


@pytest.mark.parametrize(
    ("text", "way"),
    [
        ('scans = "a.ptx"\n[[scans]]\n', "[[scan]] begins the table of one scan"),
        ('scans = "a.ptx"\nscans = "b.ptx"\n', "a name may stand only once"),
        ("settings = { tone = 1,2 }\n", "a number needs a point, not a comma"),
        ("preset = Natural\n", "a text needs quotes"),
        ('scans = "c:\\users\\a.ptx"\n', "write / between folders"),
        ('scans = "a.ptx\n', "a closing quote is missing"),
        ("render = True # as c:\\a\n", "true and false small letters"),
    ],
)
def test_what_is_no_toml_is_told_with_what_to_write(folder, text, way):
    _, (fault,) = read(folder, HEAD + text)
    assert fault.startswith("is not TOML: ") and way in fault and "line " in fault


def test_what_is_wrong_for_all_scans_is_said_once_and_where_it_belongs(folder):
    text = (
        HEAD
        + 'scans = "*.ptx"\nphotos = "photos/a.png"\npreset = "Best"\n'
        + 'settings = { texture = 5 }\nsites = 1\nhand = "a"\n'
    )
    _, faults = read(folder, text)
    assert [fault.partition(": ")[2] for fault in faults] == [
        "unknown key 'sites'",
        "hand: is said of one scan; write it below a [[scan]] with its file",
        "preset 'Best': expected one of Natural, Enhanced, Paper",
        "unknown setting 'texture'",
    ]
    _, (fault,) = read(folder, HEAD + 'photos = "photos\\*.png"\n')
    assert fault.startswith("is not TOML") and fault.endswith("; write / between folders")


def test_a_table_of_pairs_that_is_none_is_refused_in_one_line(tmp_path):
    (tmp_path / "pairs.csv").write_text(f'scan,photo,shows\nhall,"{"x" * 200_000}",yes\n')
    with pytest.raises(UsageError, match=r"pairs\.csv: line 2: is no table") as caught:
        read_pairs(tmp_path / "pairs.csv")
    assert str(caught.value).isprintable()


def test_a_file_that_is_no_text(folder):
    path, faults = folder / "batch.toml", []
    path.write_bytes(b"output = '\xff'\n")
    assert load_manifest(path, faults.append) is None
    assert "line 1: is not UTF-8" in str(faults[0])


def test_results_never_take_the_place_of_inputs(folder):
    (folder / "colored").mkdir()
    write_png(folder / "colored" / "hall_0.png", np.zeros((4, 4, 3), np.uint8))
    _, faults = read(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "colored/hall_0.png"\n')
    assert any("would be overwritten" in fault for fault in faults), faults


def test_a_draft_names_every_scan_and_photo_and_is_a_manifest_without_faults(folder):
    (folder / "Bilder 2003 [alt]").mkdir()
    write_png(folder / "Bilder 2003 [alt]" / "dach.png", np.zeros((4, 4, 3), np.uint8))
    (folder / "batch.toml").unlink()
    manifest, faults = read(folder, draft(folder, folder / "batch.toml"))
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
    manifest, faults = read(folder, text.replace("render = false", "\n".join(["render = false", *said])))
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
    manifest, _ = read(folder, text)
    assert {path.name for path in manifest.photos} >= {"hall_0.jpg", "hall_1.png", "hall_2.png"}
    assert "hall_0.png" not in {path.name for path in manifest.photos}


def test_a_draft_takes_a_text_of_points_for_a_scan_and_leaves_out_other_texts(folder):
    (folder / "README.txt").write_text("Hall, scanned in 2003 by Anna\n1 photo is missing\n\n12, 13\n")
    (folder / "cloud.txt").write_text("// x;y;z;intensity\n1.5;2.5;3.5;0.2\n")
    text = draft(folder, folder / "batch.toml")
    assert "cloud.txt" in text and "README.txt" not in text


def test_seeds_named_for_all_scans_may_be_missing_where_there_are_photos(folder):
    Seeds([1], [2], [[1, 2, 3]]).save(folder / "hall_0.json")
    manifest, faults = read(folder, HEAD + 'scans = "hall_*.ptx"\nphotos = "photos/a.png"\nseeds = "{scan}.json"\n')
    assert faults == []
    assert [item.offered for item in manifest.items] == [False, True, True]
    assert manifest.items[0].plan.seeds == Path(folder / "{scan}.json")


def test_light_meshes_are_a_number_of_faces_and_need_blender_and_a_mesh(folder):
    text = HEAD + 'scans = "hall_0.ptx"\nphotos = "photos/a.png"\nwrite = ["{}"]\nfaces = {}\n'
    manifest, (fault,) = read(folder, text.format("glb", 5000))
    assert manifest.items[0].plan.faces == 5000 and "faces needs Blender" in fault
    assert "none of the outputs has a mesh" in read(folder, text.format("png", 5000))[1][0]
    assert read(folder, text.format("png", 99))[1][0] == (
        f"line {HEAD.count(chr(10)) + 4}: faces 99: expected a whole number from 100 to 100000000"
    )
