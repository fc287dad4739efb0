"""Several scans that are selected together, matched and colorized in Blender through the installed zip."""

import importlib
from dataclasses import replace
from itertools import count
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import pixels, write_small_ptx

from reflcolor_addon import Seeds, Settings, colorize, read_scans

POSES = {"wall": np.eye(4), "floor": np.array([[0, -1, 0, 5.0], [1, 0, 0, -2.0], [0, 0, 1, 0.5], [0, 0, 0, 1]])}
COLORS = {"wall": (200, 80, 40), "floor": (20, 90, 220)}


@pytest.fixture
def files(tmp_path):
    """A scan of 6 x 10 pixels and another, from another place, and a photo."""
    cv2.imwrite(str(tmp_path / "view.png"), np.random.default_rng(0).integers(0, 256, (30, 40, 3), np.uint8))
    for number, (name, pose) in enumerate(POSES.items()):
        write_small_ptx(tmp_path / f"{name}.ptx", random_scan(number), pose)
    return tmp_path


@pytest.fixture
def site(blender, files):
    """bpy with the two scans and the photo; both scans are selected, the wall is active."""
    load(blender, files)
    return blender


@pytest.fixture
def seeded(site):
    """bpy with two seeds on each of them."""
    for name in ("floor", "wall"):
        activate(site, name)
        for row in (1, 4):
            site.ops.reflcolor.add_seed(row=row, col=3, color=[value / 255 for value in COLORS[name]])
    return site


def load(bpy, folder):
    for name in POSES:
        bpy.ops.reflcolor.import_scan(filepath=str(folder / f"{name}.ptx"))
    bpy.ops.reflcolor.load_photo(filepath=str(folder / "view.png"))
    select(bpy, "wall", "floor")


def select(bpy, active, *others):
    for obj in bpy.data.objects:
        obj.select_set(obj.name in {active, *others})
    activate(bpy, active)


def activate(bpy, name):
    bpy.context.view_layer.objects.active = bpy.data.objects[name]


def state(bpy, name):
    return bpy.data.objects[name].reflcolor


def said(bpy, name):
    return [(notice.warning, notice.text) for notice in state(bpy, name).notices]


def everything(bpy):
    """What matching and colorizing write."""
    return [
        (
            obj.name,
            sorted(obj.data.color_attributes.keys()),
            sorted(obj.keys()),
            [(seed.row, seed.col, tuple(seed.color), seed.reason) for seed in obj.reflcolor.seeds],
            said(bpy, obj.name),
            obj.reflcolor.matches_image,
            verdicts(obj),
        )
        for obj in bpy.data.objects
    ]


def verdicts(obj):
    """What was found of photos on a scan."""
    return [(verdict.image.name, verdict.verified, verdict.note) for verdict in obj.reflcolor.verdicts]


@pytest.fixture
def cancelled(installed_blender, monkeypatch):
    """A function that has the next operators cancelled when they ask for the given time whether they are."""
    jobs = importlib.import_module(f"{EXTENSION}.operators.window.jobs")

    def after(times):
        def run_blocking(operator, context):
            asked = count()
            with pytest.raises(jobs.Cancelled):
                operator.prepare(context)(lambda fraction, text: None, lambda: next(asked) >= times)
            return {"CANCELLED"}

        monkeypatch.setattr(jobs.JobOperator, "run_blocking", run_blocking)

    return after


@pytest.fixture
def matched(installed_blender, monkeypatch):
    """A dictionary of what the search for seeds is given; it finds one seed on each scan, more on the first."""
    pipeline = importlib.import_module(f"{EXTENSION}.reflcolor_addon.batch.pipeline")
    match = importlib.import_module(f"{EXTENSION}.reflcolor_addon.matching.match")
    given = {}

    def match_site(scans, photos, settings, *, hand, kept, progress, cancelled, registered=None):
        given.update(scans=scans, hand=hand, kept=kept)
        name = photos[0].name
        found = []
        for number, scan in enumerate(scans):
            rows, last = np.arange(2 - number), number == len(scans) - 1
            seeds = match.Seeds(
                rows,
                rows + 5,
                np.full((len(rows), 3), 100 + number),
                confidence=rows * 0.0,
                reason=["pose"] * len(rows),
            )
            report = match.PhotoMatch(name, last, None, "pose" if last else None, "verified" if last else "not")
            warnings = () if last else (f"{scan.name}: {name} could not be verified", f"{name}: 3 pairs are too few")
            picked = replace(hand[number], reason=["hand"] * len(hand[number]))
            seeds = match.joined(picked, kept[number], seeds)
            found.append(match.Matching(seeds, (report,), warnings))
        return found

    monkeypatch.setattr(pipeline, "match_site", match_site)
    return given


