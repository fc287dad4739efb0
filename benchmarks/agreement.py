"""What photos of one real scan, and real scans behind one photo, have in common: python -m benchmarks.agreement

A batch believes photos on one scan only if they are bright and dark in the same places of it, and scans behind one
photo are of one place if they measured the same reflectance there (reflcolor_addon/batch/archive/places.py). Two views
of bildstein are matched with each other's photos, straight, and warped and tinted. For each two the correlation is
printed, and whether the matching verified both; a dash where they have too little in common.
"""

from dataclasses import replace
from itertools import combinations

import numpy as np

from benchmarks import real_scans
from benchmarks.matching_pairs import DATA, warped_photo
from reflcolor_addon.batch.archive.places import agreement, brightness_seen, reflectance_seen
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews, register

VIEWS = ("bildstein_20", "bildstein_25")
_LAMP, _CAMERA = (1.08, 1.0, 0.8), (1.02, 1.0, 0.95)


def main():
    """Match every photo with both scans; compare what they show."""
    loaded = {name: real_scans.load(name, DATA) for name in VIEWS}
    photos = {name: scan.color for name, scan in loaded.items()}
    photos |= {
        f"{name}, warped": warped_photo(scan.color, light)
        for (name, scan), light in zip(loaded.items(), (_LAMP, _CAMERA), strict=True)
    }
    scans = {name: replace(scan, color=None) for name, scan in loaded.items()}
    bright, reflective, verified = {}, {}, set()
    for name, scan in scans.items():
        views = ScanViews(scan)
        for label, rgb in photos.items():
            photo = PhotoImage(label, np.ascontiguousarray(rgb))
            found = register(views, photo)
            if found.model is not None:
                bright[name, label] = brightness_seen(scan, found.model, photo)
                reflective[name, label] = reflectance_seen(scan, found.model)
            if found.accepted:
                verified.add((name, label))
    for name in scans:
        for one, other in combinations(photos, 2):
            _print(f"on {name}: {one} and {other}", bright, verified, (name, one), (name, other))
    for label in photos:
        one, other = scans
        _print(f"behind {label}: {one} and {other}", reflective, verified, (one, label), (other, label))


def _print(what, seen, verified, one, other):
    found = agreement(seen.get(one), seen.get(other))
    said = "both verified" if {one, other} <= verified else "not both verified"
    print(f"{what}: {'-' if found is None else f'{found:.2f}'} ({said})", flush=True)


if __name__ == "__main__":
    main()
