"""Which photo shows which scan of a whole archive: python -m benchmarks.archive [--scans N] [--photos M] [--jobs J]

An archive is simulated: rooms painted at random, each scanned once, and photos from about the scanner's place in random
directions. A batch finds out which photo shows which scan, and its table of pairs is compared with the truth:

- true pairs lost: a photo that shows a scan, and that matching alone verifies, but that the batch did not find;
- false pairs: a photo said to show a scan that it does not show;
- cost: processor time of the batch beside that of matching every photo with every scan. The latter is measured on all
  true pairs and on a random sample of the others, of the same share for each scan, and summed up.
"""

import argparse
import csv
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from reflcolor_addon.cli.main import main as command_line
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching import match_photos
from reflcolor_addon.settings import Settings
from tests import painted_room

SETTINGS = Settings(slic_segments=150)


def main():
    """Make the archive, run the batch, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=30)
    parser.add_argument("--photos", type=int, default=40)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument(
        "--sample", type=int, default=20, help="how many wrong pairs are matched to know what they cost"
    )
    parser.add_argument("--folder", type=Path, help="where to put the archive, and to keep it")
    arguments = parser.parse_args()
    folder = arguments.folder or Path(tempfile.mkdtemp(prefix="archive-"))
    truth = make(folder, arguments.scans, arguments.photos)
    before = processor_time()
    start = time.perf_counter()
    status = command_line(
        ["batch", str(folder / "batch.toml"), "--jobs", str(arguments.jobs), "--keep-going", "--resume"]
    )
    seconds, cost = time.perf_counter() - start, processor_time() - before
    if status:
        sys.exit(status)
    found = {(row["scan"], Path(row["photo"]).stem) for row in rows(folder) if row["shows"] == "yes"}
    tried = len(rows(folder))
    verified, right_cost = matched(truth, arguments.scans)
    wrong_cost = sampled(truth, arguments)
    right = {(f"room_{scan}", f"photo_{photo}") for photo, scan in enumerate(truth)}
    lost = {pair for pair in right - found if pair in verified}
    count = arguments.scans * arguments.photos
    all_pairs = right_cost * len(truth) + wrong_cost * (count - len(truth))
    print(f"{arguments.scans} scans x {arguments.photos} photos = {count} pairs, {len(truth)} of them true")
    print(f"matching alone verifies {len(verified)} true pairs; the batch found {len(found & right)}")
    print(f"true pairs lost: {len(lost)} of {len(verified)} ({len(lost) / max(len(verified), 1):.1%})")
    print(f"false pairs: {len(found - right)}")
    print(f"pairs matched after the first look: {tried}")
    print(f"processor time of the batch {cost:.0f} s ({seconds:.0f} s by the clock, colorizing and writing included)")
    print(f"all pairs: {all_pairs:.0f} s ({right_cost:.1f} s a true pair, {wrong_cost:.1f} s a wrong one)")
    print(f"ratio: {cost / all_pairs:.2f}")


def make(folder, scans, photos):
    """Write the archive; return the scan that each photo shows."""
    rng = np.random.default_rng(5)
    for number in range(scans):
        write_ptx(painted_room.scan(seed=number, name=f"room {number}"), folder / f"room_{number}.ptx")
    truth = [int(scan) for scan in rng.integers(scans, size=photos)]
    for number, scan in enumerate(truth):
        write_png(folder / f"photo_{number}.png", picture(number, scan))
    lines = ('format = "reflcolor-batch"', "version = 1", 'output = "colored"', 'scans = "room_*.ptx"')
    lines += ('photos = "photo_*.png"', 'write = "png"', "settings = { slic_segments = 150 }")
    (folder / "batch.toml").write_text("\n".join(lines) + "\n")
    return truth


def picture(number, scan):
    """A photo of a room."""
    rng = np.random.default_rng((number, scan))
    camera = painted_room.camera(
        center=rng.uniform((-0.6, -0.3, -0.2), (0.6, 0.5, 0.3)),
        yaw_deg=rng.uniform(-18, 18),
        pitch_deg=rng.uniform(-10, 2),
        roll_deg=rng.uniform(-2, 2),
        focal=rng.uniform(0.75, 1.1),
    )
    return painted_room.photo(camera, seed=scan, gain=rng.uniform(0.8, 1.1))


def rows(folder):
    """The lines of the batch's table of pairs."""
    with (folder / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def matched(truth, scans):
    """The true pairs that matching verifies, and the processor time of one."""
    verified, before = set(), processor_time()
    for scan in range(scans):
        for photo in (photo for photo, own in enumerate(truth) if own == scan):
            matching = match_photos(painted_room.scan(seed=scan), [picture(photo, scan)], SETTINGS)
            if matching.photos[0].verified:
                verified.add((f"room_{scan}", f"photo_{photo}"))
    return verified, (processor_time() - before) / max(len(truth), 1)


def sampled(truth, arguments):
    """The processor time of a wrong pair, from a random sample."""
    rng, before = np.random.default_rng(6), processor_time()
    for _ in range(arguments.sample):
        photo = int(rng.integers(arguments.photos))
        scan = int(rng.choice([scan for scan in range(arguments.scans) if scan != truth[photo]]))
        match_photos(painted_room.scan(seed=scan), [picture(photo, truth[photo])], SETTINGS)
    return (processor_time() - before) / max(arguments.sample, 1)


def processor_time():
    """Seconds of processor that this process and those that it waited for have taken."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(own.ru_utime + own.ru_stime for own in used)


if __name__ == "__main__":
    main()
