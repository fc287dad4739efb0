"""The light of a simulated scene from the scanner's own place: python -m benchmarks.lit_scenes NAME FOLDER

What a perfect method would make of a photo: the light, without noise or distortion, of everything that the scanner
sees, with 1.5 pixels a side for each of the scan's. `benchmarks.dense bound` runs this.
"""

import os
import sys
from importlib import import_module
from pathlib import Path

import numpy as np

from examples.scenes import shooting

_SAMPLES, _FINER = 64, 1.5


def _at(place):
    pose = np.eye(4)
    pose[:3, 3] = place
    return pose


_POSES = {
    "cones": lambda make: make.POSE,
    "person_room": lambda make: _at(make.SCANNER),
    "brick_house": lambda make: make.facing(make.STATIONS["south"], make.TARGET),
}


class Undeveloped(shooting.cameras.VirtualCamera):
    """A camera whose pictures are linear light."""

    def develop(self, light):
        """Return the light itself."""
        return np.asarray(light, np.float32)


def main(name, folder):
    """Write ``light.npz`` into a folder: ``light`` (h, w, 3) float32 and ``focal_px``, looking straight ahead."""
    make, scene = (import_module(f"examples.{name}.{part}") for part in ("make", "scene"))
    camera = ahead(_POSES[name](make), make.MODEL)
    with shooting.renders.SceneRenders(scene.build()) as scene_renders:
        photo = scene_renders.photo(camera, samples=_SAMPLES)
    np.savez_compressed(folder / "light.npz", light=photo.image, focal_px=camera.focal_px)
    # Some versions of bpy hang when they end.
    os._exit(0)


def ahead(pose, model):
    """Return a camera at the scanner's place, level, whose picture holds the whole scan."""
    across, up = (np.radians(np.abs(ends).max()) for ends in (model.azimuth_deg, model.elevation_deg))
    focal = _FINER / np.radians(max(model.step_deg))
    width, height = (2 * int(focal * side) + 8 for side in (np.tan(across), np.tan(up) / np.cos(across)))
    # Its x axis points to the right, y down and z ahead; the scanner's y points ahead and z up.
    axes = pose @ np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])
    return Undeveloped(width=width, height=height, focal_px=focal, pose=axes)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
