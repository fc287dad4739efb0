"""The command line: what it says and what it writes."""

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from command_line import COLORIZE, SHAPE, assert_refused, blender_tasks, run_process, save_seeds
from gltf_files import Glb, encoded
from plyfile import PlyData
from small_scans import random_scan

from reflcolor_addon import OutputError, Scan, Seeds, Settings, colorize, read_scans
from reflcolor_addon.files.images import read_image, write_png
from reflcolor_addon.files.writers import write_image_pair, write_ptx
from reflcolor_addon.version import __version__
from reflcolor_addon.view.picture import Picture


def test_colorize_writes_the_colorized_reflectance_image(run_cli, cli_folder):
    status, out, err = run_cli(*COLORIZE, "-o", "out.png")
    assert (status, out, err) == (0, "wrote out.png\n", "")
    (scan,) = read_scans(cli_folder / "garage.ptx")
    expected = colorize(scan, Seeds.load(cli_folder / "seeds.json"), Settings.preset("Natural"))
    assert (read_image(cli_folder / "out.png") == expected.rgb).all()


@pytest.mark.parametrize(("given", "nearest"), [("auto", "auto"), ("all", None), ("2", 2)])
def test_colorize_passes_every_setting_on(run_cli, cli_folder, given, nearest):
    options = ("--alpha", "2.5", "--beta", "0", "--color-space", "cielab", "--neighbors", "4", "--nearest", given)
    assert run_cli(*COLORIZE, *options, "-o", "out.png", "--report", "report.json")[0] == 0
    settings = Settings.preset("Natural", alpha=2.5, beta=0.0, color_space="cielab", neighbors=4, nearest=nearest)
    (scan,) = read_scans(cli_folder / "garage.ptx")
    expected = colorize(scan, Seeds.load(cli_folder / "seeds.json"), settings)
    assert (read_image(cli_folder / "out.png") == expected.rgb).all()
    assert json.loads((cli_folder / "report.json").read_text(encoding="utf-8"))["settings"] == settings.as_dict()


@pytest.mark.parametrize("preset", ["enhanced", "ENHANCED"])
def test_a_preset_is_known_in_any_case(run_cli, cli_folder, preset):
    assert run_cli(*COLORIZE, "--preset", preset, "-o", "out.png", "--report", "report.json")[0] == 0
    used = json.loads((cli_folder / "report.json").read_text(encoding="utf-8"))["settings"]
    assert used == Settings.preset("Enhanced").as_dict()


def test_colorize_writes_the_same_bytes_each_time_and_only_the_times_of_the_report_vary(run_cli, cli_folder):
    contents = []
    for _ in range(2):
        assert run_cli(*COLORIZE, "-o", "a.png", "-o", "b.png", "--report", "report.json")[0] == 0
        report = json.loads((cli_folder / "report.json").read_text(encoding="utf-8"))
        assert set(report.pop("times_s")) == {"seeds", "read", "colorize", "write"}
        assert report.pop("created").endswith("Z")
        contents.append(((cli_folder / "a.png").read_bytes(), (cli_folder / "b.png").read_bytes(), json.dumps(report)))
    assert contents[0] == contents[1]
    assert contents[0][0] == contents[0][1]


def test_seeds_that_are_all_guesses_are_told(run_cli, cli_folder):
    guess = {"row": 1, "col": 2, "rgb": [90, 80, 70], "reason": "appearance", "confidence": 0.2}
    save_seeds(cli_folder, guess)
    status, _, err = run_cli(*COLORIZE, "-o", "out.png")
    assert (status, err.count("the colors are guesses")) == (0, 1)
    save_seeds(cli_folder, guess, {"row": 3, "col": 2, "rgb": [9, 8, 7]})
    assert "guess" not in run_cli(*COLORIZE, "-o", "out.png")[2]


