"""Make scene 3, a brick house: four scans with their poses, five photos, their cameras and the truth.

    python examples/brick_house/make.py FOLDER

needs the bpy wheel and the extension's other dependencies (``make setup``). ``photo_10.jpg``, ``photo_25.jpg`` and
``photo_45.jpg`` are taken so many degrees beside the line of the scan ``south``; with ``photo_north.jpg`` and
``photo_west.jpg`` every side of the house is on one of them. Colorize with ``photo_25.jpg`` alone, or with the last two
in addition, to see what one and three photos give.
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


def main(folder):
    """Write the scene's files into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    views = {f"photo_{degrees}.jpg": (STATIONS["south"], degrees) for degrees in DEGREES_OFF}
    views |= {"photo_north.jpg": (STATIONS["north"], 31), "photo_west.jpg": (STATIONS["west"], 20)}
    scans = []
    with shooting.renders.SceneRenders(house.build()) as scene_renders:
        for seed, (name, position) in enumerate(STATIONS.items()):
            model = replace(MODEL, seed=MODEL.seed + seed)
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


def facing(position, target):
    """Pose of a leveled scanner at ``position`` that looks towards ``target``."""
    across, along = np.subtract(target, position)[:2]
    turn = np.arctan2(-across, along)
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    pose[:3, 3] = position
    return pose


if __name__ == "__main__":
    shooting.run(main)
