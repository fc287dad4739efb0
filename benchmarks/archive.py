"""Which photo shows which scan of a whole archive: python -m benchmarks.archive [--scans N] [--photos M] [--folder DIR]

An archive is simulated (benchmarks/rooms.py): rooms painted at random (--paint), some scanned from two places, and
photos, every tenth of them of a room that was never scanned. A batch finds out which photo shows which scan, and its
table of pairs is compared with the truth:

- true pairs lost: a photo that shows a scan, and that matching alone verifies there with a right camera, but that the
  batch did not find;
- pairs found beyond that: of a photo that matching alone does not verify there, but that another photo helped to place;
- false pairs: a photo said to show a scan of another room, or with a wrong camera; and contradictions, which the batch
  refused, because such a photo is verified on scans of different places;
- a camera is right that puts what the photo shows within 5 % of the photo's width of where it is, in the median: all
  distances are printed, in percent;
- cost: processor time of the batch, colorizing and writing included, beside that of matching every photo with every
  scan. The latter is measured on all true pairs and on a random sample of the others, and summed up.

With --folder the archive and what was measured are kept there, and the command goes on where it was interrupted.
--minutes interrupts it: what it was at is done again, and counts twice.
"""

import argparse
import csv
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.rooms import PAINTS, Room
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching import match_photos
from reflcolor_addon.matching.registration.stored import from_document
from reflcolor_addon.settings import Settings

SEGMENTS = 150
# A camera farther off, as a share of the photo's width, is wrong.
MOST_OFF = 0.05
_ASIDE = (0.4, -0.3)


def main():
    """Make the archive, run the batch, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=30)
    parser.add_argument("--photos", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0, help="another number is another archive")
    parser.add_argument("--paint", choices=PAINTS, default="stones", help="what rooms are painted in")
    add_arguments(parser)
    arguments = parser.parse_args()
    folder = folder_of(arguments)
    right = make(folder, arguments.scans, arguments.photos, arguments.seed, arguments.paint)
    shown = rooms_of(arguments.scans, arguments.photos, arguments.seed)[1]

    def off(scan, photo, own, model):
        room, number = Room(shown[int(photo[-2:])], arguments.paint), int(photo[-2:])
        return off_by(own, model, room, number, place_of(int(scan[-2:]), arguments.scans))

    archive = Archive(
        folder=folder,
        scans=[f"scan_{scan:02d}" for scan in range(arguments.scans)],
        photos=[f"photo_{photo:02d}" for photo in range(arguments.photos)],
        true={(f"scan_{scan:02d}", f"photo_{photo:02d}") for scan, photo in right},
        off=off,
    )
    measure(archive, arguments)


def add_arguments(parser):
    """Declare what every command takes that measures a batch over an archive."""
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--sample", type=int, default=20, help="how many wrong pairs are matched for their cost")
    parser.add_argument("--folder", type=Path, help="where to put the archive, and to keep it")
    parser.add_argument("--minutes", type=float, default=1e6, help="stop after so long; the next call goes on")


def folder_of(arguments):
    """Return the archive's folder, and make it."""
    folder = arguments.folder or Path(tempfile.mkdtemp(prefix="archive-"))
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@dataclass(frozen=True, kw_only=True)
class Archive:
    """Scans and photos in a folder with the manifest batch.toml, and the truth about them.

    Parameters
    ----------
    folder : Path
    scans, photos : list of str
        Names of the files, without the suffix.
    true : set of (str, str)
        Which scan a photo shows.
    unknown : set of (str, str)
        Pairs that may show something of each other; whatever is said of these is neither right nor wrong.
    off : callable
        ``off(scan, photo, own, model)``: how far a camera of a true pair is off, as a share of the photo's width; None
        where that is not known, which counts as right. ``own`` is the Scan.
    """

    folder: Path
    scans: list
    photos: list
    true: set
    unknown: set = field(default_factory=set)
    off: Callable

    def scan_file(self, name):
        """Return the file of a scan."""
        return self.folder / f"{name}.ptx"

    def photo_file(self, name):
        """Return the file of a photo."""
        return next(path for path in (self.folder / f"{name}{end}" for end in (".png", ".jpg")) if path.is_file())


