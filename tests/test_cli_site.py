"""The command line with several scans of one site."""

import json
import signal
import weakref
from pathlib import Path

import numpy as np
import painted_room
import pytest
from command_line import COLORIZE, SHAPE, assert_refused, blender_tasks
from gltf_files import Glb
from plyfile import PlyData
from small_scans import random_scan

from reflcolor_addon import Cancelled, Seeds, Settings, colorize, read_scans
from reflcolor_addon.batch.read import distinct, safe_label
from reflcolor_addon.files.images import read_image, write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching import match_site

SITE = ("colorize", "south.ptx", "east.ptx", "--seeds", "{scan}.json")
PAPER = ("--matching", "paper", "--slic-segments", "40")


@pytest.fixture
def site(cli_folder):
    """The folder with two scans of a site and the seeds of each."""
    for number, name in enumerate(("south", "east")):
        write_ptx(random_scan(number, SHAPE), cli_folder / f"{name}.ptx")
        Seeds([1, 4], [2, 8], [[200, 80, 40 + number], [20, 80, 220]]).save(f"{name}.json")
    return cli_folder


@pytest.fixture
def painted(cli_folder):
    """The folder with two larger scans of a site and a photo."""
    for number, name in enumerate(("south", "east")):
        write_ptx(painted_room.scan(20, 30, 1.8, seed=number), cli_folder / f"{name}.ptx")
    write_png(cli_folder / "view.png", painted_room.photo(painted_room.camera(width=120, height=90)))
    return cli_folder


def expected_colors(name):
    (scan,) = read_scans(f"{name}.ptx")
    return colorize(scan, Seeds.load(f"{name}.json"), Settings.preset("Natural")).rgb


