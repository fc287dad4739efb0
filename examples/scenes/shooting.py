"""From a scene to files: the scan, the photos, seeds as a person would pick them, and the truth."""

import json
import os
import sys
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np

from .extension import module

atomic = module("reflcolor_addon.files.atomic")
image_files = module("reflcolor_addon.files.images")
cameras = module("reflcolor_addon.simulation.virtual_camera")
renders = module("operators.scene.scene_renders")
scanner = module("reflcolor_addon.simulation.virtual_scanner")
writers = module("reflcolor_addon.files.writers")

_JPEG_QUALITY = 90
_LARGEST_DEPTH_M = 65.0
_WRITTEN = (".json", ".png", ".jpg", ".e57")


def write_photo(photo, path):
    """Write the photo as JPEG."""
    _done, data = cv2.imencode(".jpg", photo.image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    with atomic.written_atomically(path) as temporary:
        temporary.write_bytes(data.tobytes())


def write_scan(scan, model, path):
    """Write the scan as image pair."""
    writers.write_image_pair(scan, path, azimuth_deg=model.azimuth_deg, elevation_deg=model.elevation_deg)


def pick_seeds(scan, model, photos, targets, *, leave_out=False):
    """Pick seeds as a person would: a place in the scene, found in the scan and, if a photo shows it, in the photo.

    Parameters
    ----------
    scan : Scan
    model : ScannerModel
    photos : dict of str to Photo
        The first that shows a place, or the other place of its color, gives the color.
    targets : sequence of (what, (x, y, z)[, rgb or None[, (x, y, z)]])
        ``rgb`` is the color to type in instead of a point of a photo; the last is another place of that color, for
        where no photo shows the first.
    leave_out : bool
        Pick nothing for a target that no photo shows; else that is an error.

    Returns
    -------
    list of dict
        Entries of a seeds file.
    """
    entries = [_seed(scan, model, photos, *target) for target in targets]
    unseen = [target[0] for target, entry in zip(targets, entries, strict=True) if entry is None]
    if unseen and not leave_out:
        raise ValueError(f"no photo shows these, nor what is like them; give their rgb: {', '.join(unseen)}")
    return [entry for entry in entries if entry is not None]


def write_seeds(entries, path):
    """Write entries of `pick_seeds` as a seeds file."""
    lines = ",\n".join(f"  {json.dumps(entry)}" for entry in entries)
    with atomic.written_atomically(path) as temporary:
        text = f'{{"format": "reflcolor-seeds", "version": 1, "seeds": [\n{lines}\n]}}\n'
        temporary.write_text(text, encoding="utf-8")


def _seed(scan, model, photos, what, place, rgb=None, like=None):
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
    places = [scan.pose[:3] @ [*point, 1]] + ([] if like is None else [np.asarray(like)])
    for name, photo in photos.items():
        for x, y in map(photo.shows, places):
            if np.isfinite(x):
                return {"row": row, "col": col, "photo": name, "x": round(float(x), 1), "y": round(float(y), 1)}
    return None


def camera_off_line(scanner_position, target, degrees_off, *, focal_px, size=(800, 600), nearness=1.0, rise_m=0.15):
    """Return a `VirtualCamera` that looks at the target from so many degrees beside the scanner's line to it.

    Its exposure, white balance, lens distortion and noise are its own, by the angle.
    """
    position, target = np.asarray(scanner_position, np.float64), np.asarray(target, np.float64)
    turn = np.radians(degrees_off)
    away = position - target
    turned = [away[0] * np.cos(turn) - away[1] * np.sin(turn), away[0] * np.sin(turn) + away[1] * np.cos(turn), away[2]]
    place = target + np.multiply(turned, nearness) + [0, 0, rise_m]
    pose = cameras.look_at(place, target)
    plain = cameras.VirtualCamera(width=size[0], height=size[1], focal_px=focal_px, pose=pose)
    return cameras.with_own_look(plain, abs(round(degrees_off)))


def write_photos(photos, folder):
    """Write photos, by their names, and all that is true of them.

    Beside each photo its depth in millimeters as 16-bit PNG; ``cameras.json`` says where exactly it was taken from.
    """
    for name, photo in photos.items():
        write_photo(photo, folder / name)
        depth = np.where(photo.depth < _LARGEST_DEPTH_M, photo.depth, 0) * 1000
        image_files.write_png((folder / name).with_suffix(".depth.png"), np.round(depth).astype(np.uint16))
    document = {name: photo.camera.as_dict() for name, photo in photos.items()}
    with atomic.written_atomically(folder / "cameras.json") as temporary:
        temporary.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


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
    with Path(os.devnull).open("wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
