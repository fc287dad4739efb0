"""How fast scans are read, beside the libraries' own readers: python -m benchmarks.reading

    python -m benchmarks.reading                              PTX beside numpy.loadtxt, E57 beside pye57
    python -m benchmarks.reading --before CHECKOUT            E57 beside an earlier version, checked out elsewhere
    python -m benchmarks.reading --memory                     bytes a pixel of the formats that are read in columns

Seconds are of the processor, medians. E57 is read by a child process; its seconds are told apart, since a plain reader
has none. How reading grows with the pixels is told by benchmarks.growth. Linux only.
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

from benchmarks import geodesic_cases
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import ScanSurface, read_scans
from reflcolor_addon.files.readers.las import imported_laspy
from reflcolor_addon.files.writers import write_e57, write_ply, write_ptx

# Of the scans whose memory is compared.
SIDES = (700, 1400)
FOLDER = ROOT / "build" / "bench-reading"
SIZES = ((760, 1135), (2000, 2000))
_HEADER_LINES, _CHUNK = 10, 200_000


def scan_file(rows, columns, suffix):
    """The scan `doria`, enlarged, as a file; made when first asked for."""
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


READ_ONCE = """
import json, resource, sys
sys.path.insert(0, sys.argv[1])
from reflcolor_addon.files.readers import ReadOptions, cloud, read_scans
asked = []
cloud.require_memory = lambda needed, *_, **__: asked.append(needed)
(scan,) = read_scans(sys.argv[2], options=ReadOptions(grid=sys.argv[3]))
assert scan.valid.mean() > 0.9
print(json.dumps([max(asked), 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss]))
"""


def in_columns(path, form):
    """Write the scan `doria`, enlarged, as a file of columns, with rows and columns, intensity and colors."""
    scan = geodesic_cases.whole_scan("doria", 1, (SIDES[int("large" in path.stem)],) * 2)
    rows, cols = np.indices(scan.shape)
    points = np.where(scan.valid[..., None], scan.points, np.nan).reshape(-1, 3)
    strength, colors = scan.reflectance.ravel(), scan.color.reshape(-1, 3)
    if form == "PLY":
        write_ply([ScanSurface(scan, scan.color)], path)
    elif form in ("LAS", "LAZ"):
        laspy = imported_laspy()
        there = scan.valid.ravel()
        header = laspy.LasHeader(version="1.4", point_format=7)
        header.scales = np.full(3, 1e-6)
        for name in ("grid_row", "grid_col"):
            header.add_extra_dim(laspy.ExtraBytesParams(name=name, type=np.int32))
        cloud = laspy.LasData(header)
        cloud.x, cloud.y, cloud.z = points[there].T
        cloud.intensity = np.rint(strength[there] * 100).astype(np.uint16)
        cloud.red, cloud.green, cloud.blue = colors[there].T.astype(np.uint16) * 257
        cloud["grid_row"], cloud["grid_col"] = rows.ravel()[there], cols.ravel()[there]
        cloud.write(path)
    else:
        packed = (colors.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)).astype(np.uint32)
        record = np.dtype([(axis, "<f4") for axis in "xyz"] + [("intensity", "<f4"), ("rgb", "<u4")])
        table = np.empty(len(points), record)
        for name, values in zip(record.names, (*points.T, strength, packed), strict=True):
            table[name] = values
        height, width = scan.shape
        head = (
            f"VERSION .7\nFIELDS x y z intensity rgb\nSIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH {width}\n"
        )
        kind = form.partition(", ")[2]
        head += f"HEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(table)}\nDATA {kind}\n"
        if kind == "binary":
            data = table.tobytes()
        elif kind == "ascii":
            data = "\n".join(" ".join(map(str, row)) for row in table.tolist()).encode()
        else:
            # LZF of literal pieces alone: nothing is compressed.
            flat = b"".join(table[name].tobytes() for name in record.names)
            pieces = [flat[at : at + 32] for at in range(0, len(flat), 32)]
            packed = b"".join(bytes([len(piece) - 1]) + piece for piece in pieces)
            data = np.array([len(packed), len(flat)], "<u4").tobytes() + packed
        path.write_bytes(head.encode() + data)


def memory():
    """What reading takes for each pixel, and what was asked for before."""
    head("Bytes a pixel", "format", "taken", "asked for before", "taken / asked for")
    forms = ("PCD, binary", "PCD, ascii", "PCD, binary_compressed", "PLY", "LAS", "LAZ")
    for form, grid in (*((form, "stored") for form in forms), ("LAS", "angle")):
        found = []
        for size in ("small", "large"):
            path = FOLDER / f"{form.replace(', ', '_')}_{size}.{form[:3].lower()}"
            if not path.is_file():
                # In another process: what starts a command counts as its memory until the command itself begins.
                with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as maker:
                    maker.submit(in_columns, path, form).result()
            line = [sys.executable, "-P", "-c", READ_ONCE, str(ROOT), str(path), grid]
            found.append(json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout))
        more = SIDES[1] ** 2 - SIDES[0] ** 2
        asked, taken = ((large - small) / more for small, large in zip(*found, strict=True))
        name = form if grid == "stored" else f"{form}, by angle"
        row(name, f"{taken:.0f}", f"{asked:.0f}", f"{taken / asked:.2f}")


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.reading", description=__doc__.partition("\n")[0])
    parser.add_argument("--before", metavar="CHECKOUT", help="an earlier version")
    parser.add_argument("--memory", action="store_true", help="memory instead of time, of PCD, PLY, LAS and LAZ")
    parser.add_argument("--rounds", type=int, default=5, help="runs per figure (5)")
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    if options.memory:
        memory()
    elif options.before:
        beside_before(options.before, options.rounds)
    else:
        beside_loadtxt(options.rounds)
        beside_pye57(options.rounds)


if __name__ == "__main__":
    main()
