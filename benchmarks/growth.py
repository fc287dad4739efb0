"""What large scans take, from 1 to 40 megapixels: python -m benchmarks.growth [MEGAPIXELS ...]

Each run is a process of its own, as a user starts it, on the scan `doria`, enlarged: read; colorize from 500 seeds into
one kind of file, without Blender and in it; and the whole job from a photo in Blender, into .png, .blend and .glb.

Seconds are of the processor, of all processes of a run together; memory is the most that they held at once. Growth is
that of a pixel, to the smallest size. Every run is kept in build/bench-growth/, so that a call that was interrupted
goes on where it was; runs are made anew for another commit. Needs the extension built (`make build`). Linux only.
"""

import argparse
import json
import multiprocessing
import shutil
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
import numpy as np

from benchmarks import geodesic_cases, matching_cost, run_apart
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import Seeds
from reflcolor_addon.files.writers import write_e57, write_ptx

FOLDER = ROOT / "build" / "bench-growth"
MEGAPIXELS = (1, 4, 10, 40)
SEEDS = 500
PHOTO = FOLDER / "doria_photo.jpg"
_WITHOUT = [sys.executable, "-m", "reflcolor_addon"]
_BLENDER = [sys.executable, ROOT / "tools" / "blender_command.py", "--resources", FOLDER / "blender", "--"]
# Name: the program, the suffix of the scan's file, and the suffixes of what is written.
RUNS = {
    "read E57": (_WITHOUT, ".e57", ()),
    "read PTX": (_WITHOUT, ".ptx", ()),
    "colorize to .png": (_WITHOUT, ".e57", (".png",)),
    "colorize to .ply": (_WITHOUT, ".e57", (".ply",)),
    "colorize to .glb": (_WITHOUT, ".e57", (".glb",)),
    "colorize to .e57": (_WITHOUT, ".e57", (".e57",)),
    "colorize to .blend, in Blender": (_BLENDER, ".e57", (".blend",)),
    "from a photo to .png, .blend and .glb, in Blender": (_BLENDER, ".e57", (".png", ".blend", ".glb")),
}


def make_inputs(side, suffix):
    """Write a scan, its seeds, and the photo, where they are not there yet."""
    path = scan_path(side, suffix)
    if not path.is_file():
        made = geodesic_cases.whole_scan("doria", 1, (side, side))
        rows, cols = np.divmod(geodesic_cases.spread_seeds(made.valid, SEEDS), side)
        Seeds(rows, cols, made.color[rows, cols]).save(seeds_path(path))
        (write_ptx if suffix == ".ptx" else write_e57)(made, path)
    if not PHOTO.is_file():
        photo = matching_cost.enlarged_photo("doria", "warped")
        cv2.imwrite(str(PHOTO), photo[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 95])


def scan_path(side, suffix):
    return FOLDER / f"doria_{side}{suffix}"


def seeds_path(path):
    return path.with_suffix(".seeds.json")


def command(name, side, out):
    """The command line of a run."""
    program, suffix, outputs = RUNS[name]
    path = scan_path(side, suffix)
    if not outputs:
        return list(map(str, [*program, "info", path]))
    given = ["--photo", PHOTO] if "photo" in name else ["--seeds", seeds_path(path)]
    written = [part for ending in outputs for part in ("-o", out / f"out{ending}")]
    return list(map(str, [*program, "colorize", path, *given, *written]))


def measured(name, side):
    """What a run takes."""
    # In another process: what starts a command counts as its memory until the command itself begins.
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as maker:
        maker.submit(make_inputs, side, RUNS[name][1]).result()
    with tempfile.TemporaryDirectory(dir=FOLDER) as out:
        return run_apart.measured(command(name, side, Path(out)))


def growth(names, megapixels, rounds):
    """One table for each run."""
    commit = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    record = FOLDER / f"runs-{subprocess.run(commit, check=True, capture_output=True, text=True).stdout.strip()}.json"
    known = json.loads(record.read_text()) if record.is_file() else {}
    for name in names:
        head(name, "megapixels", "seconds", "a pixel, to the first", "peak, MB", "a pixel, to the first")
        first = None
        for size in megapixels:
            times = known.setdefault(f"{name} {size:g}", [])
            while len(times) < rounds:
                times.append(measured(name, round((size * 1e6) ** 0.5)))
                record.write_text(json.dumps(known))
            seconds, peak = (statistics.median(each[key] for each in times[:rounds]) for key in ("processor", "bytes"))
            first = first or (seconds / size, peak / size)
            shares = (seconds / size / first[0], peak / size / first[1])
            row(f"{size:g}", f"{seconds:.1f}", f"{shares[0]:.2f}", f"{peak / 1e6:.0f}", f"{shares[1]:.2f}")


def main():
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("megapixels", metavar="MEGAPIXELS", nargs="*", type=float, help=f"by default {MEGAPIXELS}")
    parser.add_argument("--run", metavar="TEXT", default="", help=f"those runs whose name has it: {', '.join(RUNS)}")
    parser.add_argument("--rounds", type=int, default=1, help="runs per figure (1)")
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    names = [name for name in RUNS if options.run in name]
    if any(RUNS[name][0] is _BLENDER for name in names):
        shutil.rmtree(FOLDER / "blender", ignore_errors=True)
        # The extension as it was built last, installed before anything is measured.
        run_apart.measured(list(map(str, [*_BLENDER, "colorize", "--help"])))
    growth(names, options.megapixels or MEGAPIXELS, options.rounds)


if __name__ == "__main__":
    main()
