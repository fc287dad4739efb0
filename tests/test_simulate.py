"""The virtual scanner and camera over scenes in Blender, against closed forms and Blender's own ray casting."""

import importlib
import json
from dataclasses import replace

import numpy as np
import pytest
from blender_session import EXTENSION

from reflcolor_addon import read_scans
from reflcolor_addon.files.images import read_image
from reflcolor_addon.scan.directions import directions
from reflcolor_addon.simulation.virtual_camera import VirtualCamera, look_at
from reflcolor_addon.simulation.virtual_scanner import ScannerModel, simulate_scan

IDEAL = ScannerModel(rows=24, columns=36, azimuth_deg=(-30, 30), elevation_deg=(-40, 10)).ideal()


@pytest.fixture
def renders(blender):
    """The module `scene_renders` of the installed extension."""
    return importlib.import_module(f"{EXTENSION}.operators.scene.scene_renders")


@pytest.fixture
def simulation(blender):
    """The module `simulation` of the installed extension."""
    return importlib.import_module(f"{EXTENSION}.operators.scene.simulation")


def add_box(blender, center, size, *, color=None, nir=None, metallic=0.0):
    """Add a box, with a material where a color (linear RGB) is given; return object and material."""
    blender.ops.mesh.primitive_cube_add(size=1, location=center)
    item = blender.context.active_object
    item.scale = size
    material = None
    if color is not None:
        material = blender.data.materials.new("paint")
        if material.node_tree is None:
            material.use_nodes = True
        shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        shader.inputs["Base Color"].default_value = (*color, 1)
        shader.inputs["Metallic"].default_value = metallic
        if nir is not None:
            material["nir_albedo"] = nir
        item.data.materials.append(material)
    blender.context.view_layer.update()
    return item, material


