"""How close wrong photos come to be verified, in simulated rooms and on real scans: python -m benchmarks.wrong_rooms

Photos of one room are matched with scans of others, in rooms as benchmarks.archive paints them (--paint). Beside them
stand the photographs of other things and places that benchmarks.trust tried on real scans, most of them with holes. Of
each kind the evidence is printed (1 is needed to be verified): the share of the pairs with at least so much, and the
most. Rooms in which wrong photos come closer than on real scans are harder than what they stand for.
"""

import argparse

import numpy as np

from benchmarks import trust
from benchmarks.rooms import PAINTS, Room
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews, register

_BARS = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
_PHOTOS_OF_A_SCAN = 4


def main():
    """Print a row for each kind."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=80, help="how many, in rooms of each kind")
    parser.add_argument("--paint", choices=PAINTS, action="append", help="only rooms painted so")
    arguments = parser.parse_args()
    print(f"{'wrong pairs of':22} {'pairs':>6}" + "".join(f"  >={bar:.1f}" for bar in _BARS) + "   most")
    for paint in arguments.paint or PAINTS:
        row(f"rooms in {paint}", in_rooms(arguments.pairs, paint))
    tries = trust.counted()
    row("real scans and photos", [try_["evidence"] for try_ in tries if try_["kind"] in ("foreign", "elsewhere")])


def in_rooms(count, paint):
    """The evidence of so many photos of one room on scans of others; rooms that no archive has."""
    evidence = []
    for number in range(-(-count // _PHOTOS_OF_A_SCAN)):
        views = ScanViews(Room(10_000 + number, paint).scan())
        for photo in range(min(_PHOTOS_OF_A_SCAN, count - len(evidence))):
            rgb = Room(20_000 + _PHOTOS_OF_A_SCAN * number + photo, paint).photo(photo, 240, 180)
            evidence.append(register(views, PhotoImage("photo", rgb)).evidence.share)
    return evidence


def row(kind, evidence):
    """Print one row of the table."""
    evidence = np.array(evidence)
    shares = "".join(f"{np.mean(evidence >= bar):7.1%}" for bar in _BARS)
    print(f"{kind:22} {len(evidence):6d}{shares}   {evidence.max():.2f}", flush=True)


if __name__ == "__main__":
    main()
