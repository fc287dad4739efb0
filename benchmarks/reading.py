"""How fast scans are read, beside the libraries' own readers, and how that grows: python -m benchmarks.reading

    python -m benchmarks.reading                              PTX beside numpy.loadtxt, E57 beside pye57
    python -m benchmarks.reading --growth [MEGAPIXELS ...]    E57 from 1 to 40 megapixels
    python -m benchmarks.reading --before CHECKOUT            E57 beside an earlier version, checked out elsewhere

Seconds are of the processor, medians. E57 is read by a child process; its seconds are told apart, since a plain reader
has none. Growth is that of seconds and memory: of reading, and of reading, colorizing from 200 seeds and saving as PLY,
without Blender, each run a process of its own. What was measured is kept in build/bench-reading/. Linux only.
"""

import argparse
import json
import multiprocessing
import resource
import statistics
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pye57

from benchmarks import geodesic_cases, run_apart
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import Seeds, read_scans
from reflcolor_addon.files.writers import write_e57, write_ptx

FOLDER = ROOT / "build" / "bench-reading"
SIZES = ((760, 1135), (2000, 2000))
GROWTH = (1, 4, 10, 40)
_HEADER_LINES, _CHUNK = 10, 200_000


def scan_file(rows, columns, suffix):
    """The scan `doria`, enlarged, as a file; made when first asked for."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"doria_{rows}x{columns}{suffix}"
    if not path.is_file():
        write = write_ptx if suffix == ".ptx" else write_e57
        write(geodesic_cases.whole_scan("doria", 1, (rows, columns)), path)
    return path


def processor():
    """Seconds of this process, and of the children that ended."""
    return [
        used.ru_utime + used.ru_stime
        for used in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    ]


def turns(functions, rounds):
    """Medians of (own, children's) seconds of functions that take turns."""
    found = {name: [] for name in functions}
    for _ in range(rounds):
        for name, function in functions.items():
            before = processor()
            function()
            found[name].append([after - start for after, start in zip(processor(), before, strict=True)])
    return {name: [statistics.median(column) for column in zip(*times, strict=True)] for name, times in found.items()}


def beside_loadtxt(rounds):
    """PTX to a `Scan`, beside numpy.loadtxt on the same lines of points."""
    head("PTX, seconds of the processor", "pixels", "file to scan", "numpy.loadtxt alone", "ratio")
    for rows, columns in SIZES:
        path = scan_file(rows, columns, ".ptx")
        lines = path.read_text().split("\n")[_HEADER_LINES:-1]

        def loadtxt(lines=lines):
            for start in range(0, len(lines), _CHUNK):
                np.loadtxt(lines[start : start + _CHUNK], np.float64, comments=None, ndmin=2)

        found = turns({"ours": lambda path=path: read_scans(path), "loadtxt": loadtxt}, rounds)
        ours, theirs = found["ours"][0], found["loadtxt"][0]
        row(f"{rows} x {columns}", f"{ours:.2f}", f"{theirs:.2f}", f"{ours / theirs:.2f}")


def beside_pye57(rounds):
    """E57 to a `Scan`, beside pye57's own reader of raw columns."""
    head(
        "E57, seconds of the processor",
        "pixels",
        "file to scan, without the child",
        "the child",
        "pye57 alone (read_scan_raw)",
        "ratio without the child",
    )
    for rows, columns in SIZES:
        path = scan_file(rows, columns, ".e57")

        def plain(path=path):
            file = pye57.E57(str(path))
            file.read_scan_raw(0)
            file.close()

        found = turns({"ours": lambda path=path: read_scans(path), "pye57": plain}, rounds)
        (ours, child), theirs = found["ours"], found["pye57"][0]
        row(f"{rows} x {columns}", f"{ours:.2f}", f"{child:.2f}", f"{theirs:.2f}", f"{ours / theirs:.2f}")


READ_TWICE = """
import os, sys
sys.path.insert(0, sys.argv[1])
from reflcolor_addon import read_scans
read_scans(sys.argv[2])
before = os.times()
read_scans(sys.argv[2])
print(sum(os.times()[:4]) - sum(before[:4]))
"""


def beside_before(checkout, rounds):
    """E57 read by an earlier version and by this one, children included; processes of their own that take turns."""
    head("E57, seconds of the processor", "pixels", "before", "now", "now, at most", "allowed: before + 10 % + 0.3")
    for rows, columns in SIZES:
        path = scan_file(rows, columns, ".e57")
        found = {checkout: [], ROOT: []}
        for _ in range(rounds):
            for root, seconds in found.items():
                line = [sys.executable, "-P", "-c", READ_TWICE, str(root), str(path)]
                seconds.append(float(subprocess.run(line, check=True, capture_output=True, text=True).stdout))
        before, now = map(statistics.median, found.values())
        row(
            f"{rows} x {columns}",
            f"{before:.2f}",
            f"{now:.2f}",
            f"{max(found[ROOT]):.2f}",
            f"{before * 1.1 + 0.3:.2f}",
        )


def job(path):
    """The arguments of a run that reads, colorizes and saves."""
    seeds, side = FOLDER / f"{path.stem}.seeds.json", int(path.stem.rpartition("x")[2])
    if not seeds.is_file():
        rng = np.random.default_rng(0)
        rows, cols = np.unique(rng.integers(0, side, (200, 2)), axis=0).T
        Seeds(rows, cols, rng.integers(0, 256, (len(rows), 3))).save(seeds)
    return ["reflcolor_addon", "colorize", path, "--seeds", seeds, "-o", FOLDER / "out.ply"]


def growth(megapixels, rounds):
    """Seconds and memory by the pixels of an E57."""
    record = FOLDER / "growth.json"
    known = json.loads(record.read_text()) if record.is_file() else {}
    runs = {
        "read": lambda path: ["benchmarks.reading", "--one", path],
        "read, colorize and save": job,
    }
    for name, arguments in runs.items():
        head(name, "megapixels", "seconds", "a pixel, to the first", "peak, MB", "a pixel, to the first")
        first = None
        for size in megapixels:
            side = round((size * 1e6) ** 0.5)
            # In another process: what starts a command counts as its memory until the command itself begins.
            with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as maker:
                path = maker.submit(scan_file, side, side, ".e57").result()
            command = [sys.executable, "-m", *map(str, arguments(path))]
            times = known.setdefault(f"{name} {size:g}", [])
            while len(times) < rounds:
                times.append(run_apart.measured(command))
                record.write_text(json.dumps(known))
            seconds, peak = (statistics.median(each[key] for each in times[:rounds]) for key in ("processor", "bytes"))
            first = first or (seconds / size, peak / size)
            shares = (seconds / size / first[0], peak / size / first[1])
            row(f"{size:g}", f"{seconds:.1f}", f"{shares[0]:.2f}", f"{peak / 1e6:.0f}", f"{shares[1]:.2f}")


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.reading", description=__doc__.partition("\n")[0])
    parser.add_argument("--growth", metavar="MEGAPIXELS", type=float, nargs="*", help=f"by default {GROWTH}")
    parser.add_argument("--before", metavar="CHECKOUT", help="an earlier version")
    parser.add_argument("--one", metavar="FILE", help="read one file, for the growth")
    parser.add_argument("--rounds", type=int, default=5, help="runs per figure (5)")
    options = parser.parse_args()
    if options.one:
        read_scans(options.one)
    elif options.before:
        beside_before(options.before, options.rounds)
    elif options.growth is not None:
        growth(options.growth or GROWTH, options.rounds)
    else:
        beside_loadtxt(options.rounds)
        beside_pye57(options.rounds)


if __name__ == "__main__":
    main()
