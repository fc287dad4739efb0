"""Make scene 2, a person in a room: the scan, three photos of it, their cameras and the truth.

    python examples/person_room/make.py FOLDER

needs the bpy wheel and the extension's other dependencies (``make setup``). The photos are taken 10, 25 and 45 degrees
beside the scanner's line, each with an exposure, white balance and lens of its own.
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


if __name__ == "__main__":
    shooting.run(main)
