"""Everything wrong with a manifest is named at once, each with its line and what to write instead."""

import re
from pathlib import Path

import pytest
from archives import HEAD, read_manifest

from reflcolor_addon.batch.archive.draft import draft
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.batch.archive.pairs import read_pairs
from reflcolor_addon.errors import UsageError


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
    _, faults = read_manifest(folder, "\n".join(lines) + "\n")
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
    _, faults = read_manifest(folder, text)
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
    _, faults = read_manifest(folder, HEAD + text)
    assert any(f"did you mean {meant}?" in fault for fault in faults), faults
    # Neither a file of another kind, nor one with other digits, nor results of a batch; of a pattern only its capitals.
    for names in ("*.laz", "hall_9.ptx", "hall_3.ptx"):
        _, faults = read_manifest(folder, HEAD + f'scans = "{names}"\n')
        assert faults == [f"line 4: scan '{names}': there is no such file"]
    _, faults = read_manifest(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "hall_1.jpg"\n')
    assert faults == ["line 5: photo 'hall_1.jpg': there is no such file"]
    _, faults = read_manifest(folder, HEAD + 'scans = "hall_0.ptx"\nphotos = "photos/A*.PNG"\n')
    assert faults == ["line 5: photo 'photos/A*.PNG': there is no such file; capitals count: there is photos/a.png"]


def test_what_people_write_by_mistake_is_told_with_what_to_write(folder):
    def told(text):
        return [fault.partition(": ")[2] for fault in read_manifest(folder, HEAD + text)[1]]

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
    assert read_manifest(folder, HEAD + scan + 'photos = "photos/a.png"\nscan = 1\n')[0].items[0].plan.wanted == "1"
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
    named = named.replace('name = "Halle"', 'site = "halle"', 1)
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
    _, (fault,) = read_manifest(folder, HEAD + text)
    assert fault.startswith("is not TOML: ") and way in fault and "line " in fault


def test_what_needs_blender_is_said_once_with_the_line_that_asks_for_it(folder):
    scans = 'scans = "hall_?.ptx"\nphotos = "photos/a.png"\n'
    told = "{what} needs Blender; run the batch as: blender -b --command reflcolor batch ..."
    for line, what in (('write = ["PNG", "blend"]', "write .blend"), ("render = true", "render")):
        assert read_manifest(folder, HEAD + scans + line + "\n")[1] == [f"line 6: {told.format(what=what)}"]
    own = '[[scan]]\nfile = "hall_1.ptx"\nwrite = "usd"\n'
    assert read_manifest(folder, HEAD + scans + own)[1] == [f"line 8: {told.format(what='write .usd')}"]


def test_folders_that_may_not_be_looked_into_hide_no_fault_and_no_scan(folder, monkeypatch):
    (folder / "closed").mkdir()
    (folder / "closed" / "hal_0.ptx").touch()
    look = Path.stat

    def stat(path, **options):
        if "closed" in path.parent.parts:
            raise PermissionError(13, "Permission denied", str(path))
        return look(path, **options)

    monkeypatch.setattr(Path, "stat", stat)
    with pytest.raises(PermissionError):
        (folder / "closed" / "hal_0.ptx").exists()
    _, faults = read_manifest(folder, HEAD + 'scans = "hal_0.ptx"\nphotos = "photos/a.png"\n')
    assert faults == ["line 4: scan 'hal_0.ptx': there is no such file; did you mean hall_0.ptx?"]
    assert "hall_0.ptx" in draft(folder, folder / "batch.toml")


def test_what_is_wrong_for_all_scans_is_said_once_and_where_it_belongs(folder):
    text = (
        HEAD
        + 'scans = "*.ptx"\nphotos = "photos/a.png"\npreset = "Best"\n'
        + 'settings = { texture = 5 }\nsites = 1\nhand = "a"\n'
    )
    _, faults = read_manifest(folder, text)
    assert [fault.partition(": ")[2] for fault in faults] == [
        "unknown key 'sites'",
        "hand: is said of one scan; write it below a [[scan]] with its file",
        "preset 'Best': expected one of Natural, Enhanced, Paper",
        "unknown setting 'texture'",
    ]
    _, (fault,) = read_manifest(folder, HEAD + 'photos = "photos\\*.png"\n')
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