def read_json(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def files(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*"))


# Which scans, and what each is called


def test_every_scan_of_every_file_is_colorized_from_its_own_seeds(run_cli, site):
    outcome = run_cli(*SITE, "-o", "{scan}.png", "--report", "r_{scan}.json")
    names = ("south.png", "east.png", "r_south.json", "r_east.json")
    assert outcome == (0, "".join(f"wrote {name}\n" for name in names), "")
    for name in ("south", "east"):
        assert (read_image(site / f"{name}.png") == expected_colors(name)).all()
        report = read_json(f"r_{name}.json")
        assert [entry["path"] for entry in report["inputs"]] == [f"{name}.ptx", f"{name}.json"]
        assert [entry["path"] for entry in report["outputs"]] == [f"{name}.png", f"r_{name}.json"]
        assert set(report["times_s"]) == {"seeds", "read", "colorize", "write"}


def test_all_scans_of_one_file_are_taken_when_that_is_said(run_cli, site):
    write_ptx([random_scan(seed, SHAPE) for seed in (1, 2)], site / "garage.ptx")
    (site / "south.json").replace(site / "garage_1.json")
    (site / "east.json").replace(site / "garage_2.json")
    arguments = ("colorize", "garage.ptx", "--scan", "all", "--seeds", "{scan}.json")
    assert run_cli(*arguments, "-o", "{scan}.png", "--report", "r_{scan}.json")[0] == 0
    for index, scan in enumerate(read_scans(site / "garage.ptx"), 1):
        expected = colorize(scan, Seeds.load(f"garage_{index}.json"), Settings.preset("Natural")).rgb
        assert (read_image(site / f"garage_{index}.png") == expected).all()
        assert read_json(f"r_garage_{index}.json")["scan"]["index"] == index


def test_a_file_of_several_scans_and_none_chosen_is_told_of_all(run_cli, site):
    write_ptx([random_scan(seed, SHAPE) for seed in (1, 2)], site / "garage.ptx")
    outcome = run_cli(*COLORIZE, "-o", "out.png")
    assert_refused(outcome, 2, "choose one by --scan NAME or --scan INDEX", "; --scan all takes every one")
    write_png(site / "out.png", np.zeros((*SHAPE, 3), np.uint8))
    assert "all" not in run_cli("evaluate", "garage.ptx", "out.png")[2]


@pytest.mark.parametrize("options", [(), ("--scan", "all")])
def test_with_one_scan_a_path_may_have_the_placeholder_or_not(run_cli, site, options):
    assert run_cli("colorize", "south.ptx", *options, "--seeds", "{scan}.json", "-o", "{scan}_1.png")[0] == 0
    assert run_cli("colorize", "south.ptx", *options, "--seeds", "south.json", "-o", "south_2.png")[0] == 0
    assert (site / "south_1.png").read_bytes() == (site / "south_2.png").read_bytes()


def test_scans_of_the_same_name_are_told_apart(run_cli, site):
    (site / "b").mkdir()
    (site / "east.ptx").replace(site / "b" / "south.ptx")
    (site / "east.json").replace(site / "south_2.json")
    arguments = ("colorize", "south.ptx", "b/south.ptx", "--seeds", "{scan}.json")
    assert run_cli(*arguments, "-o", "{scan}.png", "--report", "r_{scan}.json")[0] == 0
    assert [read_json(f"r_{name}.json")["scan"]["name"] for name in ("south", "south_2")] == ["south", "south 2"]


def test_names_that_are_made_distinct_do_not_take_those_of_others():
    assert distinct(["a", "b", "a", "a 2", "a"]) == ["a", "b", "a 3", "a 2", "a 4"]
    assert distinct(["A", "a"]) == ["A", "a"]
    assert distinct(["A", "a"], joint="_", key=str.casefold) == ["A", "a_2"]


@pytest.mark.parametrize(
    ("name", "label"),
    [("garage 1", "garage_1"), ("../up", "_up"), ("a/b:c", "a_b_c"), ("Halle Süd", "Halle_Süd"), ("..", "scan")],
)
def test_a_label_is_safe_in_a_file_name(name, label):
    assert safe_label(name) == label
    assert len(safe_label(f"{name} " * 100)) <= 60


# Refused before anything is read or written


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("-o", "out.png"), "-o out.png: each of several scans has its own; write {scan} where its name is to stand"),
        (("-o", "{scan}.png", "--report", "sub/r.json"), "--report sub/r.json"),
        (("-o", "{scan}.png", "--seeds", "seeds.json"), "--seeds seeds.json: each of several"),
        (("-o", "{scan}.png", "--scan", "1"), "--scan 1: chooses a scan of one file, but 2 are given"),
        (("-o", "{scan}.png", "--scan", "south"), "--scan south: chooses"),
    ],
    ids=lambda value: "" if isinstance(value, str) else " ".join(value),
)
def test_what_cannot_be_for_several_files_is_said_before_one_is_read(run_cli, site, arguments, part):
    before = files(site)
    gone = ("colorize", "gone.ptx", "gone2.ptx", "--seeds", "{scan}.json")
    assert_refused(run_cli(*gone, *arguments), 2, part)
    assert files(site) == before


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (("-o", "seeds.json"), "-o seeds.json: each of several scans has its own"),
        (("-o", "{scan}.json", "--matches", "m.png"), "--matches m.png: each of several"),
        (("-o", "{scan}.json", "--hand", "hand.json"), "as in {scan}_hand.json"),
    ],
    ids=lambda value: "" if isinstance(value, str) else " ".join(value),
)
def test_seeds_of_several_files_need_a_file_each(run_cli, site, options, part):
    assert_refused(run_cli("seeds", "gone.ptx", "gone2.ptx", "--photo", "gone.png", *options), 2, part)


def test_a_file_that_turns_out_to_hold_several_scans_needs_the_placeholder_too(run_cli, site):
    write_ptx([random_scan(seed, SHAPE) for seed in (1, 2)], site / "garage.ptx")
    before = files(site)
    outcome = run_cli("colorize", "garage.ptx", "--scan", "all", "--photo", "gone.png", "-o", "out.png")
    assert_refused(outcome, 2, "-o out.png: each of several scans", "as in {scan}_out.png")
    assert files(site) == before


def test_a_file_given_twice_is_wrong_usage(run_cli, site):
    assert_refused(run_cli("colorize", "south.ptx", "./south.ptx", *SITE[3:], "-o", "{scan}.png"), 2, "given twice")


def test_a_scan_without_its_seeds_is_named_before_anything_is_colorized(run_cli, site):
    (site / "east.json").unlink()
    before = files(site)
    outcome = run_cli(*SITE, "-o", "{scan}.png")
    assert_refused(outcome, 1, "east.json: no such file; expected the seeds of the scan east")
    assert files(site) == before


def test_seeds_of_another_scan_are_refused_by_their_file(run_cli, site):
    Seeds([99], [0], [[1, 2, 3]]).save(site / "east.json")
    before = files(site)
    outcome = run_cli(*SITE, "-o", "{scan}.png")
    assert_refused(outcome, 1, "east.json: seed 1: row 99", "expected seeds of the scan east")
    assert files(site) == before


