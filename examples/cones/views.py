"""Take more photos of the two road cones: the same scan, and photos 10, 25 and 45 degrees beside its line.

    python examples/cones/views.py FOLDER

needs the bpy wheel and the extension's other dependencies (``make setup``). Each photo has an exposure, white balance
and lens of its own; ``cameras.json`` says exactly where it was taken from.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from examples.cones import scene as cones  # noqa: E402
from examples.cones.make import MODEL, POSE  # noqa: E402
from examples.scenes import shooting  # noqa: E402

SAMPLES = 20
TARGET = (-0.05, 3.0, 0.65)
DEGREES_OFF = (10, 25, 45)


def main(folder):
    """Write scan, photos, cameras and truth into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    with shooting.renders.SceneRenders(cones.build()) as scene_renders:
        scan, truth = shooting.scanner.simulate_scan(scene_renders.caster(POSE), MODEL, name="cones", pose=POSE)
        photos = {
            f"photo_{degrees}.jpg": scene_renders.photo(
                shooting.camera_off_line(POSE[:3, 3], TARGET, degrees, focal_px=700.0), samples=SAMPLES
            )
            for degrees in DEGREES_OFF
        }
    shooting.write_scan(scan, MODEL, folder / "cones.scan.json")
    shooting.image_files.write_png(folder / "truth.png", truth)
    shooting.write_photos(photos, folder)


if __name__ == "__main__":
    shooting.run(main)
