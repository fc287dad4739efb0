"""Make scene 2, a person in a room: the scan, three photos of it, their cameras, seeds and the truth.

    python examples/person_room/make.py FOLDER

needs the bpy wheel and the extension's other dependencies (``make setup``). The photos are taken 10, 25 and 45 degrees
beside the scanner's line, each with an exposure, white balance and lens of its own. The seeds take their colors from
the first.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from examples.person_room import scene as room  # noqa: E402
from examples.scenes import shooting  # noqa: E402

SAMPLES = 20
TARGET = (0.0, 3.1, 0.85)
SCANNER = (0.0, 0.0, 1.35)
DEGREES_OFF = (10, 25, 45)
MODEL = shooting.scanner.ScannerModel(
    rows=380,
    columns=568,
    azimuth_deg=(-36.0, 36.0),
    elevation_deg=(-29.0, 19.0),
    beam_deg=0.12,
    range_falloff=0.5,
    incidence_falloff=0.7,
    seed=2,
)
# What a person would click on: what, where in the scene and, where the photo does not show it, a color to type in, or a
# place of like color.
SEEDS = (
    ("face, left", (-0.57, 2.64, 1.70)),
    ("face, low", (-0.53, 2.65, 1.63)),
    ("neck", (-0.53, 2.69, 1.53)),
    ("shelf, left side", (-2.21, 4.08, 1.25)),
    ("shelf, board", (-1.75, 4.08, 1.32)),
    ("shelf, right side", (-1.26, 4.23, 1.54)),
    ("shelf, low board", (-1.73, 4.08, 0.48)),
    ("rug, by the shoes", (-0.21, 2.82, 0.01)),
    ("rug, right of the chair", (0.99, 2.75, 0.01)),
    ("floor, right edge", (1.48, 2.86, 0.00)),
    ("blue book on the table", (0.10, 2.73, 0.76)),
    ("wall, above the shelf", (-2.12, 4.40, 2.35)),
    ("wall, above", (-0.33, 4.40, 2.44)),
    ("wall, right of the picture", (1.19, 4.40, 1.75)),
    ("wall, below the picture", (0.06, 4.40, 1.01)),
    ("wall, right of the door", (2.72, 4.40, 1.35), None, (1.19, 4.40, 1.75)),
    ("left wall", (-2.80, 4.15, 1.35)),
    ("right wall", (2.80, 4.09, 1.36), None, (-2.80, 4.15, 1.35)),
    ("yellow book", (-2.18, 4.10, 1.49)),
    ("red book, top", (-1.79, 4.10, 1.45)),
    ("green book, top", (-1.37, 4.14, 1.45), None, (-2.09, 4.17, 1.02)),
    ("purple book", (-2.18, 4.10, 1.06)),
    ("white book", (-1.76, 4.10, 1.05)),
    ("blue book", (-1.54, 4.17, 1.04), None, (-1.93, 4.10, 1.55)),
    ("gray book", (-2.00, 4.18, 0.63)),
    ("orange book", (-1.61, 4.10, 0.61), None, (-1.85, 4.10, 0.21)),
    ("yellow book, low", (-1.41, 4.14, 0.24), None, (-2.18, 4.10, 1.49)),
    ("hair", (-0.48, 2.71, 1.75)),
    ("face", (-0.52, 2.65, 1.70)),
    ("shirt", (-0.52, 2.64, 1.23)),
    ("left sleeve", (-0.79, 2.69, 1.28)),
    ("right sleeve", (-0.27, 2.70, 1.26)),
    ("left forearm", (-0.80, 2.63, 1.03)),
    ("right forearm", (-0.26, 2.61, 1.01)),
    ("belt", (-0.52, 2.64, 0.97)),
    ("jeans, hip", (-0.53, 2.65, 0.89)),
    ("left shin", (-0.66, 2.69, 0.22)),
    ("right shin", (-0.42, 2.69, 0.20)),
    ("left shoe", (-0.66, 2.60, 0.08)),
    ("right shoe", (-0.40, 2.61, 0.07)),
    ("rug, front", (0.21, 2.73, 0.01)),
    ("rug, left", (-0.91, 2.96, 0.01)),
    ("rug, right", (1.02, 2.45, 0.01)),
    ("rug border, left", (-1.09, 2.72, 0.01)),
    ("floor, left", (-1.53, 2.37, 0.00)),
    ("floor, middle", (-0.27, 4.13, 0.00)),
    ("floor, right", (1.90, 3.28, 0.00), None, (-1.53, 2.37, 0.00)),
    ("skirting", (-0.45, 4.38, 0.04)),
    ("ball of wool", (-1.31, 2.68, 0.11)),
    ("parcel", (-1.83, 2.85, 0.21)),
    ("basket", (1.73, 2.46, 0.15), None, (-1.83, 2.85, 0.21)),
    ("pocket", (0.09, 3.70, 0.15)),
    ("backpack", (0.19, 3.79, 0.31)),
    ("pot", (-1.09, 3.85, 0.17), (176, 88, 52)),
    ("leaves", (-1.12, 3.98, 0.82), (70, 125, 50)),
    ("table, front edge", (0.27, 2.64, 0.73)),
    ("table leg, left", (-0.02, 2.67, 0.31)),
    ("table leg, right", (1.11, 2.67, 0.28)),
    ("keyboard", (0.37, 2.98, 0.76)),
    ("purple book on the table", (0.07, 2.75, 0.83)),
    ("bowl", (0.88, 2.91, 0.81)),
    ("apple, red", (1.00, 3.01, 0.85)),
    ("orange", (0.88, 2.98, 0.83)),
    ("near chair, back", (0.61, 2.43, 0.77)),
    ("near chair, seat", (0.61, 2.19, 0.47)),
    ("near chair, leg", (0.45, 2.44, 0.67)),
    ("far chair, back", (1.24, 3.10, 0.83)),
    ("far chair, seat", (1.43, 3.02, 0.47)),
    ("picture frame", (0.08, 4.38, 1.65)),
    ("picture, sky", (0.67, 4.38, 1.78)),
    ("picture, sand", (0.80, 4.38, 1.57)),
    ("picture, meadow", (0.46, 4.38, 1.43)),
    ("picture, hill", (0.33, 4.38, 1.61)),
    ("door frame", (1.59, 4.35, 1.58)),
)


def main(folder):
    """Write the scene's files into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    pose = np.eye(4)
    pose[:3, 3] = SCANNER
    with shooting.renders.SceneRenders(room.build()) as scene_renders:
        scan, truth = shooting.scanner.simulate_scan(scene_renders.caster(pose), MODEL, name="room", pose=pose)
        photos = {
            f"photo_{degrees}.jpg": scene_renders.photo(
                shooting.camera_off_line(SCANNER, TARGET, degrees, focal_px=610.0), samples=SAMPLES
            )
            for degrees in DEGREES_OFF
        }
    shooting.write_scan(scan, MODEL, folder / "room.scan.json")
    shooting.image_files.write_png(folder / "truth.png", truth)
    shooting.write_photos(photos, folder)
    photo = {"photo_10.jpg": photos["photo_10.jpg"]}
    shooting.write_seeds(shooting.pick_seeds(scan, MODEL, photo, SEEDS), folder / "room.seeds.json")


if __name__ == "__main__":
    shooting.run(main)