def test_outputs_that_turn_out_to_be_the_same_file_or_an_input_are_refused(run_cli, site):
    before = files(site)
    assert_refused(run_cli(*SITE, "-o", "{scan}.png", "--report", "{scan}.json"), 2, "south.json: is an input")
    assert_refused(run_cli(*SITE, "-o", "{scan}.png", "-o", "e{scan}.png", "--report", "{scan}.ptx"), 2, "is an input")
    assert_refused(run_cli(*SITE, "-o", "{scan}/out.png"), 1, "there is no folder south; make it first")
    assert files(site) == before


def test_warnings_say_which_scan_they_are_about(run_cli, site):
    valid = np.ones(SHAPE, bool)
    valid[1, 2] = False
    write_ptx(random_scan(1, SHAPE, valid=valid), site / "east.ptx")
    assert run_cli(*SITE, "-o", "{scan}.png")[2] == (
        "warning: east: seed 1: no return at row 1, column 2; moved to row 0, column 2\n"
    )


def test_a_photo_that_serves_one_scan_is_not_called_idle(run_cli, site):
    for name in ("view.png", "idle.png"):
        write_png(site / name, np.full((4, 4, 3), 90, np.uint8))
    Seeds([1], [2], [[9, 9, 9]], photos=["view.png"], photo_xy=[(1, 1)]).save(site / "east.json")
    status, _, err = run_cli(*SITE, "--photo", "view.png", "idle.png", "-o", "{scan}.png")
    assert (status, err) == (0, "warning: idle.png: no seed names this photo\n")


# Photos


def test_photos_are_matched_with_all_scans_at_once(run_cli, painted):
    arguments = ("seeds", "south.ptx", "east.ptx", "--photo", "view.png", *PAPER)
    status, out, err = run_cli(*arguments, "-o", "{scan}.seeds.json", "--matches", "{scan}.matches.png")
    assert (status, err) == (0, "")
    scans = [read_scans(f"{name}.ptx")[0] for name in ("south", "east")]
    expected = match_site(scans, ["view.png"], Settings(matching="paper", slic_segments=40))
    lines = out.splitlines()
    for name, matching in zip(("south", "east"), expected, strict=True):
        seeds = Seeds.load(f"{name}.seeds.json")
        assert (seeds.rows == matching.seeds.rows).all() and (seeds.rgb == matching.seeds.rgb).all()
        assert f"{name}: view.png: matched by appearance, as published" in lines
        assert f"wrote {name}.seeds.json: {len(seeds)} seeds" in lines and f"wrote {name}.matches.png" in lines


def test_colors_from_photos_are_those_of_the_seeds_found_in_them(run_cli, painted, monkeypatch):
    calls = []

    def counted(scans, *arguments, **options):
        calls.append(len(scans))
        return match_site(scans, *arguments, **options)

    monkeypatch.setattr("reflcolor_addon.batch.pipeline.match_site", counted)
    files_and_photo = ("south.ptx", "east.ptx", "--photo", "view.png")
    assert run_cli("seeds", *files_and_photo, *PAPER, "-o", "{scan}.json")[0] == 0
    status, out, err = run_cli("colorize", *files_and_photo, *PAPER, "-o", "{scan}.png", "--report", "r_{scan}.json")
    assert (status, calls) == (0, [2, 2])
    assert [line.split(":")[1] for line in err.splitlines()] == [" south", " east"] and "guesses" in err
    assert out.splitlines()[:2] == [f"{n}: view.png: matched by appearance, as published" for n in ("south", "east")]
    for name in ("south", "east"):
        assert (read_image(f"{name}.png") == expected_colors(name)).all()
        report = read_json(f"r_{name}.json")
        assert [photo["name"] for photo in report["photos"]] == ["view.png"] and "match" in report["times_s"]


def test_a_photo_that_is_not_verified_colors_nothing_unless_guesses_are_wanted(run_cli, painted):
    write_png(painted / "noise.png", np.random.default_rng(0).integers(0, 255, (90, 120, 3), np.uint8))
    arguments = ("colorize", "south.ptx", "--photo", "noise.png", "--slic-segments", "40", "-o", "south.png")
    status, _, err = run_cli(*arguments)
    assert status == 1 and err.count("south: no photo could be verified, so there are no seeds") == 1
    assert "--guess" in err
    assert not (painted / "south.png").exists()
    status, _, err = run_cli(*arguments, "--guess", "--report", "report.json")
    assert status == 0 and "the colors are guesses" in err
    assert read_json("report.json")["result"]["guessed"] is True


