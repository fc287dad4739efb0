"""How fast scans are read, beside the libraries' own readers: python -m benchmarks.reading

    python -m benchmarks.reading                              PTX beside numpy.loadtxt, E57 beside pye57
    python -m benchmarks.reading --before CHECKOUT            E57 beside an earlier version, checked out elsewhere

Seconds are of the processor, medians. E57 is read by a child process; its seconds are told apart, since a plain reader
has none. How reading grows with the pixels is told by benchmarks.growth. Linux only.
"""

import argparse
import resource
import statistics
import subprocess
import sys

import numpy as np
import pye57

from benchmarks import geodesic_cases
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import read_scans
from reflcolor_addon.files.writers import write_e57, write_ptx

FOLDER = ROOT / "build" / "bench-reading"
SIZES = ((760, 1135), (2000, 2000))
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


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.reading", description=__doc__.partition("\n")[0])
    parser.add_argument("--before", metavar="CHECKOUT", help="an earlier version")
    parser.add_argument("--rounds", type=int, default=5, help="runs per figure (5)")
    options = parser.parse_args()
    if options.before:
        beside_before(options.before, options.rounds)
    else:
        beside_loadtxt(options.rounds)
        beside_pye57(options.rounds)


if __name__ == "__main__":
    main()
