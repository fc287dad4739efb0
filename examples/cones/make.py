"""Make everything in this folder again: the scan of two road cones, a photo of them, seeds and truth.

    python examples/cones/make.py [FOLDER]

needs the bpy wheel and the extension's other dependencies (``make setup``). Without FOLDER the files beside this script
are written anew. The same Blender gives the same bytes.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from examples.cones import scene as cones  # noqa: E402
from examples.scenes import shooting  # noqa: E402

SAMPLES = 48
# The scanner stands 1.25 m above the floor.
POSE = np.eye(4)
POSE[2, 3] = 1.25
MODEL = shooting.scanner.ScannerModel(
    rows=300,
    columns=450,
    azimuth_deg=(-30.0, 30.0),
    elevation_deg=(-28.0, 12.0),
    beam_deg=0.12,
    range_falloff=0.5,
    incidence_falloff=0.7,
    seed=1,
)
CAMERA = shooting.cameras.VirtualCamera(
    width=1200,
    height=900,
    focal_px=1120.0,
    pose=shooting.cameras.look_at((1.05, -0.35, 1.55), (-0.08, 3.0, 0.70)),
    distortion=(-0.06, 0.01),
    exposure_stops=-0.15,
    white_balance=(1.05, 1.0, 0.93),
    noise=0.012,
    seed=1,
)
# What a person would click on: what, where in the scene, and a color to type in where the photo is of no use.
SEEDS = (
    ("orange cone, low", (-0.52, 2.72, 0.16), None),
    ("orange cone, middle", (-0.53, 2.76, 0.45), None),
    ("orange cone, top", (-0.54, 2.80, 0.68), None),
    ("orange cone, wide band", (-0.53, 2.75, 0.32), None),
    ("orange cone, narrow band", (-0.54, 2.78, 0.56), None),
    ("blue cone, low", (0.42, 2.52, 0.16), None),
    ("blue cone, middle", (0.42, 2.56, 0.45), None),
    ("blue cone, top", (0.42, 2.60, 0.68), None),
    ("blue cone, wide band", (0.42, 2.55, 0.32), None),
    ("blue cone, narrow band", (0.42, 2.58, 0.56), None),
    ("orange cone, foot", (-0.60, 2.66, 0.04), None),
    ("blue cone, foot", (0.33, 2.47, 0.04), None),
    ("wall, left", (-1.30, 4.0, 1.45), None),
    ("wall, right", (0.45, 4.0, 1.05), None),
    ("wall, middle", (0.05, 4.0, 0.72), None),
    ("wall, far right", (2.12, 4.0, 0.75), (221, 182, 115)),
    ("floor, left", (-1.05, 2.85, 0.0), None),
    ("floor, middle", (-0.12, 2.46, 0.0), None),
    ("floor, right", (1.02, 2.85, 0.0), None),
    ("floor, before the bucket", (1.12, 2.98, 0.0), None),
    ("floor, front", (0.80, 2.42, 0.0), None),
    ("skirting", (-0.40, 3.98, 0.06), None),
    ("carton", (-1.45, 3.21, 0.22), None),
    ("crate", (-1.48, 3.29, 0.59), None),
    ("ball", (-0.05, 3.19, 0.18), None),
    ("bucket", (1.22, 3.15, 0.16), None),
    ("poster, paper", (-0.28, 4.0, 1.43), None),
    ("poster, top", (-0.28, 4.0, 1.58), None),
    ("poster, left", (-0.43, 4.0, 1.20), None),
    ("poster, right", (-0.14, 4.0, 1.20), None),
    ("window sill", (1.45, 3.89, 1.065), (236, 233, 224)),
)


def main(folder):
    """Write the example into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    with shooting.renders.SceneRenders(cones.build()) as scene_renders:
        scan, truth = shooting.scanner.simulate_scan(scene_renders.caster(POSE), MODEL, name="cones", pose=POSE)
        photo = scene_renders.photo(CAMERA, samples=SAMPLES)
    shooting.write_scan(scan, MODEL, folder / "cones.scan.json")
    shooting.write_photo(photo, folder / "photo.jpg")
    shooting.write_seeds(shooting.pick_seeds(scan, MODEL, {"photo.jpg": photo}, SEEDS), folder / "cones.seeds.json")
    shooting.image_files.write_png(folder / "truth.png", truth)


if __name__ == "__main__":
    shooting.run(main, HERE)
