"""The verb `simulate`: a scene of Blender in a file, scanned by the command in a process of its own."""

import json
import subprocess
import sys

import numpy as np
import pytest
from command_line import assert_refused, blender_tasks

from reflcolor_addon import read_scans
from reflcolor_addon.files.images import read_image
from reflcolor_addon.simulation.virtual_scanner import ScannerModel

# A floor, a red wall five meters ahead (along Y) of "Station", two cameras, and an object to stand at, turned to look
# along -X, where a blue wall is three meters away.
MAKE_SCENE = """
import bpy, os, sys
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = bpy.context.scene
def box(center, size, color):
    bpy.ops.mesh.primitive_cube_add(size=1, location=center)
    item = bpy.context.active_object
    item.scale = size
    material = bpy.data.materials.new("paint")
    if material.node_tree is None:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*color, 1)
    item.data.materials.append(material)
box((0, 0, -0.5), (30, 30, 1), (0.3, 0.3, 0.3))
box((0, 5.5, 2), (9, 1, 9), (0.8, 0.1, 0.1))
box((-3.5, 0, 2), (1, 9, 9), (0.1, 0.1, 0.8))
def add(name, data, place, turn):
    item = bpy.data.objects.new(name, data)
    item.location, item.rotation_euler = place, turn
    scene.collection.objects.link(item)
    return item
scene.camera = add("Station", bpy.data.cameras.new("c"), (0, 0, 1.5), (1.5, 0, 0))
add("Aside", bpy.data.cameras.new("c"), (1, 0, 1.5), (1.5, 0, 0.2))
add("Tripod", None, (0, 0, 1.5), (0, 0, 1.5707963))
scene.render.resolution_x, scene.render.resolution_y = 48, 32
scene.world = bpy.data.worlds.new("light")
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[1])
sys.stdout.flush()
os._exit(0)
"""
SMALL = ("--rows", "24", "--columns", "36", "--range-noise", "0", "--beam-deg", "0", "--dropouts", "0")


@pytest.fixture(scope="module")
def yard(tmp_path_factory):
    """The scene in a file."""
    return made(MAKE_SCENE, tmp_path_factory.mktemp("yard"))


@pytest.fixture(scope="module")
def lonely_yard(tmp_path_factory):
    """The same without the camera "Aside"."""
    lines = [line for line in MAKE_SCENE.splitlines() if '"Aside"' not in line]
    return made("\n".join(lines), tmp_path_factory.mktemp("lonely"))


def made(source, folder):
    script, path = folder / "make.py", folder / "yard.blend"
    script.write_text(source)
    subprocess.run([sys.executable, script, path], check=True, capture_output=True, timeout=120)
    return path


def wrote(done):
    assert (done.returncode, done.stderr) == (0, "")
    return [line.removeprefix("wrote ") for line in done.stdout.splitlines() if line.startswith("wrote ")]


def test_the_scan_the_truth_and_the_photos_are_written_and_named(blender_command, yard, tmp_path):
    done = blender_command(
        "simulate", yard, "-o", tmp_path / "yard.e57", *SMALL, "--truth", "--photos", "--photo-samples", "2"
    )
    names = ["yard.e57", "yard.truth.png", "yard.cameras.json", "yard.Aside.png"]
    assert wrote(done) == [str(tmp_path / name) for name in names]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    (scan,) = read_scans(tmp_path / "yard.e57")
    assert scan.shape == (24, 36)
    assert scan.pose[:3, 3] == pytest.approx((0, 0, 1.5), abs=1e-6)
    ahead = scan.points[8, 18] @ scan.pose[:3, :3].T + scan.pose[:3, 3]
    assert ahead[1] == pytest.approx(5.0, abs=1e-3)
    red, _green, blue = read_image(tmp_path / "yard.truth.png")[8, 18].astype(int)
    assert red > blue + 100
    assert read_image(tmp_path / "yard.Aside.png").shape == (32, 48, 3)
    assert list(json.loads((tmp_path / "yard.cameras.json").read_text())) == ["yard.Aside.png"]


def test_the_scanner_stands_at_an_object_and_turns_all_around(blender_command, yard, tmp_path):
    done = blender_command(
        "simulate", yard, "-o", tmp_path / "yard.scan.json", *SMALL, "--object", "Tripod", "--full-turn"
    )
    assert wrote(done) == [str(tmp_path / f"yard.{name}") for name in ("scan.json", "range.png", "reflectance.png")]
    (scan,) = read_scans(tmp_path / "yard.scan.json")
    assert scan.full_turn
    ahead = scan.points[8, 18] @ scan.pose[:3, :3].T + scan.pose[:3, 3]
    assert ahead[0] == pytest.approx(-3.0, abs=0.01)


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (("--camera", "Nobody"), "there is no camera Nobody in the scene Scene; found Aside, Station"),
        (("--camera", "Tripod"), "there is no camera Tripod"),
        (("--object", "Nobody"), "there is no object Nobody in the scene Scene; found Aside, Cube"),
    ],
    ids=" ".join,
)
def test_a_station_that_is_not_in_the_scene_is_said_in_one_line(blender_command, yard, tmp_path, options, part):
    done = blender_command("simulate", yard, "-o", tmp_path / "yard.ptx", *options)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert part in done.stderr
    assert not list(tmp_path.iterdir())


