"""The scans with truth, and seeds with true colors on them."""

import os
from pathlib import Path

import numpy as np

from benchmarks import real_scans
from reflcolor_addon.files.images import read_image
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.scan.scan import Scan
from reflcolor_addon.seeds.seeds import Seeds

ROOT = Path(__file__).resolve().parents[2]
SIMULATED = {"cones": "examples/cones"}
# Spinning lidars with the photo of a separate camera.
PAIRS = ("kitti_000008", "nus_back_right", "nus_front", "nus_front_left", "pjlab_ours1", "pjlab_ours3")
NAMES = (*real_scans.NAMES, *PAIRS, *SIMULATED)
# The parameters of "Enhanced" were chosen on the first half.
CHOSEN_ON = ("pumpA", "doria", "bildstein_01", "bildstein_10", "bildstein_20")
OTHERS = tuple(name for name in real_scans.NAMES if name not in CHOSEN_ON)
COUNTS = (500, 100, 30)

# Superpixels are made at no more than this size; their centers need not be better than that.
_SLIC_PIXELS = 400_000
# Enough to follow edges, and not so little that noisy reflectance falls into crumbs.
_COMPACTNESS = 0.3


def data_dir():
    """The folder of the shared scans: REFLCOLOR_DATA, or ../shared/data."""
    return Path(os.environ.get("REFLCOLOR_DATA") or ROOT.parent / "shared" / "data")


def load(name):
    """Return a scan and where its true color is known, (H, W) bool."""
    if name in SIMULATED:
        from dataclasses import replace

        folder = ROOT / SIMULATED[name]
        (scan,) = read_scans(folder / f"{name}.scan.json")
        scan = replace(scan, color=read_image(folder / "truth.png"))
        return scan, scan.valid
    if name in PAIRS:
        with np.load(data_dir() / "pairs" / name / "scan.npz") as stored:
            arrays = {part: stored[part] for part in ("points", "reflectance", "valid")}
            scan = Scan(name=name, color=stored["truth"], **arrays)
            return scan, stored["known"] & scan.valid
    scan = real_scans.load(name, data_dir())
    return scan, real_scans.has_truth(scan)


def perfect_seeds(scan, known, count):
    """Return seeds with the true color at the pixel nearest each superpixel's center.

    The superpixels are SLIC's, on the reflectance resampled to square pixels; the same scan gives the same seeds.
    """
    import cv2
    from skimage.segmentation import slic

    luminance, _ = normalize(scan.reflectance, scan.valid)
    height, width = scan.shape
    vertical, horizontal = scan.step_deg
    finest = min(vertical, horizontal)
    tall, wide = height * vertical / finest, width * horizontal / finest
    shrink = min(1.0, np.sqrt(_SLIC_PIXELS / (tall * wide)))
    size = max(1, round(wide * shrink)), max(1, round(tall * shrink))
    labels = slic(
        cv2.resize(luminance, size) / 255,
        n_segments=count,
        compactness=_COMPACTNESS,
        mask=cv2.resize(known.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0,
        channel_axis=None,
    )
    places = set()
    for label in range(1, labels.max() + 1):
        rows, cols = np.nonzero(labels == label)
        if rows.size:
            middle = np.argmin((rows - rows.mean()) ** 2 + (cols - cols.mean()) ** 2)
            places.add((int((rows[middle] + 0.5) * height / size[1]), int((cols[middle] + 0.5) * width / size[0])))
    rows, cols = np.transpose(sorted(place for place in places if known[place]))
    return Seeds(rows, cols, scan.color[rows, cols])
