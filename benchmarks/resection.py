"""How well photos are placed by others that overlap them: python -m benchmarks.resection [SEED ...] [--real]

With --real, on a real scan: on each of the six views of bildstein the neighboring views (pictures turned by 30 degrees)
are placed by the view's own picture alone. All were taken from the scanner's place, with a focal length of 312 pixels:
printed is how far off the place and the focal length are.

On each scan of a simulated archive (benchmarks/archive.py) its photos are matched, each by itself. Then each is placed
by every other one that overlaps it and was verified beyond doubt. Printed for each archive, and together:

- how many were verified by themselves, and how many by others; off by more than 5 % of the photo's width, how many;
- how many were verified by others with a wrong camera: these are wrong, too;
- the same for those pairs of photos that do not overlap by `overlaps.agreement`, but have enough in common;
- wrong models: photos of other rooms are fitted to a scan as well as can be, and other photos of their rooms are placed
  by these, verified or not: how many of these are verified. None should be.
"""

import argparse
import sys
from itertools import permutations
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from benchmarks import real_scans
from benchmarks.archive import MOST_OFF, make, off_by, place_of, processor_time, rooms_of
from benchmarks.matching_pairs import DATA
from benchmarks.rooms import Room
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.matching.opened_photos import opened_photos
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews, register
from reflcolor_addon.matching.registration.resection import overlapping, placed_by

_SCANS, _PHOTOS, _WRONG_ON_A_SCAN = 30, 40, 1
# Across each view of the real scan.
_VIEW_DEG = 60


def main():
    """Measure archives, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seeds", type=int, nargs="*")
    parser.add_argument("--real", action="store_true", help="measure the real scan, too")
    arguments = parser.parse_args()
    if arguments.real:
        _measure_real_scan()
    every = [_Archive(seed).measured() for seed in arguments.seeds]
    if len(every) > 1:
        print("together")
        _print({name: [entry for own in every for entry in own[name]] for name in every[0]})


def _measure_real_scan():
    scans = [real_scans.load(name, DATA) for name in real_scans.NAMES if name.startswith("bildstein")]
    focal, placed, count = scans[0].shape[1] / 2 / np.tan(np.radians(_VIEW_DEG / 2)), [], 0
    for number, scan in enumerate(scans):
        views, own = ScanViews(scan), PhotoImage("own picture", scan.color)
        model = register(views, own).model
        for other in (number - 1, number + 1):
            if 0 <= other < len(scans):
                count += 1
                found = placed_by(views, PhotoImage("neighbor", scans[other].color), [(own, model)])
                if found is not None:
                    placed.append((np.linalg.norm(found.model.center), abs(found.model.focal_px / focal - 1)))
    away, zoomed = np.max(placed, axis=0)
    print(f"bildstein: {len(placed)} of {count} neighboring views placed, {away:.2f} m or less from where they were")
    print(f"  taken (things are 3 to 85 m away), and with a focal length off by {zoomed:.1%} or less")


class _Archive:
    def __init__(self, seed):
        self._folder = Path(mkdtemp(prefix="resection-"))
        self._right = make(self._folder, _SCANS, _PHOTOS, seed)
        self._rooms, self._shown = rooms_of(_SCANS, _PHOTOS, seed)
        self._seed, self._rng = seed, np.random.default_rng((seed, 9))
        self._found = {"alone": [], "by others": [], "apart": [], "astray": [], "wrong": []}

    def measured(self):
        for number in range(_SCANS):
            (scan,) = read_scans(self._folder / f"scan_{number:02d}.ptx")
            views = ScanViews(scan)
            self._of_its_room(number, views)
            self._of_other_rooms(number, views)
            print(f"archive {self._seed}, scan {number}", file=sys.stderr, flush=True)
        print(f"archive {self._seed}")
        _print(self._found)
        return self._found

    def _of_its_room(self, number, views):
        photos = {photo: self._photo(photo) for scan, photo in sorted(self._right) if scan == number}
        alone = {photo: register(views, image) for photo, image in photos.items()}
        away = {photo: self._off(number, views.scan, photo, own) for photo, own in alone.items() if own.accepted}
        self._found["alone"] += [away.get(photo) for photo in photos]
        for photo, other in permutations(photos, 2):
            if not alone[other].beyond_doubt:
                continue
            near = overlapping(photos[photo], [photos[other]])
            before = processor_time()
            found = placed_by(views, photos[photo], [(photos[other], alone[other].model)])
            entry = None if found is None else self._off(number, views.scan, photo, found)
            seconds = processor_time() - before
            if away[other] > MOST_OFF:
                self._found["astray"].append((near != [], entry))
            else:
                self._found["by others" if near else "apart"].append((photo in away, entry, seconds))

    def _of_other_rooms(self, number, views):
        chosen = [photo for photo in range(_PHOTOS) if (number, photo) not in self._right]
        for photo in self._rng.choice(chosen, _WRONG_ON_A_SCAN, replace=False):
            others = [other for other in chosen if other != photo and self._shown[other] == self._shown[photo]]
            image = self._photo(photo)
            near = [other for other in others if overlapping(self._photo(other), [image])]
            if near and (wrong := register(views, image)).model is not None:
                for other in near:
                    found = placed_by(views, self._photo(other), [(image, wrong.model)])
                    self._found["wrong"].append((wrong.accepted, found is not None))

    def _photo(self, number):
        return opened_photos([self._folder / f"photo_{number:02d}.png"])[0]

    def _off(self, number, scan, photo, registration):
        return off_by(scan, registration.model, Room(self._shown[photo]), photo, place_of(number, _SCANS))


def _print(found):
    alone = [away for away in found["alone"] if away is not None]
    print(f"  pairs of a scan and a photo of its room: {len(found['alone'])}")
    print(f"  verified by itself: {len(alone)}, {sum(away > MOST_OFF for away in alone)} of them with a wrong camera")
    for name, said in (("by others", "placed by another that overlaps"), ("apart", "placed by another that does not")):
        for verified, which in ((False, "not verified by itself"), (True, "verified by itself")):
            own = [(away, seconds) for before, away, seconds in found[name] if before == verified]
            placed = [away for away, _ in own if away is not None]
            wrong, seconds = sum(away > MOST_OFF for away in placed), np.mean([seconds for _, seconds in own] or [0])
            print(f"  {which}, {said}: {len(placed)} of {len(own)}, {wrong} wrong, {seconds:.1f} s each")
    for near, which in ((True, "that overlaps"), (False, "that does not overlap")):
        own = [away for overlaps, away in found["astray"] if overlaps == near]
        placed = [away for away in own if away is not None]
        wrong = sum(away > MOST_OFF for away in placed)
        print(f"  placed by another {which}, with a wrong camera: {len(placed)} of {len(own)}, {wrong} wrong")
    for accepted, which in ((False, "refused"), (True, "verified")):
        own = [placed for before, placed in found["wrong"] if before == accepted]
        print(f"  by a photo of another room that was {which} here: {sum(own)} of {len(own)}")


if __name__ == "__main__":
    main()
