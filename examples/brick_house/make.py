"""Make scene 3, a brick house: four scans with their poses, five photos, their cameras, seeds and the truth.

    python examples/brick_house/make.py FOLDER

needs the bpy wheel and the extension's other dependencies (``make setup``). ``photo_10.jpg``, ``photo_25.jpg`` and
``photo_45.jpg`` are taken so many degrees beside the line of the scan ``south``; with ``photo_north.jpg`` and
``photo_west.jpg`` every side of the house is on one of them. There are two files of seeds for each scan: with
colors from ``photo_25.jpg`` alone, and from that and the last two.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from examples.brick_house import scene as house  # noqa: E402
from examples.scenes import shooting  # noqa: E402

SAMPLES = 16
TARGET = (0.0, 0.0, 1.9)
# Where the scanner stood, around the house; each looks at its middle.
STATIONS = {
    "south": (-1.5, -10.5, 1.7),
    "east": (11.0, -2.5, 1.7),
    "north": (1.5, 11.0, 1.7),
    "west": (-11.0, 2.0, 1.7),
}
DEGREES_OFF = (10, 25, 45)
MODEL = shooting.scanner.ScannerModel(
    rows=280,
    columns=420,
    azimuth_deg=(-36.0, 36.0),
    elevation_deg=(-22.0, 26.0),
    range_limits_m=(0.5, 40.0),
    beam_deg=0.15,
    range_noise_m=0.003,
    range_step_m=0.001,
    reference_range_m=8.0,
    range_falloff=0.5,
    incidence_falloff=0.7,
    seed=3,
)

# What a person would take a color from where a photo does not show the very place: all but the bin is in the photo from
# 25 degrees.
_BRICK = (0.31, -3.00, 0.89)
_ROOF = (1.64, -2.14, 3.66)
_WHITE = (-1.63, -3.46, 2.64)
_BLUE = (1.61, -3.03, 1.73)
_STONE = (-0.24, -3.06, 0.12)
_LAWN = (0.78, -5.77, 0.00)
_HEDGE = (0.99, -3.68, 0.09)
_CROWN = (5.35, -3.79, 2.44)
_BIN = (-4.82, -1.75, 0.76)
_BIN_LID = (-4.85, -1.75, 1.05)
# Colors to type in.
_BARK, _IRON = (92, 72, 52), (60, 60, 62)
_PATH = (-1.28, -5.19, 0.01)
# What a person would click on in each scan: what, where in the scene, a color to type in or None, a place like it.
SEEDS = {
    "south": (
        ("brick, between shutter and door", (-1.82, -3.00, 1.97), None, _BRICK),
        ("brick, by the door", (-0.55, -3.00, 1.98), None, _BRICK),
        ("brick, by the door, low", (-0.44, -3.00, 1.23), None, _BRICK),
        ("brick, right edge", (3.68, -3.00, 1.62), None, _BRICK),
        ("brick, below the left window", (-2.68, -3.00, 0.65), None, _BRICK),
        ("brick, left of the step", (-1.95, -3.00, 0.98), None, _BRICK),
        ("brick, right of the step", (-0.44, -2.99, 0.56), None, _BRICK),
        ("brick, below the middle window", (1.16, -3.00, 0.72), None, _BRICK),
        ("brick, low", (2.30, -3.00, 0.97), None, _BRICK),
        ("brick, low right", (3.17, -3.00, 0.56), None, _BRICK),
        ("brick, above left", (-3.45, -3.00, 2.47), None, _BRICK),
        ("brick, above middle", (0.86, -3.00, 2.55), None, _BRICK),
        ("brick, above right", (2.71, -3.00, 2.56), None, _BRICK),
        ("brick, low left", (-3.52, -3.00, 0.49), None, _BRICK),
        ("lawn, by the plinth", (-2.53, -3.94, 0.00), None, _LAWN),
        ("lawn, by the flowers", (0.09, -4.60, 0.00), None, _LAWN),
        ("lawn, right of the flowers", (2.10, -4.82, 0.00), None, _LAWN),
        ("gutter, right", (1.34, -3.46, 2.64), None, _WHITE),
        ("brick, left", (-3.69, -2.99, 0.81), None, _BRICK),
        ("brick, right", (0.31, -3.00, 0.89), None, _BRICK),
        ("brick, above", (-0.74, -3.00, 2.47), None, _BRICK),
        ("brick, far right", (3.10, -3.00, 0.73), None, _BRICK),
        ("roof, left", (-3.08, -2.09, 3.68), None, _ROOF),
        ("roof, right", (1.64, -2.14, 3.66), None, _ROOF),
        ("gutter", (-1.63, -3.46, 2.64), None, _WHITE),
        ("window frame, left", (-2.90, -3.06, 1.59), None, _WHITE),
        ("window frame, right", (1.06, -3.06, 1.73), None, _WHITE),
        ("shutter 1", (-3.63, -3.05, 1.73), None, _BLUE),
        ("shutter 2", (-2.13, -3.04, 1.73), None, _BLUE),
        ("shutter 3", (-0.15, -3.05, 1.73), None, _BLUE),
        ("shutter 4", (1.61, -3.03, 1.73), None, _BLUE),
        ("shutter 5", (3.35, -3.05, 1.73), None, _BLUE),
        ("door", (-1.21, -3.06, 1.73)),
        ("door frame", (-1.72, -3.05, 1.59), None, _WHITE),
        ("plinth", (-3.06, -3.06, 0.14), None, _STONE),
        ("plinth, right", (-0.24, -3.06, 0.12), None, _STONE),
        ("doorstep", (-1.24, -3.70, 0.17)),
        ("path", (-1.28, -5.19, 0.01), None, _PATH),
        ("lawn, left", (-3.57, -5.45, 0.00), None, _LAWN),
        ("lawn, right", (0.78, -5.77, 0.00), None, _LAWN),
        ("lawn, far right", (3.32, -4.78, 0.00), None, _LAWN),
        ("lawn, far left", (-8.16, 4.33, 0.00), None, _LAWN),
        ("hedge", (7.05, -1.00, 0.40), None, _HEDGE),
        ("bin", (-4.55, -2.00, 0.37), None, _BIN),
        ("bin lid", (-4.62, -2.04, 1.06), None, _BIN_LID),
        ("barrel", (4.49, -2.66, 0.46)),
        ("trunk", (-6.58, 3.66, 1.57), _BARK),
        ("crown, left", (-7.01, 2.70, 3.17), None, _CROWN),
        ("crown, right", (5.16, -3.28, 2.50), None, _CROWN),
        ("red flower", (0.20, -3.62, 0.31)),
        ("yellow flower", (0.36, -3.68, 0.31)),
        ("purple flower", (0.52, -3.73, 0.31)),
        ("leaves", (0.99, -3.68, 0.09), None, _HEDGE),
        ("chimney", (2.36, 0.40, 5.54), None, _BRICK),
    ),
    "east": (
        ("brick, gable", (4.00, -0.20, 4.20), None, _BRICK),
        ("brick, gable, left", (4.00, -0.27, 3.20), None, _BRICK),
        ("brick, gable, right", (4.00, 1.06, 2.86), None, _BRICK),
        ("brick, upper right", (4.01, 2.37, 2.78), None, _BRICK),
        ("brick, middle", (4.00, 0.06, 2.20), None, _BRICK),
        ("brick, middle, low", (4.00, 0.06, 1.37), None, _BRICK),
        ("brick, by the hedge", (4.00, 0.95, 0.79), None, _BRICK),
        ("brick, low right", (4.01, 1.80, 0.54), None, _BRICK),
        ("brick, right edge", (4.00, 2.69, 0.87), None, _BRICK),
        ("brick, by the barrel", (4.01, -1.63, 0.62), None, _BRICK),
        ("brick, left edge", (4.00, -2.94, 0.80), None, _BRICK),
        ("lawn, by the plinth", (5.49, -1.57, 0.00), None, _LAWN),
        ("lawn, far left", (-7.64, -8.73, 0.00), None, _LAWN),
        ("crown, left", (6.57, -3.51, 2.68), None, _CROWN),
        ("crown, low left", (6.35, -3.44, 2.03), None, _CROWN),
        ("crown, top", (7.45, -2.64, 2.93), None, _CROWN),
        ("crown, top right", (7.59, -1.97, 2.89), None, _CROWN),
        ("crown, low", (6.83, -2.56, 1.71), None, _CROWN),
        ("crown, right", (7.65, -1.84, 2.02), None, _CROWN),
        ("crown, low right", (7.40, -2.01, 1.60), None, _CROWN),
        ("roof, left", (4.18, -0.44, 4.70), None, _ROOF),
        ("crown", (7.53, -2.45, 2.30), None, _CROWN),
        ("trunk", (6.54, -2.59, 0.77), _BARK),
        ("brick, top", (4.00, 0.20, 3.77), None, _BRICK),
        ("brick, right", (4.00, 2.69, 1.60), None, _BRICK),
        ("brick, low", (4.00, -1.05, 0.71), None, _BRICK),
        ("shutter 1", (4.05, -1.87, 1.24), None, _BLUE),
        ("shutter 2", (4.05, -0.33, 1.73), None, _BLUE),
        ("shutter 3", (4.05, 0.53, 1.73), None, _BLUE),
        ("shutter 4", (4.06, 2.03, 1.73), None, _BLUE),
        ("window frame, left", (4.15, -1.25, 1.12), None, _WHITE),
        ("window frame, right", (4.06, 1.29, 1.35), None, _WHITE),
        ("barrel", (4.85, -2.22, 0.43), None, (4.49, -2.66, 0.46)),
        ("plinth", (4.06, -1.06, 0.15), None, _STONE),
        ("hedge", (7.75, -0.38, 0.59), None, _HEDGE),
        ("lawn", (5.37, -3.47, 0.00), None, _LAWN),
        ("lawn, behind the hedge", (-5.07, 12.42, 0.00), None, _LAWN),
        ("roof", (4.33, 0.94, 4.34), None, _ROOF),
        ("path", (-0.81, -5.68, 0.01), None, _PATH),
        ("purple flower", (3.67, -3.65, 0.31), None, (0.52, -3.73, 0.31)),
        ("yellow flower", (3.50, -3.56, 0.31), None, (0.36, -3.68, 0.31)),
        ("leaves", (3.72, -3.62, 0.14), None, _HEDGE),
        ("far hedge", (-7.25, -4.63, 0.33), None, _HEDGE),
    ),
    "north": (
        ("brick, between the windows", (1.19, 3.00, 2.06), None, _BRICK),
        ("brick, between, low", (1.31, 3.00, 1.22), None, _BRICK),
        ("brick, above left", (2.13, 3.00, 2.55), None, _BRICK),
        ("brick, above", (0.15, 3.00, 2.39), None, _BRICK),
        ("brick, above right", (-2.06, 3.00, 2.47), None, _BRICK),
        ("brick, below", (2.44, 3.00, 0.81), None, _BRICK),
        ("brick, below, low", (0.64, 3.00, 0.57), None, _BRICK),
        ("brick, below right", (-1.58, 3.00, 0.73), None, _BRICK),
        ("brick, low right", (-3.17, 3.01, 0.56), None, _BRICK),
        ("brick, between, right", (-1.28, 3.00, 1.73), None, _BRICK),
        ("brick, between, upper", (-1.31, 3.00, 2.39), None, _BRICK),
        ("brick, right edge", (-3.78, 3.00, 2.22), None, _BRICK),
        ("brick, by the door", (3.89, 3.00, 1.73), None, _BRICK),
        ("brick, left of the sill", (2.56, 3.00, 0.98), None, _BRICK),
        ("lawn, by the plinth", (0.65, 3.48, 0.00), None, _LAWN),
        ("lawn, by the bench", (-1.50, 5.53, 0.00), None, _LAWN),
        ("lawn, far left", (3.75, 4.09, 0.00), None, _LAWN),
        ("lawn, left edge", (7.46, -3.64, 0.00), None, _LAWN),
        ("gutter, right", (-1.75, 3.46, 2.64), None, _WHITE),
        ("brick, middle", (1.31, 3.00, 1.39), None, _BRICK),
        ("brick, left", (3.82, 3.00, 2.55), None, _BRICK),
        ("brick, low", (-0.55, 3.00, 0.81), None, _BRICK),
        ("brick, right", (-3.80, 3.00, 1.56), None, _BRICK),
        ("roof, left", (2.60, 2.13, 3.66), None, _ROOF),
        ("roof, right", (-1.91, 1.82, 3.88), None, _ROOF),
        ("gutter", (0.99, 3.47, 2.66), None, _WHITE),
        ("window frame, left", (2.36, 3.05, 1.75), None, _WHITE),
        ("window frame, middle", (-0.01, 3.06, 1.58), None, _WHITE),
        ("window frame, right", (-2.38, 3.06, 1.57), None, _WHITE),
        ("back door", (3.27, 3.05, 1.12)),
        ("shutter 1", (1.62, 3.05, 1.73)),
        ("shutter 2", (0.77, 3.05, 1.73)),
        ("shutter 3", (-0.74, 3.06, 1.73)),
        ("shutter 4", (-1.67, 3.05, 1.73)),
        ("shutter 5", (-3.18, 3.05, 1.73)),
        ("plinth", (1.69, 3.06, 0.19), None, _STONE),
        ("lawn, left", (2.17, 5.46, 0.00), None, _LAWN),
        ("lawn, right", (-3.57, 4.47, 0.00), None, _LAWN),
        ("hedge, left", (7.05, 0.00, 0.56), None, _HEDGE),
        ("hedge, right", (-7.25, 0.01, 0.32), None, _HEDGE),
        ("crown, left", (6.73, -1.43, 2.15), None, _CROWN),
        ("crown, right", (-4.87, 3.83, 2.63), None, _CROWN),
        ("trunk", (6.43, -2.47, 0.76), _BARK),
        ("bench", (-2.45, 4.10, 0.46)),
        ("bench leg", (-1.97, 3.95, 0.21), _IRON),
        ("chimney", (2.38, 1.00, 5.10), None, _BRICK),
    ),
    "west": (
        ("brick, left slope", (-4.00, 0.95, 3.61), None, _BRICK),
        ("brick, far left", (-4.00, 1.95, 2.95), None, _BRICK),
        ("brick, left edge", (-4.00, 2.57, 2.61), None, _BRICK),
        ("brick, left, low", (-4.01, 2.57, 1.37), None, _BRICK),
        ("brick, low left", (-4.00, 2.57, 0.94), None, _BRICK),
        ("brick, below the window", (-4.00, 1.15, 0.62), None, _BRICK),
        ("brick, by the shutter", (-4.00, 1.19, 1.70), None, _BRICK),
        ("brick, between the windows", (-4.00, 0.05, 2.62), None, _BRICK),
        ("brick, right slope", (-4.01, -1.03, 3.86), None, _BRICK),
        ("brick, right", (-4.01, -1.46, 3.19), None, _BRICK),
        ("brick, far right", (-4.00, -2.20, 2.61), None, _BRICK),
        ("brick, by the right shutter", (-4.01, -1.18, 1.45), None, _BRICK),
        ("brick, right edge", (-4.01, -2.82, 1.04), None, _BRICK),
        ("brick, low", (-4.01, 0.32, 0.80), None, _BRICK),
        ("crown, middle", (-7.95, 3.02, 2.92), None, _CROWN),
        ("crown, low", (-7.41, 2.95, 2.14), None, _CROWN),
        ("crown, left", (-7.88, 3.33, 2.00), None, _CROWN),
        ("crown, behind", (5.02, 5.03, 1.66), None, _CROWN),
        ("lawn, by the trunk", (-4.83, 3.71, 0.00), None, _LAWN),
        ("lawn, behind", (-1.36, 4.92, 0.00), None, _LAWN),
        ("lawn, by the plinth", (-5.18, 1.06, 0.00), None, _LAWN),
        ("crown", (-7.82, 2.98, 2.44), None, _CROWN),
        ("trunk", (-6.74, 3.74, 0.97), _BARK),
        ("brick, left", (-4.01, 1.82, 2.21), None, _BRICK),
        ("brick, right", (-4.00, -2.17, 1.87), None, _BRICK),
        ("brick, top", (-4.01, 0.15, 4.27), None, _BRICK),
        ("brick, low", (-4.00, -0.81, 0.70), None, _BRICK),
        ("window frame, top", (-4.06, 0.00, 3.67), None, _WHITE),
        ("window frame", (-4.06, 0.00, 1.79), None, _WHITE),
        ("shutter, left", (-4.05, 0.75, 1.72)),
        ("shutter, right", (-4.05, -0.79, 1.73)),
        ("plinth", (-4.05, 1.84, 0.16), None, _STONE),
        ("hedge", (-7.95, 0.39, 0.65), None, _HEDGE),
        ("lawn", (-5.54, 1.89, 0.00), None, _LAWN),
        ("lawn, far right", (1.44, -8.46, 0.00), None, _LAWN),
        ("roof, left", (-4.35, 1.61, 3.91), None, _ROOF),
        ("roof, right", (-4.35, -1.91, 3.78), None, _ROOF),
        ("bin", (-4.85, -1.49, 0.77), None, _BIN),
        ("bin lid", (-4.78, -1.53, 1.06), None, _BIN_LID),
        ("bench", (-2.89, 3.84, 0.48), None, (-2.45, 4.10, 0.46)),
        ("bench leg", (-3.23, 3.88, 0.13), _IRON),
        ("path", (-1.36, -7.36, 0.01), None, _PATH),
    ),
}
# What Method 1 takes its colors from: one photo that shows two sides, or one of every side.
PHOTOS = {"one_photo": ("photo_25.jpg",), "three_photos": ("photo_25.jpg", "photo_north.jpg", "photo_west.jpg")}


def main(folder):
    """Write the scene's files into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    views = {f"photo_{degrees}.jpg": (STATIONS["south"], degrees) for degrees in DEGREES_OFF}
    views |= {"photo_north.jpg": (STATIONS["north"], 31), "photo_west.jpg": (STATIONS["west"], 20)}
    scans, models = [], {}
    with shooting.renders.SceneRenders(house.build()) as scene_renders:
        for seed, (name, position) in enumerate(STATIONS.items()):
            models[name] = model = replace(MODEL, seed=MODEL.seed + seed)
            pose = facing(position, TARGET)
            cast = scene_renders.caster(pose)
            scan, truth = shooting.scanner.simulate_scan(cast, model, name=name, pose=pose)
            shooting.write_scan(scan, model, folder / f"{name}.scan.json")
            shooting.image_files.write_png(folder / f"{name}.truth.png", truth)
            scans.append(scan)
        photos = {
            name: scene_renders.photo(
                shooting.camera_off_line(position, TARGET, degrees, focal_px=560.0, nearness=1.1), samples=SAMPLES
            )
            for name, (position, degrees) in views.items()
        }
    shooting.writers.write_e57(scans, folder / "house.e57")
    shooting.write_photos(photos, folder)
    for scan in scans:
        for variant, names in PHOTOS.items():
            given = {name: photos[name] for name in names}
            # With one photo, what only the other sides have stays without a seed.
            seeds = shooting.pick_seeds(scan, models[scan.name], given, SEEDS[scan.name], leave_out=len(names) == 1)
            shooting.write_seeds(seeds, folder / f"{scan.name}.{variant}.seeds.json")


def facing(position, target):
    """Pose of a leveled scanner at ``position`` that looks toward ``target``."""
    across, along = np.subtract(target, position)[:2]
    turn = np.arctan2(-across, along)
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    pose[:3, 3] = position
    return pose


if __name__ == "__main__":
    shooting.run(main)
