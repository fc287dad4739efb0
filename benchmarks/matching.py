"""How well seeds are found in photos, as published and verified: python -m benchmarks.matching

For every pair of a scan and a photo: the mean CIEDE2000 of color alone, painted in the photo's mean color, colorized
from the seeds found, and from perfect seeds at the same places; and the gap closed, which is what of the way from the
first to the last was gone. 1 is as good as perfect seeds, 0 as the mean color, below 0 is worse than that.

    python -m benchmarks.matching                 the real scans
    python -m benchmarks.matching --only NAME     one group: straight, warped, turned, k4a, pumpA
    python -m benchmarks.matching --views FOLDER  simulated scans and photos, as examples/*/views.py write them
    python -m benchmarks.matching --unrelated     every scan against every photo of something else: none may be verified
"""

import argparse
import itertools
import os
import time
from pathlib import Path

import cv2
import numpy as np

from benchmarks import real_scans
from reflcolor_addon import Seeds, Settings, colorize, evaluate, read_scans
from reflcolor_addon.image_files import read_image
from reflcolor_addon.matching import match_photos

DATA = Path(os.environ.get("REFLCOLOR_DATA") or "../shared/data")
MODES = ("paper", "verified")
BILDSTEIN = ("01", "05", "10", "15", "20", "25")
STRAIGHT = ("doria", *(f"bildstein_{view}" for view in BILDSTEIN), "pumpA", "k4a")
GROUPS = ("straight", "warped", "turned", "k4a", "pumpA")


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=GROUPS, action="append", help="only this group; else all")
    parser.add_argument("--views", type=Path, action="append", default=[])
    parser.add_argument("--unrelated", action="store_true")
    parser.add_argument("--mode", choices=MODES, action="append", help="only this one; else both")
    arguments = parser.parse_args()
    if arguments.unrelated:
        unrelated()
        return
    modes = arguments.mode or MODES
    print(f"{'scan':14} {'photo':24} {'mode':9}   mean  result  perfect     gap  seconds  note")
    for folder in arguments.views:
        views(folder, modes)
    if arguments.only or not arguments.views:
        for group in arguments.only or GROUPS:
            real(group, modes)


def real(group, modes):
    """Print the pairs of one group of the real scans, and their mean."""
    gaps = {mode: [] for mode in modes}
    for name, label, photo in pairs(group):
        scan = real_scans.load(name, DATA)
        for mode in modes:
            gaps[mode].append(printed(scan, photo, label, mode, scan.color, real_scans.has_truth(scan)))
    for mode, values in gaps.items():
        print(f"{group}: {mode}: mean {np.mean(values):.3f}, least {min(values):.3f}", flush=True)


def pairs(group):
    """Yield scan name, label and photo of a group."""
    if group in ("straight", "warped"):
        for name in STRAIGHT:
            color = real_scans.load(name, DATA).color
            yield name, f"own, {group}", color if group == "straight" else warped(color)
    elif group == "turned":
        neighbors = list(itertools.pairwise(BILDSTEIN))
        for own, other in [*neighbors, *(pair[::-1] for pair in neighbors)]:
            yield f"bildstein_{own}", f"view {other}", real_scans.load(f"bildstein_{other}", DATA).color
    elif group == "k4a":
        yield "k4a", "color_1280x720.jpg", DATA / "k4a_mug/color_1280x720.jpg"
    else:
        yield "pumpA", "pumpA_photo.jpg", DATA / "pumpA/pumpA_photo.jpg"


def warped(color):
    """Return a photo's own colors warped strongly, twice as large, darker and warmer, JPEG of quality 80."""
    height, width = color.shape[:2]
    corners = np.float32([[0, 0], [width, 0], [width, height], [0, height]])
    moved = np.float32([[0.12, 0.06], [0.93, 0.0], [1.0, 0.95], [0.0, 0.86]]) * np.float32([width, height]) * 2
    large = cv2.warpPerspective(
        color, cv2.getPerspectiveTransform(corners, moved), (2 * width, 2 * height), flags=cv2.INTER_CUBIC
    )
    lit = np.clip((large / 255.0) ** 1.1 * np.array([1.08, 0.95, 0.8]) * 255, 0, 255).astype(np.uint8)
    data = cv2.imencode(".jpg", lit[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 80])[1]
    return cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1].copy()


def views(folder, modes):
    """Print the photos of a folder of simulated views: one scan, its truth, photos."""
    (path,) = folder.glob("*.scan.json")
    (scan,) = read_scans(path)
    truth = read_image(folder / "truth.png")
    photos = sorted(folder.glob("photo*.jpg"))
    for photo in photos:
        for mode in modes:
            printed(scan, photo, photo.name, mode, truth, scan.valid)
    if len(photos) > 1:
        printed(scan, photos, f"all {len(photos)}", "verified", truth, scan.valid)


def printed(scan, photo, label, mode, truth, known):
    """Print one line and return the gap closed."""
    photos = photo if isinstance(photo, list) else [photo]
    started = time.perf_counter()
    matching = match_photos(scan, photos, Settings(matching=mode))
    seconds = time.perf_counter() - started
    seeds = matching.seeds
    perfect = Seeds(rows=seeds.rows, cols=seeds.cols, rgb=truth[seeds.rows, seeds.cols])
    images = [one if isinstance(one, np.ndarray) else read_image(one) for one in photos]
    mean = np.mean([image.reshape(-1, 3).mean(axis=0) for image in images], axis=0)
    painted = np.broadcast_to(np.rint(mean).astype(np.uint8), truth.shape)
    settings = Settings(nearest=8)
    colored = [painted, *(colorize(scan, one, settings).rgb for one in (seeds, perfect))]
    errors = [evaluate(rgb, truth, known)["color_alone"]["ciede2000_mean"] for rgb in colored]
    gap = (errors[0] - errors[1]) / (errors[0] - errors[2])
    notes = "; ".join(report.note for report in matching.photos)
    figures = f"{errors[0]:6.2f} {errors[1]:7.2f} {errors[2]:8.2f} {gap:7.3f} {seconds:8.1f}"
    print(f"{scan.name:14} {label:24} {mode:9} {figures}  {notes}", flush=True)
    return gap


def unrelated():
    """Print what speaks for every scan with every photo of something else."""
    photos = {name: real_scans.load(name, DATA).color for name in real_scans.NAMES}
    photos |= {
        "k4a photo": read_image(DATA / "k4a_mug/color_1280x720.jpg"),
        "pumpA photo": read_image(DATA / "pumpA/pumpA_photo.jpg"),
    }
    accepted = tried = 0
    for name in real_scans.NAMES:
        scan = real_scans.load(name, DATA)
        for other, photo in photos.items():
            if related(name, other):
                continue
            (report,) = match_photos(scan, [photo], Settings()).photos
            tried += 1
            accepted += report.verified
            print(f"{name:14} {other:14} {'ACCEPTED' if report.verified else 'refused':9} {report.note}", flush=True)
    print(f"{accepted} of {tried} unrelated pairs accepted")


def related(name, other):
    """Whether a photo shows anything of a scan: it is of the same place, or turned by at most 30 degrees."""
    if name.startswith("bildstein") and other.startswith("bildstein"):
        return abs(int(name[-2:]) - int(other[-2:])) <= 5
    return name.split("_")[0] == other.split(" ")[0].split("_")[0]


if __name__ == "__main__":
    main()