def test_the_report_names_every_input_and_output(run_cli, cli_folder):
    (cli_folder / "photos").mkdir()
    for name in ("photos/view.png", "beside.png", "idle.png"):
        write_png(cli_folder / name, np.full((4, 4, 3), 90, np.uint8))
    save_seeds(
        cli_folder,
        {"row": 1, "col": 2, "photo": "view.png", "x": 1, "y": 1},
        {"row": 3, "col": 2, "photo": "beside.png", "x": 1, "y": 1},
    )
    status, _, err = run_cli(*COLORIZE, "--photo", "photos/view.png", "idle.png", "-o", "out.png", "--report", "r.json")
    assert status == 0
    assert err == "warning: idle.png: no seed names this photo\n"
    report = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))
    assert [(entry["role"], entry["path"]) for entry in report["inputs"]] == [
        ("scan", "garage.ptx"),
        ("seeds", "seeds.json"),
        ("photo", str(Path("photos/view.png"))),
        ("photo", "idle.png"),
        ("photo", "beside.png"),
    ]
    written = (cli_folder / "out.png").read_bytes()
    fingerprint = {"bytes": len(written), "sha256": hashlib.sha256(written).hexdigest()}
    assert report["outputs"] == [
        {"option": "-o", "path": "out.png", "from_report": "out.png"} | fingerprint,
        {"option": "--report", "path": "r.json"},
    ]


def test_the_images_that_a_scan_json_describes_are_inputs_too(run_cli, cli_folder):
    write_image_pair(random_scan(shape=SHAPE), cli_folder / "pair.scan.json")
    before = (cli_folder / "pair.reflectance.png").read_bytes()
    arguments = ("colorize", "pair.scan.json", "--seeds", "seeds.json")
    assert run_cli(*arguments, "-o", "out.png", "--report", "r.json")[0] == 0
    inputs = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))["inputs"]
    assert [entry["path"] for entry in inputs if entry["role"] == "scan"] == [
        "pair.scan.json",
        "pair.range.png",
        "pair.reflectance.png",
    ]
    assert_refused(run_cli(*arguments, "-o", "pair.reflectance.png"), 2, "is an input")
    assert (cli_folder / "pair.reflectance.png").read_bytes() == before


def test_a_seed_without_return_is_moved_which_is_warned_of_and_reported(run_cli, cli_folder):
    valid = np.ones(SHAPE, bool)
    valid[1, 2] = False
    write_ptx(random_scan(shape=SHAPE, valid=valid), cli_folder / "garage.ptx")
    status, _, err = run_cli(*COLORIZE, "-o", "out.png", "--report", "r.json")
    assert status == 0
    assert err == "warning: seed 1: no return at row 1, column 2; moved to row 0, column 2\n"
    report = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))
    assert report["seeds"][0]["moved_from"] == {"row": 1, "col": 2}
    assert len(report["warnings"]) == 1


def test_info_says_what_is_in_every_scan(run_cli, cli_folder):
    valid = np.ones(SHAPE, bool)
    valid[0, :6] = False
    scans = [random_scan(1, shape=SHAPE), random_scan(2, (8, 24), azimuth_deg=360.0)]
    write_ptx([scans[0], scans[1]], cli_folder / "garage.ptx")
    status, out, err = run_cli("info", "garage.ptx")
    assert (status, err) == (0, "")
    head, *lines = out.splitlines()
    assert head == "1  garage 1"
    assert "   grid         6 rows x 10 columns" in lines
    assert "   returns      60 (100.0% of the pixels)" in lines
    assert "   full turn    no" in lines
    assert "2  garage 2" in lines
    assert "   full turn    yes" in lines
    assert "   color        no" in lines


def test_info_gives_the_same_as_json(run_cli, cli_folder):
    valid = np.ones(SHAPE, bool)
    valid[2:4, 1:] = False
    scan = random_scan(1, SHAPE, valid=valid)
    pose = np.eye(4)
    pose[:3, 3] = 431250.5, 5411900.25, 310.0
    object.__setattr__(scan, "pose", pose)
    write_ptx(scan, cli_folder / "garage.ptx")
    status, out, _ = run_cli("info", "garage.ptx", "--json")
    assert status == 0
    document = json.loads(out)
    assert (document["format"], document["version"], document["file"]) == ("reflcolor-info", 1, "garage.ptx")
    (found,) = document["scans"]
    assert (found["index"], found["name"], found["rows"], found["columns"]) == (1, "garage", 6, 10)
    assert (found["returns"], found["returns_share"]) == (42, 0.7)
    assert found["range_m"] == pytest.approx([scan.range[valid].min(), scan.range[valid].max()], abs=1e-5)
    assert found["reflectance"] == pytest.approx(
        [scan.reflectance[valid].min(), scan.reflectance[valid].max()], abs=1e-6
    )
    assert found["step_deg"] == pytest.approx({"vertical": 40 / 6, "horizontal": 6.0}, abs=1e-3)
    assert (found["full_turn"], found["color"], found["warnings"]) == (False, False, [])
    assert found["position_m"] == [431250.5, 5411900.25, 310.0]
    assert np.array(found["pose"])[:3, 3].tolist() == found["position_m"]