def at_height(height, turn_deg=0.0):
    pose = np.eye(4)
    turn = np.radians(turn_deg)
    pose[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    pose[2, 3] = height
    return pose


def scan(renders, blender, pose, model=IDEAL):
    with renders.SceneRenders(blender.context.scene) as scene_renders:
        return simulate_scan(scene_renders.caster(pose), model, pose=pose)


def test_ranges_of_a_floor_are_those_of_its_plane(blender, renders):
    add_box(blender, (0, 0, -0.5), (200, 200, 1))
    found, _ = scan(renders, blender, at_height(1.5))
    sine = -directions(IDEAL.azimuths_deg(), IDEAL.elevations_deg())[..., 2]
    down = np.broadcast_to(sine > 0.05, found.shape)
    assert found.valid[down].all()
    assert found.range[down] == pytest.approx(1.5 / sine[down], rel=1e-4)
    assert not found.valid[sine < 0].any()


@pytest.mark.parametrize(
    "window",
    [
        {},
        {"rows": 60, "columns": 15},
        {"azimuth_deg": (100, 190)},
        {"azimuth_deg": (-180, 180), "columns": 90},
        {"azimuth_deg": (-180, 180), "elevation_deg": (-90, 90), "columns": 40, "rows": 20},
    ],
    ids=["square", "other steps", "off center", "full turn", "whole sphere"],
)
def test_ranges_are_those_of_blenders_ray_casting(blender, renders, window):
    add_box(blender, (0, 0, -0.5), (30, 30, 1))
    add_box(blender, (0.6, 3.0, 0.8), (1.0, 0.7, 1.6))
    add_box(blender, (-4.0, -2.0, 1.0), (1.5, 2.0, 2.0))
    pose, model = at_height(1.3, turn_deg=25), replace(IDEAL, **window)
    found, _ = scan(renders, blender, pose, model)
    rays = directions(model.azimuths_deg(), model.elevations_deg()) @ pose[:3, :3].T
    depsgraph = blender.context.evaluated_depsgraph_get()
    cast = [blender.context.scene.ray_cast(depsgraph, pose[:3, 3], ray, distance=70) for ray in rays.reshape(-1, 3)]
    hit = np.array([row[0] for row in cast]).reshape(found.shape)
    expected = np.linalg.norm(np.array([row[1] for row in cast]).reshape(rays.shape) - pose[:3, 3], axis=-1)
    # A ray along an edge may go either way.
    agree = (found.valid == hit) & (~hit | (np.abs(found.range - expected) < 2e-3 * expected))
    assert agree.mean() > 0.995
    assert np.abs(found.points @ pose[:3, :3].T + pose[:3, 3])[agree & hit][:, 2].max() < 2.5


def test_a_full_turn_closes(blender, renders):
    add_box(blender, (0, 0, 1.3), (8, 6, 4))
    found, _ = scan(renders, blender, at_height(1.3), replace(IDEAL, azimuth_deg=(-180, 180), columns=72))
    assert found.full_turn


def test_a_wide_beam_at_the_pole_still_scans(blender, renders):
    add_box(blender, (0, 0, 1.3), (8, 6, 4))
    model = replace(IDEAL, azimuth_deg=(-180, 180), elevation_deg=(-90, 90), beam_deg=2.0)
    found, _ = scan(renders, blender, at_height(1.3), model)
    assert found.valid.all()


def test_reflectance_comes_from_the_materials_own_albedo(blender, renders):
    add_box(blender, (0, 3, 1), (8, 1, 8), color=(0.1, 0.1, 0.9), nir=0.5)
    model = replace(IDEAL, range_falloff=0, incidence_falloff=0, reflectance_gain=1.0)
    found, _ = scan(renders, blender, at_height(1.0), model)
    assert found.reflectance[found.valid] == pytest.approx(0.5, abs=1e-4)


def test_reflectance_comes_from_the_shader_where_it_has_an_output_for_it(blender, renders):
    _, material = add_box(blender, (0, 3, 1), (8, 1, 8), color=(0.1, 0.1, 0.9), nir=0.1)
    output = material.node_tree.nodes.new("ShaderNodeOutputAOV")
    output.aov_name = "nir_albedo"
    output.inputs["Value"].default_value = 0.75
    model = replace(IDEAL, range_falloff=0, incidence_falloff=0, reflectance_gain=1.0)
    found, _ = scan(renders, blender, at_height(1.0), model)
    assert found.reflectance[found.valid] == pytest.approx(0.75, abs=1e-4)


def test_reflectance_follows_the_color_where_nothing_is_said(blender, renders):
    add_box(blender, (0, 3, 1), (8, 1, 8), color=(0.8, 0.4, 0.2))
    model = replace(IDEAL, range_falloff=0, incidence_falloff=0, reflectance_gain=1.0)
    found, _ = scan(renders, blender, at_height(1.0), model)
    assert found.reflectance[found.valid] == pytest.approx(0.1 + 0.48 + 0.08 + 0.02, abs=2e-3)


@pytest.mark.parametrize("metallic", [0.0, 1.0])
def test_truth_is_the_base_color_at_every_angle(blender, renders, metallic):
    add_box(blender, (0, 3, 1), (40, 1, 8), color=(0.8, 0.4, 0.2), metallic=metallic)
    found, truth = scan(renders, blender, at_height(1.0), replace(IDEAL, azimuth_deg=(-75, 75)))
    expected = np.round((1.055 * np.array([0.8, 0.4, 0.2]) ** (1 / 2.4) - 0.055) * 255)
    assert np.abs(truth[found.valid].astype(int) - expected).max() <= 1 if metallic == 0 else 3


def test_what_is_not_rendered_is_not_scanned(blender, renders):
    hidden, _ = add_box(blender, (0, 3, 1), (8, 1, 8))
    hidden.hide_render = True
    excluded, _ = add_box(blender, (0, 5, 1), (8, 1, 8))
    collection = blender.data.collections.new("aside")
    blender.context.scene.collection.children.link(collection)
    blender.context.scene.collection.objects.unlink(excluded)
    collection.objects.link(excluded)
    blender.context.view_layer.layer_collection.children["aside"].exclude = True
    found, _ = scan(renders, blender, at_height(1.0))
    assert not found.valid.any()


def test_ranges_are_meters_whatever_the_scenes_unit(blender, renders):
    blender.context.scene.unit_settings.scale_length = 0.01
    add_box(blender, (0, 0, -50), (20000, 20000, 100))
    found, _ = scan(renders, blender, at_height(1.5))
    assert found.points[found.valid][:, 2] == pytest.approx(-1.5, abs=1e-3)


def test_the_scene_stays_as_it_was(blender, renders):
    add_box(blender, (0, 3, 1), (8, 1, 8))
    scene = blender.context.scene

    def state():
        kinds = (blender.data.scenes, blender.data.cameras, blender.data.objects, blender.data.worlds)
        render = scene.render
        return (
            [sorted(kind.keys()) for kind in kinds],
            render.engine,
            render.filepath,
            render.resolution_x,
            scene.camera,
        )

    before = state()
    scan(renders, blender, at_height(1.0))
    assert state() == before
    assert blender.context.scene is scene


def test_a_photo_shows_a_thing_where_its_camera_projects_it(blender, renders):
    place = np.array((0.7, 3.0, 1.6))
    add_box(blender, place, (0.04, 0.04, 0.04), color=(0.9, 0.05, 0.05))
    blender.context.scene.world = world = blender.data.worlds.new("even light")
    if world.node_tree is None:
        world.use_nodes = True
    camera = VirtualCamera(
        width=160, height=120, focal_px=120.0, pose=look_at((0, 0, 1), (0, 3, 1)), distortion=(-0.15, 0.02)
    )
    with renders.SceneRenders(blender.context.scene) as scene_renders:
        photo = scene_renders.photo(camera, samples=4)
    (x, y), depth = camera.project(place)
    row, col = np.unravel_index(np.argmin(photo.depth), photo.depth.shape)
    assert (col + 0.5, row + 0.5) == pytest.approx((x, y), abs=1.5)
    assert photo.depth[row, col] == pytest.approx(depth - 0.02, abs=1e-3)
    red, green, _blue = photo.image[row, col].astype(int)
    assert red > 1.3 * green
    assert np.isfinite(photo.shows(place - (0, 0.02, 0))).all()
    assert np.isnan(photo.shows(place + (0, 1.0, 0))).all()


def simulate(blender, simulation, path, **changes):
    """Simulate with a small scanner at the scene's camera and run to the end; return the camera."""
    scene = blender.context.scene
    if scene.camera is None:
        scene.camera = add_camera(blender, "station", (0, 0, 1.2), (1.4, 0, 0))
    pose = simulation.leveled_pose(scene, "CAMERA", scene.camera)
    what = {"path": path, "pose": pose, "model": replace(IDEAL, seed=7), "samples": 2} | changes
    told = list(simulation.simulation_steps(scene, simulation.Simulation(**what)))
    assert [fraction for fraction, _ in told] == sorted(fraction for fraction, _ in told)
    return scene.camera


def add_camera(blender, name, place, turn):
    item = blender.data.objects.new(name, blender.data.cameras.new(name))
    item.location, item.rotation_euler = place, turn
    blender.context.scene.collection.objects.link(item)
    blender.context.view_layer.update()
    return item


@pytest.mark.parametrize("file_name", ["yard.ptx", "yard.e57", "yard.scan.json"])
def test_a_simulated_scan_reads_back_with_its_pose_and_truth(blender, simulation, tmp_path, file_name):
    add_box(blender, (0, 4, 1), (9, 1, 9), color=(0.8, 0.4, 0.2))
    simulate(blender, simulation, tmp_path / file_name)
    (found,) = read_scans(tmp_path / file_name)
    assert found.shape == (24, 36)
    assert found.pose[:3, 3] == pytest.approx((0, 0, 1.2), abs=1e-6)
    world = found.points[found.valid] @ found.pose[:3, :3].T + found.pose[:3, 3]
    assert world[:, 1] == pytest.approx(3.5, abs=2e-3)
    assert read_image(tmp_path / "yard.truth.png").shape == (24, 36, 3)


def test_every_chosen_camera_takes_a_photo_that_its_description_fits(blender, simulation, tmp_path):
    add_box(blender, (0, 4, 1), (9, 1, 9), color=(0.8, 0.4, 0.2))
    render = blender.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 64, 96, 50
    add_camera(blender, "left side", (-2, 0, 1.2), (1.5, 0, -0.4))
    simulate(blender, simulation, tmp_path / "yard.ptx", cameras=("left side",))
    cameras = json.loads((tmp_path / "yard.cameras.json").read_text())
    assert list(cameras) == ["yard.left_side.png"]
    assert read_image(tmp_path / "yard.left_side.png").shape == (48, 32, 3)
    described = cameras["yard.left_side.png"]
    assert (described["width"], described["height"]) == (32, 48)
    # A portrait fits its longer side into the sensor of 36 mm, through a lens of 50 mm.
    assert described["focal_px"] == pytest.approx(48 * 50 / 36)


def test_the_same_simulation_gives_the_same_bytes(blender, simulation, tmp_path):
    add_box(blender, (0, 4, 1), (9, 1, 9), color=(0.8, 0.4, 0.2))
    noisy = ScannerModel(rows=20, columns=30, seed=3)
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        simulate(blender, simulation, tmp_path / folder / "yard.e57", model=noisy)
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()


def test_the_scanner_is_leveled_and_keeps_its_heading(blender, simulation):
    scene = blender.context.scene
    scene.camera = add_camera(blender, "station", (1, 2, 3), (0.9, 0.3, 0.5))
    pose = simulation.leveled_pose(scene, "CAMERA", scene.camera)
    looks = -np.array(scene.camera.matrix_world)[:3, 2]
    assert pose[:3, 2] == pytest.approx((0, 0, 1))
    assert pose[:2, 1] == pytest.approx(looks[:2] / np.linalg.norm(looks[:2]), abs=1e-6)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1)


