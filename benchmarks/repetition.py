"""How often a photo of a room that is painted in squares is verified on another room: python -m benchmarks.repetition

Rooms painted in squares (benchmarks/rooms.py) are matched with photos of their own and of rooms whose walls and floor
have squares of the same sizes: the hardest wrong ones first. What matching verifies is printed, and what it would
verify without asking whether the photo fits elsewhere as well (registration/repetition.py).

Each try is kept in a file; started again, the command goes on where it was. The file has one JSON object a line: pair
(scan|photo), right, and the fields of Evidence.
"""

import argparse
import json
import time
from dataclasses import asdict, replace
from functools import cache
from itertools import chain, zip_longest
from pathlib import Path

import numpy as np

from benchmarks.rooms import Room
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews, register
from reflcolor_addon.matching.registration.verification import Evidence

_ROOMS = 25


def main():
    """Match what is not in the file, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=Path("build/repetition.jsonl"), help="the file of tries")
    parser.add_argument("--minutes", type=float, default=np.inf, help="stop after so long; 0 only prints the table")
    arguments = parser.parse_args()
    ends = time.monotonic() + 60 * arguments.minutes
    arguments.results.parent.mkdir(parents=True, exist_ok=True)
    with arguments.results.open("a+", encoding="utf-8") as file:
        file.seek(0)
        known = {try_["pair"]: try_ for try_ in map(json.loads, file)}
        for scan, photo in pairs():
            name = f"{scan}|{photo}"
            if time.monotonic() >= ends:
                break
            if name not in known:
                found = register(views(scan), PhotoImage(name, Room(photo).photo(photo)))
                known[name] = {"pair": name, "right": scan == photo, **asdict(found.evidence)}
                file.write(json.dumps(known[name]) + "\n")
                file.flush()
    table(known.values())


def pairs():
    """Return pairs of a scanned and a photographed room, a right one and two wrong ones in turn."""
    wrong = [(scan, photo) for scan in range(_ROOMS) for photo in range(_ROOMS) if scan != photo]
    wrong.sort(key=lambda pair: _unlike(*pair))
    right = [(room, room) for room in range(_ROOMS)]
    every = chain.from_iterable(zip_longest(right, wrong[::2], wrong[1::2]))
    return [pair for pair in every if pair is not None]


def _unlike(first, second):
    """How many of the floor, the ceiling and the walls have squares of another size; then how unlike their depth is."""
    (cells, depth), (other_cells, other_depth) = _outline(first), _outline(second)
    return sum(own != other for own, other in zip(cells, other_cells, strict=True)) + abs(np.log(depth / other_depth))


@cache
def _outline(number):
    room = Room(number)
    return room.cells_m, room.depth_m


@cache
def views(number):
    return ScanViews(Room(number).scan())


def table(tries):
    """Print how many are verified, and would be."""
    print("photo   tries  verified  without the test")
    for name, right in (("right", True), ("wrong", False)):
        proofs = [_proof(try_) for try_ in tries if try_["right"] == right]
        before = [replace(proof, held=1.0, elsewhere=0.0) for proof in proofs]
        print(f"{name:6} {len(proofs):6d} {_accepted(proofs):9d} {_accepted(before):17d}")


def _accepted(proofs):
    return sum(proof.accepted for proof in proofs)


def _proof(try_):
    return Evidence(**{name: value for name, value in try_.items() if name not in ("pair", "right")})


if __name__ == "__main__":
    main()