def test_each_selected_scan_is_colorized_from_its_own_seeds(seeded, files):
    seeded.ops.reflcolor.colorize(alpha=3.0)
    for name, color in COLORS.items():
        seeds = Seeds([1, 4], [3, 3], [color, color])
        expected = colorize(read_scans(files / f"{name}.ptx")[0], seeds, Settings.preset("Natural", alpha=3.0)).rgb
        image = np.rint(pixels(state(seeded, name).colorized_image)[..., :3] * 255).astype(int)
        assert np.abs(image - expected).max() <= 1
        assert said(seeded, name) == [(False, f"Colorized {name} from 2 seeds")]
        assert seeded.data.objects[name].data.color_attributes.active_color_name == "Colorized"
        assert f'"name": "{name}"' in seeded.data.objects[name]["reflcolor_provenance"]


def test_what_is_not_selected_stays_as_it_is_and_the_active_scan_need_not_be(seeded):
    select(seeded, "wall")
    seeded.data.objects["wall"].select_set(False)
    seeded.ops.reflcolor.colorize()
    assert "Colorized" in seeded.data.objects["wall"].data.color_attributes
    assert "Colorized" not in seeded.data.objects["floor"].data.color_attributes


def test_a_single_scan_is_told_as_ever(seeded, capfd):
    select(seeded, "wall")
    capfd.readouterr()
    seeded.ops.reflcolor.colorize()
    assert capfd.readouterr().out.splitlines() == ["Info: Colorized wall from 2 seeds"]


def test_several_scans_are_told_one_by_one_and_together(seeded, capfd):
    capfd.readouterr()
    seeded.ops.reflcolor.colorize()
    assert capfd.readouterr().out.splitlines() == [
        "Info: Colorized wall from 2 seeds",
        "Info: Colorized floor from 2 seeds",
        "Info: Colorized 2 scans: wall, floor",
    ]


def test_the_panel_says_how_many_scans_are_selected(site):
    step = importlib.import_module(f"{EXTENSION}.panels.step")
    shown = []
    layout = SimpleNamespace(label=lambda **given: shown.append(given["text"]))
    step.draw_selected(site.context, layout)
    select(site, "wall")
    step.draw_selected(site.context, layout)
    activate(site, "floor")
    step.draw_selected(site.context, layout)
    assert shown == ["2 scans selected", "2 scans selected"]


@pytest.mark.parametrize(("active", "bare"), [("wall", "floor"), ("floor", "wall"), ("wall", "wall")])
def test_a_selected_scan_without_seeds_is_left_out_and_named(seeded, capfd, active, bare):
    select(seeded, active, "wall", "floor")
    state(seeded, bare).seeds.clear()
    before = said(seeded, bare)
    capfd.readouterr()
    seeded.ops.reflcolor.colorize()
    (other,) = set(POSES) - {bare}
    line = f"{bare} was left out: Add a seed first"
    assert capfd.readouterr().out.splitlines() == [f"Info: Colorized {other} from 2 seeds", f"Warning: {line}"]
    assert said(seeded, other) == [(False, f"Colorized {other} from 2 seeds"), (True, line)]
    assert said(seeded, bare) == before
    assert "Colorized" not in seeded.data.objects[bare].data.color_attributes


def test_without_any_colored_seed_it_says_what_the_active_scan_lacks(seeded):
    state(seeded, "floor").seeds.clear()
    for seed in state(seeded, "wall").seeds:
        seed.has_color = False
    with pytest.raises(RuntimeError, match="Give a seed its color first"):
        seeded.ops.reflcolor.colorize()


def test_the_active_object_must_be_a_scan(seeded):
    empty = seeded.data.objects.new("empty", None)
    seeded.context.collection.objects.link(empty)
    activate(seeded, "empty")
    for act in ("colorize", "match_photos"):
        with pytest.raises(RuntimeError, match="Import a scan, or select one, first"):
            getattr(seeded.ops.reflcolor, act)()


