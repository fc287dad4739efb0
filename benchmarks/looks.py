"""How well looks tell which scan a photo shows, and what is of one room: python -m benchmarks.looks [SEED ...]

For the archives of benchmarks.archive with these seeds (30 scans, 40 photos). First which photos overlap: how many
pairs are found of photos of one room, and how many of others. Then what the looks say of photos: in which place they
put every scan of the photo's room, where that is not the first one, without and with photos that overlap.
Then what they say of scans: every scan is looked for in all others; which scans of the same room that names, and how
many of others. Times are of the processor, for one look, with one thread.
"""

import argparse
import time
from collections import defaultdict
from itertools import combinations
from statistics import median_high

import numpy as np

from benchmarks.archive import place_of, rooms_of
from benchmarks.rooms import Room
from reflcolor_addon.batch.archive.candidates import merged, ranks
from reflcolor_addon.batch.archive.partners import look, partners, picture_of
from reflcolor_addon.batch.archive.two_looks import first_look, second_look
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.overlaps import LEAST_AGREEMENT, Described, agreement
from reflcolor_addon.matching.registration.registration import ScanViews
from reflcolor_addon.threads import limit_threads

_SCANS, _PHOTOS = 30, 40


def main():
    """Look, and print what was seen."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seeds", metavar="SEED", nargs="*", type=int, default=[0])
    limit_threads(1)
    for seed in parser.parse_args().seeds:
        rooms, shown = rooms_of(_SCANS, _PHOTOS, seed)
        views = {
            f"scan_{number:02d}": ScanViews(Room(room).scan(place=place_of(number, _SCANS)))
            for number, room in enumerate(rooms)
        }
        rooms = dict(zip(views, rooms, strict=True))
        shown = {f"photo_{number:02d}": room for number, room in enumerate(shown)}
        print(f"seed {seed}", flush=True)
        images = {
            photo: PhotoImage(photo, Room(room).photo(number)) for number, (photo, room) in enumerate(shown.items())
        }
        usual = _of_photos(views, rooms, shown, images, _overlaps(shown, images))
        _of_scans(views, rooms, usual)


def _overlaps(shown, images):
    """Print which photos overlap; return for each the others that do."""
    start = time.process_time()
    described = {photo: Described.of(image) for photo, image in images.items()}
    between, found, strangers = time.process_time(), defaultdict(set), [0.0]
    for one, other in combinations(images, 2):
        own = agreement(described[one], described[other])
        if shown[one] != shown[other]:
            strangers.append(own)
        if own >= LEAST_AGREEMENT:
            found[one].add(other)
            found[other].add(one)
    seconds, count = time.process_time() - between, len(images)
    pairs = count * (count - 1) // 2
    right = sum(shown[one] == shown[other] for one, own in found.items() for other in own) // 2
    wrong = sum(map(len, found.values())) // 2 - right
    mates = sum(list(shown.values()).count(room) > 1 for room in shown.values())
    print(f"{mates} of {count} photos have another one of their room")
    print(f"describing a photo takes {(between - start) / count:.2f} s, comparing two {seconds / pairs:.4f} s")
    print(f"of {pairs + 1 - len(strangers)} pairs of photos of one room {right} overlap, and of the others {wrong},")
    print(f"  whose brightness has correlations of at most {max(strangers):.2f}")
    return found


def _of_photos(views, rooms, shown, images, overlaps):
    """Print what looks at photos say; return the usual score of each scan."""
    first, second, seconds = {}, {}, np.zeros(2)
    for name, own in views.items():
        first[name], second[name] = {}, {}
        for photo, image in images.items():
            start = time.process_time()
            first[name][photo], directions = first_look(own, image)
            between = time.process_time()
            second[name][photo] = second_look(own, image, directions)
            seconds += between - start, time.process_time() - between
    print("a first look takes {:.2f} s, a second one {:.2f} s".format(*seconds / len(views) / len(shown)))
    for which, known in (("by itself", {}), ("with those that overlap", overlaps)):
        both = merged(ranks(first, overlaps=known), ranks(second, overlaps=known, second=True))
        places = {
            f"{name}+{photo}": 1 + [other for other, _ in both[photo]].index(name)
            for name, room in rooms.items()
            for photo, own in shown.items()
            if own == room
        }
        later = [f"{pair} {place}" for pair, place in places.items() if place > 1]
        print(f"each photo {which}: of {len(places)} true pairs {len(places) - len(later)} are in the first place;")
        print("  the others:", *later)
    return {name: median_high(own.values()) for name, own in first.items()}


def _of_scans(views, rooms, usual):
    """Print what looks at scans say."""
    start, right, of_two, wrong = time.process_time(), 0, 0, 0
    for name, own in views.items():
        picture = PhotoImage(name, picture_of(own, *np.nonzero(own.scan.valid)))
        others = [other for other in views if other != name]
        named = partners({other: look(views[other], picture) for other in others}, usual)
        same = {other for other in others if rooms[other] == rooms[name]}
        of_two += bool(same)
        right += bool(same.intersection(named))
        wrong += len(set(named) - same)
    each = (time.process_time() - start) / len(views) / (len(views) - 1)
    print(f"a look at a scan takes {each:.2f} s")
    print(f"of {of_two} scans of rooms that were scanned twice {right} name the other one")
    print(f"all {len(views)} scans together name {wrong} of other rooms", flush=True)


if __name__ == "__main__":
    main()