def test_photos_without_another_camera_are_refused_before_the_work(blender_command, lonely_yard, tmp_path):
    done = blender_command("simulate", lonely_yard, "-o", tmp_path / "yard.ptx", *SMALL, "--photos")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "--photos: the scene Scene of" in done.stderr and "has no other camera to take photos from" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_no_scene_is_said_in_one_line(blender_command, tmp_path):
    (tmp_path / "yard.blend").write_text("a scene, they said")
    done = blender_command("simulate", tmp_path / "yard.blend", "-o", tmp_path / "yard.ptx")
    assert done.returncode == 1
    assert done.stderr.startswith(f"error: {tmp_path / 'yard.blend'}: Blender could not open it")
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "yard.ptx").exists()


# What is seen before Blender is asked

SIMULATE = ("simulate", "yard.blend", "-o", "yard.ptx")


@pytest.fixture
def asked(run_cli, cli_folder):
    """A function that runs `simulate` in this process; returns the outcome and the requests that Blender got."""
    (cli_folder / "yard.blend").write_bytes(b"a scene")

    def run(*arguments):
        requests = []
        tasks = blender_tasks(simulate=lambda request, _progress, _written: requests.append(request))
        return run_cli(*arguments, blender=tasks), requests

    return run


def test_without_blender_it_is_wrong_usage(run_cli, cli_folder):
    before = sorted(cli_folder.iterdir())
    assert_refused(run_cli(*SIMULATE), 2, "simulate needs Blender", "blender -b --command reflcolor")
    assert sorted(cli_folder.iterdir()) == before


def test_the_defaults_are_the_scanners_own(asked):
    (status, _, _), (request,) = asked(*SIMULATE)
    assert status == 0
    assert request.model == ScannerModel()
    assert (request.camera, request.item, request.truth, request.photos, request.own_look) == (
        None,
        None,
        False,
        False,
        True,
    )


def test_every_option_reaches_the_scanner(asked):
    options = "--camera Left --rows 8 --columns 9 --width-deg 100 --elevation-deg -10 20 --greatest-range 30"
    options += " --range-noise 0.002 --reflectance-noise 0.1 --beam-deg 0.3 --dropouts 0.05 --seed 4"
    options += " --photos --photo-samples 5 --plain-photos --truth"
    (status, _, _), (request,) = asked(*SIMULATE, *options.split())
    assert status == 0
    assert request.model == ScannerModel(
        rows=8,
        columns=9,
        azimuth_deg=(-50, 50),
        elevation_deg=(-10, 20),
        range_limits_m=(0.3, 30),
        range_noise_m=0.002,
        reflectance_noise=0.1,
        beam_deg=0.3,
        dropout_rate=0.05,
        seed=4,
    )
    assert (request.camera, request.truth, request.photos, request.photo_samples) == ("Left", True, True, 5)
    assert not request.own_look


@pytest.mark.parametrize(
    ("options", "status", "part"),
    [
        (("--camera", "a", "--object", "b"), 2, "--object"),
        (("--full-turn", "--width-deg", "90"), 2, "--width-deg"),
        (("--elevation-deg", "10"), 2, "--elevation-deg"),
        (("--plain-photos",), 2, "--plain-photos applies to photos; give --photos, too"),
        (("--photo-samples", "3"), 2, "--photo-samples applies to photos"),
        (("-o", "yard.obj"), 2, "yard.obj: the suffix tells what to write; expected one of .ptx, .e57, .scan.json"),
        (("--rows", "0"), 2, "--rows and --columns: expected 1 or more"),
        (("--rows", "9" * 9), 2, "--rows x --columns: expected at most"),
        (("--width-deg", "361"), 2, "--width-deg: expected more than 0 and at most 360 degrees, found 361"),
        (("--width-deg", "nan"), 2, "--width-deg: expected"),
        (("--elevation-deg", "10", "-10"), 2, "--elevation-deg: expected bottom below top"),
        (("--dropouts", "2"), 2, "--dropouts: expected 0 to 1"),
        (("--beam-deg", "-1"), 2, "--beam-deg: expected 0 or more"),
        (("--photos", "--photo-samples", "0"), 2, "--photo-samples: expected 1 or more, found 0"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_what_cannot_be_simulated_is_said_in_one_line(asked, options, status, part):
    outcome, requests = asked(*SIMULATE, *options)
    assert_refused(outcome, status, part)
    assert not requests


def test_a_scene_that_is_not_there_is_said_in_one_line(asked):
    outcome, _ = asked("simulate", "gone.blend", "-o", "yard.ptx")
    assert_refused(outcome, 1, "gone.blend: no such file; expected a scene saved by Blender")


def test_a_scene_named_as_its_scan_is_not_overwritten(asked, cli_folder):
    (cli_folder / "yard.ptx").write_bytes(b"a scene by a wrong name")
    outcome, _ = asked("simulate", "yard.ptx", "-o", "yard.ptx")
    assert_refused(outcome, 2, "is an input, and would be overwritten")


def test_files_that_were_written_before_a_failure_are_named(run_cli, cli_folder):
    (cli_folder / "yard.blend").write_bytes(b"a scene")

    def simulate(request, _progress, written):
        written.append(request.output)
        raise MemoryError

    outcome = run_cli(*SIMULATE, blender=blender_tasks(simulate=simulate))
    assert_refused(outcome, 1, "yard.blend: not enough memory", "already written: yard.ptx")


def test_numbers_of_the_scan_follow_from_the_seed(blender_command, yard, tmp_path):
    noisy = ("--rows", "16", "--columns", "24")
    contents = []
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        (tmp_path / name).mkdir()
        wrote(blender_command("simulate", yard, "-o", tmp_path / name / "yard.ptx", *noisy, "--seed", seed))
        contents.append((tmp_path / name / "yard.ptx").read_bytes())
    assert contents[0] == contents[1] != contents[2]
    assert np.isfinite(read_scans(tmp_path / "a" / "yard.ptx")[0].points).all()