def test_a_preview_that_is_finished_is_taken_for_its_scan_only(seeded, files, monkeypatch):
    live_update = importlib.import_module(f"{EXTENSION}.operators.window.live_update")
    previewed = colorize(read_scans(files / "wall.ptx")[0], Seeds([1], [3], [[9, 200, 9]]))
    monkeypatch.setattr(live_update, "finished", lambda obj, settings: previewed if obj.name == "wall" else None)
    seeded.ops.reflcolor.colorize()
    image = np.rint(pixels(state(seeded, "wall").colorized_image)[..., :3] * 255).astype(int)
    assert np.abs(image - previewed.rgb).max() <= 1
    assert said(seeded, "floor") == [(False, "Colorized floor from 2 seeds")]


@pytest.mark.parametrize("times", [0, 1, 2])
def test_cancelling_the_colorization_leaves_all_scans_as_they_were(seeded, cancelled, times):
    before = everything(seeded)
    cancelled(times)
    assert seeded.ops.reflcolor.colorize() == {"CANCELLED"}
    assert everything(seeded) == before


def test_a_mesh_that_cannot_take_its_colors_leaves_all_scans_as_they_were(seeded, monkeypatch):
    jobs = importlib.import_module(f"{EXTENSION}.operators.window.jobs")

    def finished_later(operator, context):
        results = operator.prepare(context)(None, None)
        attributes = seeded.data.objects["floor"].data.attributes
        attributes.remove(attributes["grid_row"])
        operator.finish(context, results)

    monkeypatch.setattr(jobs.JobOperator, "run_blocking", jobs.reported(finished_later))
    with pytest.raises(RuntimeError, match="floor: the mesh has lost its attribute grid_row"):
        seeded.ops.reflcolor.colorize()
    assert "Colorized" not in seeded.data.objects["wall"].data.color_attributes


def test_several_scans_are_one_step_of_undo(seeded, matched):
    for act in ("colorize", "match_photos"):
        seeded.ops.ed.undo_push(message="before")
        before = everything(seeded)
        getattr(seeded.ops.reflcolor, act)("EXEC_DEFAULT", True)
        assert all(len(said(seeded, name)) >= 1 for name in POSES) and everything(seeded) != before
        seeded.ops.ed.undo()
        assert everything(seeded) == before


def world_m(bpy, name, scan):
    """Where the vertices of an object are in meters, and where its scan with its pose has them."""
    obj = bpy.data.objects[name]
    own = np.array([obj.matrix_world @ vertex.co for vertex in obj.data.vertices])
    points = scan.points[scan.valid] @ scan.pose[:3, :3].T + scan.pose[:3, 3]
    return own * bpy.context.scene.unit_settings.scale_length, points


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_scans_are_matched_where_their_objects_are(blender, files, matched, unit):
    blender.context.scene.unit_settings.scale_length = unit
    load(blender, files)
    blender.data.objects["floor"].location.x += 3 / unit
    blender.data.objects["floor"].rotation_euler.z += 0.4
    blender.ops.reflcolor.match_photos()
    assert [scan.name for scan in matched["scans"]] == ["wall", "floor"]
    for scan in matched["scans"]:
        expected, found = world_m(blender, scan.name, scan)
        np.testing.assert_allclose(found, expected, atol=1e-4)


def test_points_in_world_coordinates_keep_their_place_beside_other_scans(blender, tmp_path, files, matched):
    far = np.array([637_000.0, 849_000.0, 400.0])
    for number, name in enumerate(POSES):
        scan = random_scan(number)
        scan.points[scan.valid] += far + 1000 * number
        write_small_ptx(tmp_path / f"{name}.ptx", scan, np.eye(4))
    load(blender, files)
    blender.ops.reflcolor.match_photos()
    shift = np.array(blender.data.objects["wall"]["reflcolor_shift"])
    for given in matched["scans"]:
        (scan,) = read_scans(tmp_path / f"{given.name}.ptx")
        found = (given.points + given.pose[:3, 3] + shift)[scan.valid]
        world = (scan.points + scan.pose[:3, 3])[scan.valid]
        np.testing.assert_allclose(world.mean(axis=0), far + 1000 * (given.name == "floor"), rtol=0, atol=5)
        np.testing.assert_allclose(found, world, rtol=0, atol=2e-3)
        np.testing.assert_array_equal(given.pose[:3, :3], np.eye(3))