def test_what_the_reader_noticed_is_warned_of(run_cli, cli_folder):
    text = (cli_folder / "garage.ptx").read_text(encoding="ascii").splitlines()
    text[6:10] = ["nan 0 0 0"] * 4
    (cli_folder / "garage.ptx").write_text("\n".join(text) + "\n", encoding="ascii")
    (scan,) = read_scans(cli_folder / "garage.ptx")
    assert scan.warnings
    _, _, err = run_cli("info", "garage.ptx")
    assert err.splitlines() == [f"warning: {warning}" for warning in scan.warnings]
    _, out, _ = run_cli("info", "garage.ptx", "--json")
    assert json.loads(out)["scans"][0]["warnings"] == list(scan.warnings)


@pytest.mark.parametrize(("wanted", "index"), [("1", 1), ("2", 2), ("garage 2", 2)])
def test_a_scan_is_chosen_by_its_index_or_its_name(run_cli, cli_folder, wanted, index):
    write_ptx([random_scan(seed, SHAPE) for seed in (1, 2)], cli_folder / "garage.ptx")
    assert run_cli(*COLORIZE, "--scan", wanted, "-o", "out.png", "--report", "r.json")[0] == 0
    assert json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))["scan"]["index"] == index
    scan = read_scans(cli_folder / "garage.ptx")[index - 1]
    expected = colorize(scan, Seeds.load(cli_folder / "seeds.json"), Settings.preset("Natural"))
    assert (read_image(cli_folder / "out.png") == expected.rgb).all()


@pytest.mark.parametrize("arguments", [(), ("--scan", "3"), ("--scan", "0"), ("--scan", "shed")])
def test_several_scans_and_none_chosen_is_wrong_usage_that_lists_them(run_cli, cli_folder, arguments):
    write_ptx([random_scan(seed, SHAPE) for seed in (1, 2)], cli_folder / "garage.ptx")
    outcome = run_cli(*COLORIZE, *arguments, "-o", "out.png")
    assert_refused(outcome, 2, "garage.ptx", "--scan NAME or --scan INDEX: 1 (garage 1), 2 (garage 2)")
    assert not (cli_folder / "out.png").exists()


def test_version_and_help_end_well(run_cli):
    assert run_cli("--version") == (0, f"reflcolor {__version__}\n", "")
    for arguments in (("--help",), ("info", "-h"), ("colorize", "-h"), ("evaluate", "-h"), ("simulate", "-h")):
        status, out, err = run_cli(*arguments, prog="reflcolor")
        assert (status, err) == (0, "")
        assert out.startswith("usage: reflcolor")


def test_the_module_runs_as_a_program(cli_folder):
    done = run_process(*COLORIZE, "-o", "out.png")
    assert (done.returncode, done.stdout, done.stderr) == (0, "wrote out.png\n", "")


def test_real_scans_are_described(run_cli, data_dir):
    for path, rows, columns in (
        (data_dir / "doria_ptx/1.ptx", 91, 199),
        (data_dir / "pumpA/pumpAVisualReferenceImage.e57", 1074, 345),
    ):
        status, out, _ = run_cli("info", path, "--json")
        assert status == 0
        (scan,) = json.loads(out)["scans"]
        assert (scan["rows"], scan["columns"], scan["color"]) == (rows, columns, True)