def measure(archive, arguments):
    """Match what shows whether a batch is right, run the batch, and print the figures."""
    known = _Known(archive.folder / "measured.json", time.monotonic() + 60 * arguments.minutes)
    pairs = sorted(archive.true)
    true = [known.of("+".join(pair), partial(matched, archive, *pair)) for pair in pairs]
    rng, wrong = np.random.default_rng(6), []
    while len(wrong) < arguments.sample:
        pair = archive.scans[rng.integers(len(archive.scans))], archive.photos[rng.integers(len(archive.photos))]
        if pair not in archive.true | archive.unknown:
            wrong.append(known.of("+".join(pair), partial(matched, archive, *pair)))
    while not (batch := known.of("batch", dict)).get("done"):
        known.set("batch", run_batch(archive.folder, arguments.jobs, batch, known.end))
    table = rows(archive.folder)
    found, refused = (
        {(row["scan"], Path(row["photo"]).stem) for row in table if row["shows"] == shows} - archive.unknown
        for shows in ("yes", "contradiction")
    )
    tried = {(row["scan"], Path(row["photo"]).stem) for row in table if row["shows"] != "not tried"}
    away = {pair: own["off"] for pair, own in zip(pairs, true, strict=True) if own["verified"]}
    verified = {pair for pair, off in away.items() if _is_right(off)}
    evidence = {(row["scan"], Path(row["photo"]).stem): row["evidence"] for row in table}
    off = {pair: away_of(archive, *pair, evidence[pair]) for pair in found & archive.true}
    correct = {pair for pair, away in off.items() if _is_right(away)}
    lost, false = sorted(verified - found), sorted(found - correct)
    count = len(archive.scans) * len(archive.photos)
    of_true, of_wrong = (float(np.mean([own["processor"] for own in some])) for some in (true, wrong))
    everything = of_true * len(pairs) + of_wrong * (count - len(pairs))
    print(f"{len(archive.scans)} scans x {len(archive.photos)} photos = {count} pairs, {len(pairs)} of them true")
    print(f"matching alone verifies {len(away)} true pairs, {len(verified)} with a right camera; all are off by")
    print(" ", *_percent(away.values()))
    print(f"true pairs lost: {len(lost)} of {len(verified)} ({len(lost) / max(len(verified), 1):.1%})", *lost)
    print(f"pairs found beyond that: {len(correct - verified)}")
    print(f"false pairs: {len(false)} of {len(found)} found", *false)
    print("cameras that the batch found are off by")
    print(" ", *_percent(off.values()))
    others = refused & archive.true - verified
    print(
        f"contradictions: {len(refused - archive.true)} false pairs, {len(refused & verified)} true ones, and "
        f"{len(others)} that matching alone does not verify with a right camera"
    )
    print(f"matching alone verifies {sum(own['verified'] for own in wrong)} of {len(wrong)} wrong pairs")
    print(f"pairs matched after the looks: {len(tried)} ({len(tried) / count:.1%}), {len(tried & archive.true)} true")
    print(f"processor time of the batch: {batch['processor']:.0f} s ({batch['seconds']:.0f} s by the clock)")
    print(f"of all pairs: {everything:.0f} s ({of_true:.1f} s a true pair, {of_wrong:.1f} s a wrong one)")
    print(f"ratio: {batch['processor'] / everything:.3f}")


def _is_right(off):
    return off is None or off <= MOST_OFF


def _percent(shares):
    known = sorted(share for share in shares if share is not None)
    unknown = len(shares) - len(known)
    return [*(f"{share:.1%}" for share in known), *([f"and {unknown} whose camera is not known"] if unknown else [])]


class _Known:
    """What was measured, kept in a file; ends the command when its time is over."""

    def __init__(self, path, end):
        self._path, self.end = path, end
        self._values = json.loads(path.read_text()) if path.is_file() else {}

    def of(self, name, measure):
        if time.monotonic() > self.end:
            sys.exit("the time is over; call it again to go on")
        if name not in self._values:
            self.set(name, measure())
        return self._values[name]

    def set(self, name, value):
        self._values[name] = value
        self._path.write_text(json.dumps(self._values, indent=1))


def make(folder, scans, photos, seed=0, paint="squares", size=1.0):
    """Write an archive and its manifest, batch.toml; return which pairs (scan, photo) show the same room.

    ``size`` is that of scans and photos, beside 80 x 130 and 240 x 180 pixels.
    """
    rooms, shown = rooms_of(scans, photos, seed)
    for scan, room in enumerate(rooms):
        path = folder / f"scan_{scan:02d}.ptx"
        if not path.is_file():
            grid = {"rows": round(80 * size), "columns": round(130 * size), "step_deg": 0.6 / size}
            write_ptx(Room(room, paint).scan(**grid, place=place_of(scan, scans), name=path.stem), path)
    for photo, room in enumerate(shown):
        path = folder / f"photo_{photo:02d}.png"
        if not path.is_file():
            write_png(path, Room(room, paint).photo(photo, round(240 * size), round(180 * size)))
    write_manifest(folder, "scan_*.ptx", "photo_*.png")
    return {(scan, photo) for scan, own in enumerate(rooms) for photo, room in enumerate(shown) if own == room}


