"""What no method that keeps the light of a photo can do better in the simulated scenes.

The truth there is the paint, but photos show it in light and shadow. "light" is the scan in the true light of the
photo, as the simulation renders it from the scanner's own place, with the exposure and white balance of the photo and
its grain evened out; "plain" is plain projection where the photo shows the scan, and that light elsewhere. Of each, and
of ours: the error over the whole scan and where no photo saw it, as ratios to Enhanced; the error where the photo shows
the scan; the step in color across the border of what was seen, as a ratio to the paint's, between neighbors of one
surface and across a jump in range; and the former, in CIELAB, where the paint is the same on both sides.
"""

import subprocess
import sys
from dataclasses import replace

import cv2
import numpy as np

from benchmarks import matching_pairs
from benchmarks.dense_figures import error, projected, steps
from reflcolor_addon import Settings, colorize
from reflcolor_addon.matching import match_photos
from reflcolor_addon.simulation.virtual_camera import VirtualCamera, with_own_look

_DEGREES = (10, 25, 45)
# How the grain of the rendered light is evened out: window, levels and standard deviation in pixels.
_GRAIN_SIZE, _GRAIN_LEVELS, _GRAIN_PX = 9, 8.0, 3.0
_HEAD = f"{'scene':24}{'':8}{'whole':>8}{'seen':>8}{'unseen':>8}{'step':>8}{'jump':>8}{'even':>8}"
# From the scanner's frame (y ahead, z up) to that of a camera that looks ahead (y down, z ahead).
_AHEAD = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])


def bound(scenes, only):
    """Print the figures of all simulated scenes and photos, or of those whose scan's name begins so."""
    print(f"\nbound\n{_HEAD}", flush=True)
    for degrees in _DEGREES:
        for pair in matching_pairs.GROUPS[f"simulated-{degrees}"](scenes):
            if pair.scan.name.startswith(only):
                _printed(pair, _in_light(pair.scan, pair.photos[0].parent, degrees))


def _printed(pair, light):
    scan, truth, known = pair.scan, pair.truth, pair.known
    matching = match_photos(scan, pair.photos, Settings())
    seen = matching.observed.seen
    plain, shown = projected(pair, matching)
    shown &= known
    enhanced = colorize(scan, matching.seeds, Settings.preset("Enhanced")).rgb
    ours = colorize(scan, matching.seeds, Settings.preset("Natural"), matching.observed).rgb
    true_steps, across = steps(truth, seen, scan, known)
    colored = {"light": light, "plain": np.where(shown[..., None], plain, light), "ours": ours}
    for name, rgb in colored.items():
        own, own_across = steps(rgb, seen, scan, known)
        figures = (
            error(rgb, truth, known) / error(enhanced, truth, known),
            error(rgb, truth, shown),
            error(rgb, truth, known & ~seen) / error(enhanced, truth, known & ~seen),
            own.mean() / true_steps.mean(),
            own_across.mean() / across.mean(),
            own[true_steps == 0].mean(),
        )
        print(f"{pair.label:24}{name:8}" + "".join(f"{value:8.2f}" for value in figures), flush=True)
    print(
        f"{'':24}border: {len(true_steps)} pairs of one surface, step of the paint {true_steps.mean():.2f}, none in "
        f"{(true_steps == 0).mean():.0%}; {len(across)} pairs across a jump in range, {across.mean():.1f}",
        flush=True,
    )


def _in_light(scan, folder, degrees):
    """(H, W, 3) uint8: what the scanner sees in the light, exposure and white balance of a photo."""
    path = folder / "light.npz"
    if not path.is_file():
        subprocess.run([sys.executable, "-m", "benchmarks.lit_scenes", folder.name, str(folder)], check=True)
    with np.load(path) as kept:
        light, focal = kept["light"], float(kept["focal_px"])
    camera = VirtualCamera(width=light.shape[1], height=light.shape[0], focal_px=focal, pose=_AHEAD)
    xy = (camera.project(scan.points)[0] - 0.5).astype(np.float32)
    here = cv2.remap(light, np.nan_to_num(xy, nan=-1), None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    lit = replace(with_own_look(camera, degrees), noise=0.0).develop(here).astype(np.float32)
    for _ in range(2):
        lit = cv2.bilateralFilter(lit, _GRAIN_SIZE, _GRAIN_LEVELS, _GRAIN_PX)
    return np.rint(lit).astype(np.uint8)