def test_a_scan_is_read_as_the_options_say_and_the_report_tells(run_cli, cli_folder):
    (plain,) = read_scans(cli_folder / "garage.ptx")
    options = ("--turn", "180", "--flip", "vertical", "--unit", "ft")
    (scan,) = json.loads(run_cli("info", "garage.ptx", "--json", *options, "--step", "2")[1])["scans"]
    assert (scan["rows"], scan["columns"]) == (-(-SHAPE[0] // 2), -(-SHAPE[1] // 2))
    # The file counts its rows from the bottom.
    assert scan["range_m"][1] == pytest.approx(0.3048 * plain.range[::-2, ::2].max())
    assert run_cli(*COLORIZE, *options, "-o", "out.png", "--report", "r.json")[0] == 0
    entry = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))["scan"]
    assert entry["flipped"] == ["vertical"] and entry["reading"] == {"turn_deg": 180, "unit": "ft"}


def test_a_scan_without_reflectance_can_be_looked_at_but_is_not_colorized(run_cli, cli_folder):
    scan = random_scan(1, SHAPE)
    write_ptx(replace(scan, reflectance=np.full(SHAPE, 0.5, np.float32)), cli_folder / "garage.ptx")
    status, _, err = run_cli("info", "garage.ptx")
    assert status == 0 and "not colorized" in err
    outcome = run_cli(*COLORIZE, "-o", "out.png")
    assert_refused(outcome, 1, "garage: its reflectance is the same everywhere", "export it with intensity")


# With Blender


def test_what_blender_writes_is_handed_to_it_with_the_report(run_cli, cli_folder):
    calls = []

    def write_scene(jobs, paths, render, _picture, progress):
        # A job is let go when the next one is asked for.
        job = next(iter(jobs))
        progress(0.5, "Writing")
        calls.append((job.scan.name, job.colorization.rgb.shape, paths, render, job.report))
        for path in (*paths, render):
            path.write_bytes(b"scene")

    status, out, err = run_cli(
        *COLORIZE, "-o", "a.blend", "-o", "a.png", "-o", "a.USD", "--render", "view.png", "--report", "r.json",
        blender=blender_tasks(write_scene=write_scene),
    )  # fmt: skip
    assert (status, err) == (0, "")
    assert out.split() == [
        "wrote",
        "a.blend",
        "wrote",
        "a.png",
        "wrote",
        "a.USD",
        "wrote",
        "view.png",
        "wrote",
        "r.json",
    ]
    ((name, shape, paths, render, provenance),) = calls
    assert (name, shape) == ("garage", (*SHAPE, 3))
    assert (paths, render) == ([Path("a.blend"), Path("a.USD")], Path("view.png"))
    report = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))
    assert report.pop("times_s")["write"] >= 0
    # What is kept in the .blend cannot hold its hash.
    assert [entry.keys() >= {"sha256"} for entry in report["outputs"]] == [True, True, True, True, False]
    assert {**report, "outputs": None} == {**json.loads(json.dumps(provenance)), "outputs": None}
    assert provenance["versions"]["blender"] == "5.2.2 LTS"


def test_meshes_are_written_without_blender_and_hold_the_result(run_cli, cli_folder):
    assert run_cli(*COLORIZE, "-o", "a.png", "-o", "a.ply", "-o", "a.glb", "--report", "r.json")[0] == 0
    rgb = cv2.imread(str(cli_folder / "a.png"))[..., ::-1].reshape(-1, 3)
    table = PlyData.read(cli_folder / "a.ply")["vertex"]
    place = table["grid_row"] * SHAPE[1] + table["grid_col"]
    colors = np.stack([table[channel] for channel in ("red", "green", "blue")], axis=1)
    np.testing.assert_array_equal(colors, rgb[place])
    glb = Glb(cli_folder / "a.glb")
    np.testing.assert_array_equal(encoded(glb.attribute("COLOR_0")[:, :3]), rgb[place])
    for name in ("confidence", "nearest_seed", "reflectance"):
        np.testing.assert_array_equal(glb.attribute(f"_{name.upper()}")[:, 0], table[name])
    report = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))
    assert [entry["path"] for entry in report["outputs"] if "sha256" in entry] == ["a.png", "a.ply", "a.glb"]


def test_a_glb_that_would_be_too_large_is_refused_before_the_work(run_cli, cli_folder, monkeypatch):
    monkeypatch.setattr("reflcolor_addon.files.writers.glb._LARGEST", 10_000)
    monkeypatch.setattr("reflcolor_addon.batch.pipeline.colorize_job", None)
    before = sorted(cli_folder.iterdir())
    assert_refused(run_cli(*COLORIZE, "-o", "a.glb"), 1, "a.glb: would have", "4 GiB", "--faces")
    assert sorted(cli_folder.iterdir()) == before