def write_manifest(folder, scans, photos):
    """Write batch.toml for the scans and the photos that match two patterns."""
    lines = ('format = "reflcolor-batch"', "version = 1", 'output = "colored"', f'scans = "{scans}"')
    lines += (f'photos = "{photos}"', 'write = "png"', f"settings = {{ slic_segments = {SEGMENTS} }}")
    (folder / "batch.toml").write_text("\n".join(lines) + "\n")


def rooms_of(scans, photos, seed):
    """The numbers of the rooms that scans and photos show."""
    rng, first = np.random.default_rng((seed, 5)), 1000 * seed
    scanned = scans - scans // 6
    rooms = [first + scan % scanned for scan in range(scans)]
    shown = [int(first + rng.integers(scanned)) for _ in range(photos)]
    # Nobody scanned these.
    shown[9::10] = [first + 500 + photo for photo in range(9, photos, 10)]
    return rooms, shown


def place_of(scan, scans):
    """Where the scanner stands in the room of a scan, meters."""
    return _ASIDE if scan >= scans - scans // 6 else (0, 0)


def run_batch(folder, jobs, before, end):
    """Work on the batch until it is done or the time is over; add what it took to what it took before."""
    line = [sys.executable, "-m", "reflcolor_addon", "batch", str(folder / "batch.toml"), "--jobs", str(jobs)]
    used, start = processor_time(), time.perf_counter()
    with subprocess.Popen([*line, "--keep-going", "--resume"]) as process:
        try:
            status = process.wait(max(1.0, min(end - time.monotonic(), 1e6)))
        except subprocess.TimeoutExpired:
            process.terminate()
            status = process.wait()
    if status not in (0, 143):
        sys.exit(status)
    return {
        "done": status == 0,
        "processor": before.get("processor", 0.0) + processor_time() - used,
        "seconds": before.get("seconds", 0.0) + time.perf_counter() - start,
    }


def rows(folder):
    """The lines of the batch's table of pairs."""
    with (folder / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def matched(archive, scan, photo):
    """Match one pair, as nobody would who knew better; of a true pair, how far off the camera is, too."""
    (own,) = read_scans(archive.scan_file(scan))
    before = processor_time()
    matching = match_photos(own, [archive.photo_file(photo)], Settings(slic_segments=SEGMENTS))
    found = {"verified": matching.photos[0].verified, "processor": processor_time() - before}
    if (scan, photo) in archive.true and found["verified"]:
        found["off"] = archive.off(scan, photo, own, matching.photos[0].model)
    return found


def away_of(archive, scan, photo, evidence):
    """How far off the camera is by which a batch placed a photo on its scan: of all that it found there that of the
    evidence in its table."""
    (own,) = read_scans(archive.scan_file(scan))
    for kept in map(json.loads, (path.read_text() for path in archive.folder.glob("colored/*/matched/*.json"))):
        if Path(kept["scan"]).stem == scan and Path(kept["photo"]).stem == photo:
            found = from_document(kept["registration"])
            if f"{round(found.evidence.share, 3):.2f}" == evidence:
                return archive.off(scan, photo, own, found.model)
    sys.exit(f"{scan}, {photo}: no camera of evidence {evidence} was kept")


def off_by(scan, found, room, photo, place):
    """How far a camera puts what a photo of a room shows from where it is, the median as a share of its width."""
    right = room.camera(photo, found.width, found.height, place)
    rows, cols = np.nonzero(scan.valid)
    xy, depth = right.project(scan.points[rows, cols])
    seen = (depth > 0) & (xy >= 0).all(axis=1) & (xy < [right.width, right.height]).all(axis=1)
    away = found.project(found.sites_of(scan, rows, cols))[0][seen] - xy[seen]
    return median_off(away, right.width)


def median_off(away, width):
    """The median of distances (N, 2) in a photo, as a share of its width; infinite where a camera sees none of it."""
    distances = np.hypot(*away.T)
    distances = distances[np.isfinite(distances)]
    return float(np.median(distances) / width) if len(distances) else float("inf")


def processor_time():
    """Seconds of processor that this process and those that it waited for have taken."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(own.ru_utime + own.ru_stime for own in used)


if __name__ == "__main__":
    main()
