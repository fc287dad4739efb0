"""Photos placed by six pairs picked by hand, with two pixels of noise: python -m benchmarks.hand_pairs

For every scan whose photo's camera is known (benchmarks.true_cameras), six pixels spread over what the photo shows are
picked, five times. How far the camera is off in the median of all that the photo shows, in pixels of the photo, is
printed for the pairs alone, for the camera that matching found, and for the one that colors come from in the end, in
the median of the five; and in how many of the five the photo was verified beside the pairs.
"""

import argparse

import numpy as np

from benchmarks import true_cameras
from reflcolor_addon import Seeds
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration import location
from reflcolor_addon.matching.registration.alignment import Alignment
from reflcolor_addon.matching.registration.pairs import camera_from_pairs
from reflcolor_addon.matching.registration.registration import ScanViews

_PAIRS, _NOISE = 6, 2.0


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=5)
    parser.add_argument("scans", nargs="*", help="parts of names: only these")
    arguments = parser.parse_args()
    draws = arguments.draws
    print(f"{'scan, photo':18} pairs alone   found  at last  ratio  verified")
    for known in true_cameras.every():
        if arguments.scans and not any(name in known.label for name in arguments.scans):
            continue
        photo, views = PhotoImage("photo", known.photo), ScanViews(known.scan)
        off = []
        for draw in range(draws):
            rows, cols, xy = picked(known, np.random.default_rng(draw))
            hand = Seeds(rows, cols, np.zeros((_PAIRS, 3), np.uint8), photos=("photo",) * _PAIRS, photo_xy=xy)
            alone = camera_from_pairs(known.scan.points[rows, cols], xy, photo)[0]
            placed = location._by_hand(known.scan, views, hand, photo, lambda text: None)
            if alone is None or not placed.verified:
                continue
            found = placed.registration.model
            last = found if views.stretched else Alignment(known.scan).aligned(photo, found)
            off.append((*(distance(known, camera) for camera in (alone, found, last)), placed.registration.accepted))
        *distances, sure = np.array(off).T
        alone, found, last = (float(np.median(one)) for one in distances)
        figures = f"{alone:11.1f} {found:7.1f} {last:7.1f} {last / alone:6.2f}"
        print(f"{known.label:18} {figures}  {int(sure.sum())} of {draws}", flush=True)


def picked(known, rng):
    """Rows, columns (6,) and places (6, 2) in the photo: far from each other, of what it shows, with noise."""
    rows, cols = np.nonzero(known.scan.valid & known.known)
    xy, shown = known.project(known.scan.points[rows, cols])
    rows, cols, xy = rows[shown], cols[shown], xy[shown]
    chosen = [int(rng.integers(len(rows)))]
    while len(chosen) < _PAIRS:
        # The farthest of a few at random: spread, but not all at the border.
        some = rng.choice(len(rows), 12)
        apart = np.linalg.norm(xy[some, None] - xy[chosen], axis=2).min(axis=1)
        chosen.append(int(some[apart.argmax()]))
    return rows[chosen], cols[chosen], xy[chosen] + rng.normal(0, _NOISE, (_PAIRS, 2))


def distance(known, camera):
    """The median distance in pixels between where the camera sees what the photo shows, and where that truly is."""
    points = known.scan.points[known.scan.valid & known.known]
    xy, shown = known.project(points)
    return float(np.nanmedian(np.linalg.norm(camera.project(points[shown])[0] - xy[shown], axis=1)))


if __name__ == "__main__":
    main()