def test_hand_picked_seeds_may_be_there_for_some_scans_only(run_cli, painted):
    Seeds([5], [6], [[1, 2, 3]]).save(painted / "east.hand.json")
    arguments = ("seeds", "south.ptx", "east.ptx", "--photo", "view.png", *PAPER, "--hand", "{scan}.hand.json")
    status, _, err = run_cli(*arguments, "-o", "{scan}.json")
    assert (status, err) == (0, "warning: south.hand.json: no such file; that scan gets no pairs picked by hand\n")
    hand = [Seeds.load(f"{name}.json").reason.count("hand") for name in ("south", "east")]
    assert hand == [0, 1]
    (painted / "east.hand.json").unlink()
    assert_refused(run_cli(*arguments, "-o", "{scan}.json"), 1, "expected one of south.hand.json, east.hand.json")


# Scenes, with Blender


def test_a_scene_holds_all_scans_and_one_with_the_placeholder_each(run_cli, site):
    calls = []

    def write_scene(jobs, paths, render, _picture, progress):
        made = [(job.name, job.colorization.rgb, job.report) for job in jobs]
        progress(0.5, "Writing")
        calls.append(([name for name, _, _ in made], list(map(str, paths)), render and str(render)))
        for path in (*paths, *filter(None, [render])):
            path.write_bytes(b"scene")
        for name, rgb, report in made:
            assert (rgb == expected_colors(name)).all()
            assert [entry["path"] for entry in report["outputs"]] == [
                f"{name}.usd",
                "all.blend",
                "all.png",
                f"{name}_r",
            ]

    options = ("-o", "{scan}.usd", "-o", "all.blend", "--render", "all.png", "--report", "{scan}_r")
    status, out, err = run_cli(*SITE, *options, blender=blender_tasks(write_scene=write_scene))
    assert (status, err) == (0, "")
    assert calls == [
        (["south"], ["south.usd"], None),
        (["east"], ["east.usd"], None),
        (["south", "east"], ["all.blend"], "all.png"),
    ]
    names = ("south.usd", "east.usd", "all.blend", "all.png", "south_r", "east_r")
    assert out == "".join(f"wrote {name}\n" for name in names)


def test_a_mesh_holds_all_scans_and_one_with_the_placeholder_each(run_cli, site):
    options = ("-o", "all.ply", "-o", "{scan}.ply", "-o", "all.glb")
    assert run_cli(*SITE, *options)[0] == 0
    whole, south, east = (PlyData.read(site / f"{name}.ply")["vertex"] for name in ("all", "south", "east"))
    np.testing.assert_array_equal(whole["scan"], np.repeat([0, 1], [south.count, east.count]))
    np.testing.assert_array_equal(whole["red"], np.concatenate([south["red"], east["red"]]))
    assert [node["name"] for node in Glb(site / "all.glb").document["nodes"]] == ["south", "east"]


def test_a_scan_is_let_go_when_nothing_needs_it_any_more(run_cli, site):
    met = []

    def write_scene(jobs, paths, _render, _picture, _progress):
        for job in jobs:
            assert all(earlier() is None for earlier in met)
            met.append(weakref.ref(job.scan))
        for path in paths:
            path.write_bytes(b"scene")

    tasks = blender_tasks(write_scene=write_scene)
    assert run_cli(*SITE, "-o", "{scan}.usd", blender=tasks)[0] == 0
    assert len(met) == 2
    met.clear()
    assert run_cli(*SITE, "-o", "all.usd", blender=tasks)[0] == 0
    assert len(met) == 2


def test_an_interruption_leaves_whole_files_and_names_them(run_cli, site):
    def write_scene(_results, paths, _render, _picture, progress):
        if paths[0].name == "east.usd":
            signal.raise_signal(signal.SIGINT)
            progress(0.5, "Writing")
        paths[0].write_bytes(b"scene")

    before = files(site)
    outcome = run_cli(*SITE, "-o", "{scan}.usd", "-o", "{scan}.png", blender=blender_tasks(write_scene=write_scene))
    assert outcome == (130, "", "error: interrupted; already written: south.usd\n")
    assert files(site) == sorted([*before, Path("south.usd")])


def test_images_alone_are_written_when_all_scans_are_colorized(run_cli, site, monkeypatch):
    def failing(scan, *arguments, **options):
        if scan.name == "east":
            raise Cancelled
        return colorize(scan, *arguments, **options)

    monkeypatch.setattr("reflcolor_addon.batch.pipeline.colorize", failing)
    before = files(site)
    assert run_cli(*SITE, "-o", "{scan}.png") == (130, "", "error: interrupted\n")
    assert files(site) == before
