"""From a scene to files: the scan, the photos, seeds as a person would pick them, and the truth."""

import json
import os
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from .extension import module

atomic = module("reflcolor_addon.atomic")
image_files = module("reflcolor_addon.image_files")
cameras = module("reflcolor_addon.virtual_camera")
renders = module("operators.scene_renders")
scanner = module("reflcolor_addon.virtual_scanner")
writers = module("reflcolor_addon.writers")

# How far a photo's surface may lie before or behind a scan point that it still shows.
_SAME_SURFACE_M = 0.02
_JPEG_QUALITY = 90
_LARGEST_DEPTH_M = 65.0
_WRITTEN = (".json", ".png", ".jpg", ".e57")


@dataclass(frozen=True, eq=False)
class Photo:
    """A photo, the camera that took it, and how deep the scene is in it."""

    name: str
    camera: object
    image: np.ndarray
    depth: np.ndarray

    def shows(self, points_world):
        """Where in the photo points (..., 3) are: xy (..., 2) in pixels, NaN where they are outside or hidden."""
        xy, depth = self.camera.project(points_world)
        inside = (xy >= 0).all(axis=-1) & (xy < [self.camera.width, self.camera.height]).all(axis=-1)
        x, y = np.moveaxis(np.where(inside[..., None], xy, 0).astype(int), -1, 0)
        seen = inside & (np.abs(self.depth[y, x] - depth) < _SAME_SURFACE_M)
        return np.where(seen[..., None], xy, np.nan)


def shoot(scene_renders, name, camera, *, samples):
    """Take a `Photo` of the scene that `scene_renders` draws."""
    margin = camera.margin_px()
    light, depth = scene_renders.light(camera, samples=samples, margin=margin)
    bent = camera.distort(np.dstack([light, depth]), margin)
    return Photo(name, camera, camera.develop(bent[..., :3]), bent[..., 3])


def write_photo(photo, folder):
    """Write the photo as JPEG."""
    _done, data = cv2.imencode(".jpg", photo.image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    with atomic.written_atomically(folder / photo.name) as temporary:
        temporary.write_bytes(data.tobytes())


def write_scan(scan, model, path):
    """Write the scan as image pair."""
    writers.write_image_pair(scan, path, azimuth_deg=model.azimuth_deg, elevation_deg=model.elevation_deg)


def pick_seeds(scan, model, photos, targets):
    """Pick seeds as a person would: a place in the scene, found in the scan and, if a photo shows it, in the photo.

    Parameters
    ----------
    scan : Scan
    model : ScannerModel
    photos : sequence of Photo
        The first that shows a place gives the color.
    targets : sequence of (what, (x, y, z), rgb or None)
        ``rgb`` is the color to type in instead of a point of a photo.

    Returns
    -------
    list of dict
        Entries of a seeds file.
    """
    return [_seed(scan, model, photos, *target) for target in targets]


def write_seeds(entries, path):
    """Write entries of `pick_seeds` as a seeds file."""
    lines = ",\n".join(f"  {json.dumps(entry)}" for entry in entries)
    with atomic.written_atomically(path) as temporary:
        text = f'{{"format": "reflcolor-seeds", "version": 1, "seeds": [\n{lines}\n]}}\n'
        temporary.write_text(text, encoding="utf-8")


def _seed(scan, model, photos, what, place, rgb):
    local = np.linalg.inv(scan.pose) @ [*place, 1]
    azimuth = np.degrees(np.arctan2(local[0], local[1]))
    elevation = np.degrees(np.arctan2(local[2], np.hypot(local[0], local[1])))
    vertical, horizontal = model.step_deg
    row = int((model.elevation_deg[1] - elevation) / vertical)
    col = int((azimuth - model.azimuth_deg[0]) % 360 / horizontal)
    point = scan.points[row, col]
    if not scan.valid[row, col] or np.linalg.norm(point - local[:3]) > 0.08:
        raise ValueError(f"{what}: the scanner does not see {place}, but {scan.pose[:3] @ [*point, 1]}")
    if rgb is not None:
        return {"row": row, "col": col, "rgb": list(rgb)}
    for photo in photos:
        x, y = photo.shows(scan.pose[:3] @ [*point, 1])
        if np.isfinite(x):
            return {"row": row, "col": col, "photo": photo.name, "x": round(float(x), 1), "y": round(float(y), 1)}
    raise ValueError(f"{what}: no photo shows {place}; give its rgb")


def camera_off_line(scanner_position, target, degrees_off, *, focal_px, size=(1000, 750), nearness=1.0, rise_m=0.15):
    """Return a `VirtualCamera` that looks at the target from so many degrees beside the scanner's line to it.

    Its exposure, white balance, lens distortion and noise are its own, by the angle.
    """
    position, target = np.asarray(scanner_position, np.float64), np.asarray(target, np.float64)
    turn = np.radians(degrees_off)
    away = position - target
    turned = [away[0] * np.cos(turn) - away[1] * np.sin(turn), away[0] * np.sin(turn) + away[1] * np.cos(turn), away[2]]
    place = target + np.multiply(turned, nearness) + [0, 0, rise_m]
    hands = np.random.RandomState(abs(round(degrees_off)))
    return cameras.VirtualCamera(
        width=size[0],
        height=size[1],
        focal_px=focal_px,
        pose=cameras.look_at(place, target),
        distortion=(float(hands.uniform(-0.10, 0.04)), float(hands.uniform(0.0, 0.02))),
        exposure_stops=float(hands.uniform(-0.35, 0.25)),
        white_balance=(float(hands.uniform(0.94, 1.10)), 1.0, float(hands.uniform(0.86, 1.06))),
        noise=0.012,
        seed=abs(round(degrees_off)),
    )


def write_cameras(photos, path):
    """Write exactly where each photo was taken from, and beside each photo its depth in millimetres as 16-bit PNG."""
    document = {photo.name: photo.camera.as_dict() for photo in photos}
    with atomic.written_atomically(path) as temporary:
        temporary.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    for photo in photos:
        depth = np.where(photo.depth < _LARGEST_DEPTH_M, photo.depth * 1000, 0)
        image_files.write_png(
            path.parent / f"{photo.name.rsplit('.', 1)[0]}.depth.png", np.round(depth).astype(np.uint16)
        )


def run(main, folder=None):
    """Run a script's ``main(folder)`` with the folder of the command line or this one, list what is there, and end."""
    if len(sys.argv) > 2 or (len(sys.argv) < 2 and folder is None) or sys.argv[1:] in (["-h"], ["--help"]):
        print(f"usage: python {sys.argv[0]} FOLDER", file=sys.stderr)
        sys.exit(2)
    folder = Path(sys.argv[1]) if len(sys.argv) == 2 else folder
    with _blender_silent():
        main(folder)
    for path in sorted(folder.iterdir()):
        if path.suffix in _WRITTEN:
            print(f"{path.stat().st_size:9d}  {path}")
    sys.stdout.flush()
    # Some versions of bpy hang when they end.
    os._exit(0)


@contextmanager
def _blender_silent():
    """Keep Blender's own lines about every render off the terminal."""
    kept = os.dup(1)
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