@pytest.mark.parametrize(
    "arguments",
    [("-o", "out.blend"), ("-o", "out.png", "-o", "out.usd"), ("-o", "a.png", "--render", "b.png")],
)
def test_without_blender_what_needs_it_is_wrong_usage(run_cli, cli_folder, arguments):
    before = sorted(cli_folder.iterdir())
    assert_refused(run_cli(*COLORIZE, *arguments), 2, "needs Blender", "blender -b --command reflcolor")
    assert sorted(cli_folder.iterdir()) == before


def test_when_a_later_output_fails_the_ones_that_are_there_are_named(run_cli, cli_folder):
    def write_scene(_results, paths, _render, _picture, _progress):
        paths[0].write_bytes(b"scene")
        raise OutputError("b.usd: cannot be written (No space left on device)")

    outcome = run_cli(
        *COLORIZE, "-o", "a.blend", "-o", "b.usd", "-o", "c.png", blender=blender_tasks(write_scene=write_scene)
    )
    assert_refused(outcome, 1, "b.usd: cannot be written", "; already written: a.blend\n")
    assert not (cli_folder / "c.png").exists()


def test_what_is_noticed_of_very_many_scans_is_said_of_some(run_cli, cli_folder):
    # Of one pixel each, which do not show where up is.
    one = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n"
    (cli_folder / "many.ptx").write_text(one * 30)
    status, _, err = run_cli("info", "many.ptx")
    lines = err.splitlines()
    assert status == 0
    assert sum("do not show which way is up" in line for line in lines) == 20
    assert sum("its intensity is 0.5 everywhere" in line for line in lines) == 20
    assert lines[40:] == ["warning: 20 more of the same kinds"]


def test_what_was_noticed_before_an_error_is_said_before_it(run_cli, cli_folder):
    def write_scene(*_):
        raise OutputError("b.usd: cannot be written (No space left on device)")

    write_png(cli_folder / "idle.png", np.zeros((20, 20, 3), np.uint8))
    status, out, err = run_cli(
        *COLORIZE, "--photo", "idle.png", "-o", "b.usd", blender=blender_tasks(write_scene=write_scene)
    )
    assert (status, out) == (1, "")
    assert err == (
        "warning: idle.png: no seed names this photo\nerror: b.usd: cannot be written (No space left on device)\n"
    )


# Seeds from the scan's own colors


def test_seeds_come_from_the_colors_of_the_scan(run_cli, cli_folder):
    scan, rgb = random_scan(1, (6, 10)), np.random.default_rng(0).integers(1, 256, (6, 10, 3), np.uint8)
    colored = Scan(name="hall", points=scan.points, reflectance=scan.reflectance, valid=scan.valid, color=rgb)
    write_ptx(colored, cli_folder / "hall.ptx")
    status, out, err = run_cli("seeds", "hall.ptx", "--from-color", "12", "-o", "hall.json")
    assert (status, out, err) == (0, "wrote hall.json: 12 seeds\n", "")
    assert Seeds.load(cli_folder / "hall.json").reason == ("scan",) * 12
    assert_refused(run_cli("seeds", "garage.ptx", "--from-color", "5", "-o", "x.json"), 1, "came without colors")
    both = ("seeds", "hall.ptx", "--from-color", "5", "--photo", "a.png", "-o", "x.json")
    assert_refused(run_cli(*both), 2, "--photo: does not apply to seeds from the scan's own colors")


def test_a_picture_is_as_the_options_say(run_cli, cli_folder):
    pictures = []

    def write_scene(_jobs, _paths, render, picture, _progress):
        pictures.append(picture)
        render.touch()

    for options in ((), ("--look", "lit", "--as-measured", "--keep-mixed")):
        outcome = run_cli(
            *COLORIZE, "-o", "a.png", "--render", "r.png", *options, blender=blender_tasks(write_scene=write_scene)
        )
        assert outcome[0] == 0, outcome
    assert pictures == [Picture(), Picture(look="lit", filled=False, drop_mixed=False)]