def test_a_site_that_was_scaled_keeps_its_relative_poses(site, matched):
    empty = site.data.objects.new("site", None)
    site.context.collection.objects.link(empty)
    for name in POSES:
        site.data.objects[name].parent = empty
    empty.scale = (0.25, 0.25, 0.25)
    empty.location = (7, 8, 9)
    site.ops.reflcolor.match_photos()
    wall, floor = (scan.pose for scan in matched["scans"])
    np.testing.assert_allclose(np.linalg.solve(wall, floor), POSES["floor"], atol=1e-5)


def test_each_scan_keeps_its_own_seeds_and_gets_those_found_on_it(seeded, matched):
    for name, locked in (("wall", True), ("floor", False)):
        seed = state(seeded, name).seeds.add()
        seed.row, seed.col, seed.reason, seed.locked, seed.confidence = 5, 9, "appearance", locked, 0.5
    seeded.ops.reflcolor.match_photos()
    assert [len(seeds) for seeds in matched["hand"]] == [2, 2]
    assert [len(seeds) for seeds in matched["kept"]] == [1, 0]
    places = {name: [(seed.row, seed.col, seed.reason) for seed in state(seeded, name).seeds] for name in POSES}
    by_hand = [(1, 3, "hand"), (4, 3, "hand")]
    assert places["wall"] == [*by_hand, (5, 9, "appearance"), (0, 5, "pose"), (1, 6, "pose")]
    assert places["floor"] == [*by_hand, (0, 5, "pose")]


def test_each_scan_has_its_own_picture_and_provenance_of_the_matches(site, matched):
    site.ops.reflcolor.match_photos()
    assert [state(site, name).matches_image.name for name in POSES] == ["wall Matches", "floor Matches"]
    wall, floor = (site.data.objects[name]["reflcolor_matching"] for name in POSES)
    assert '"verified": false' in wall and '"verified": true' in floor


def test_each_scan_keeps_its_own_verdict_of_a_photo(site, matched):
    site.ops.reflcolor.match_photos()
    wall, floor = (verdicts(site.data.objects[name]) for name in POSES)
    assert wall == [("view.png", False, "not")] and floor == [("view.png", True, "verified")]
    # Another match of one scan leaves the other's alone, and a new name of the image changes nothing.
    site.data.images["view.png"].name = "yard.png"
    select(site, "floor")
    site.ops.reflcolor.match_photos()
    assert verdicts(site.data.objects["wall"]) == [("yard.png", False, "not")]


def test_matches_are_told_for_each_scan_with_warnings_that_name_it(site, matched, capfd):
    capfd.readouterr()
    site.ops.reflcolor.match_photos()
    assert capfd.readouterr().out.splitlines() == [
        "Warning: wall: view.png could not be verified",
        "Warning: wall: view.png: 3 pairs are too few",
        "Info: Found 2 seeds for wall",
        "Info: Found 1 seeds for floor",
        "Info: Found seeds for 2 scans: wall (2), floor (1)",
    ]
    assert said(site, "floor") == [(False, "Found 1 seeds for floor"), (False, "view.png: verified")]


def test_a_single_scan_is_matched_and_told_as_ever(site, matched, capfd):
    select(site, "floor")
    capfd.readouterr()
    before = said(site, "wall")
    site.ops.reflcolor.match_photos()
    assert [scan.name for scan in matched["scans"]] == ["floor"]
    assert capfd.readouterr().out.splitlines() == ["Info: Found 2 seeds for floor"]
    assert verdicts(site.data.objects["floor"]) == [("view.png", True, "verified")]
    assert said(site, "wall") == before and not state(site, "wall").seeds


@pytest.mark.parametrize("times", [0, 1, 4])
def test_cancelling_the_match_leaves_all_scans_as_they_were(seeded, cancelled, times):
    before = everything(seeded)
    cancelled(times)
    assert seeded.ops.reflcolor.match_photos(matching="paper") == {"CANCELLED"}
    assert everything(seeded) == before