def test_a_suffix_that_is_no_scan_is_one_clear_line(blender, simulation, tmp_path):
    with pytest.raises(ValueError, match=r"expected \.ptx, \.e57 or \.scan\.json"):
        simulate(blender, simulation, tmp_path / "yard.obj")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("camera", ["truth", "reflectance"])
def test_a_photo_never_overwrites_what_else_is_written(blender, simulation, tmp_path, camera):
    add_camera(blender, camera, (-2, 0, 1.2), (1.5, 0, -0.4))
    errors = importlib.import_module(f"{EXTENSION}.reflcolor_addon.errors")
    with pytest.raises(errors.UsageError, match=f"yard.{camera}.png: the same file as"):
        simulate(blender, simulation, tmp_path / "yard.scan.json", cameras=(camera,))
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_told_before_the_work(blender, simulation, tmp_path):
    pose = at_height(1.0)
    what = simulation.Simulation(path=tmp_path / "nowhere" / "yard.ptx", pose=pose, model=IDEAL)
    with pytest.raises(ValueError, match="there is no folder"):
        next(simulation.simulation_steps(blender.context.scene, what))


def test_a_cancelled_simulation_leaves_nothing(blender, simulation, tmp_path):
    add_box(blender, (0, 4, 1), (9, 1, 9))
    scenes = len(blender.data.scenes)
    what = simulation.Simulation(path=tmp_path / "yard.ptx", pose=at_height(1.0), model=IDEAL)
    steps = simulation.simulation_steps(blender.context.scene, what)
    next(steps)
    steps.close()
    assert not list(tmp_path.iterdir())
    assert len(blender.data.scenes) == scenes


def test_a_station_that_is_not_there_is_one_clear_line(blender, simulation):
    with pytest.raises(ValueError, match="the scene has no camera"):
        simulation.leveled_pose(blender.context.scene, "CAMERA", None)
