"""How fast the geodesic engine is, beside others, in one run: python -m benchmarks.geodesic [--quick]

Every figure is a median over runs that take turns, so that what else the machine does falls on all alike; times are of
the processor, not of the clock, but for those of two threads. --quick leaves out Levin's optimization and what is
larger than 4 megapixels.
"""

import argparse
import os
import platform
import statistics
import time
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks import geodesic_cases as cases
from benchmarks import geodesic_use
from benchmarks.geodesic_tables import apart, head, medians, row
from reflcolor_addon.geodesic import kernel
from tests.dijkstra_reference import reference_distances

ALPHA = 6.0


def one_field(rounds):
    """One field by the kernel, scipy and the reference, for 8 and 4 neighbors; K nearest of 1,000 seeds."""
    from scipy.sparse.csgraph import dijkstra

    head(
        "One field and the nearest of 1,000 seeds, 760 x 1135, one thread (milliseconds; in brackets, in scipy fields)",
        *("image", "valid", "neighbors", "heapq", "scipy", "kernel", "scipy / kernel", "heapq / kernel"),
        *(f"K = {k}" for k in (8, 16, 32)),
    )
    for name in (*cases.SCANS, "tiled"):
        images = cases.case(name)
        pixels = cases.spread_seeds(images[2], 1000)
        source = int(pixels[len(pixels) // 2])
        for neighbors in (8, 4):
            graph = kernel.Graph(*images, neighbors=neighbors)
            same = cases.pixel_graph(images, neighbors)
            same.matrix  # noqa: B018 - made before the clock runs
            functions = {
                "scipy": partial(dijkstra, same.matrix, indices=source),
                "kernel": partial(kernel.field, graph, source),
            }
            functions |= {k: partial(kernel.nearest, graph, pixels, k) for k in (8, 16, 32)}
            found = medians(functions, rounds)
            place = divmod(source, images[2].shape[1])
            slow = partial(reference_distances, *images, place, neighbors=neighbors)
            found |= medians({"heapq": slow}, 1)
            scipy, own = found["scipy"], found["kernel"]
            row(
                name,
                f"{images[2].mean():.0%}",
                neighbors,
                *(f"{1e3 * found[key]:.0f}" for key in ("heapq", "scipy", "kernel")),
                f"{scipy / own:.1f}",
                f"{found['heapq'] / own:.0f}",
                *(f"{1e3 * found[k]:.0f} ({found[k] / scipy:.1f})" for k in (8, 16, 32)),
            )


def threads(rounds):
    """Exact mode by one and two threads: by the clock, and how much more work two make."""
    images = cases.case("doria")
    pixels = cases.spread_seeds(images[2], 200)
    functions = {n: partial(cases.exact, images, pixels, ALPHA, n) for n in (1, 2)}
    clock, work = ({n: [] for n in functions} for _ in range(2))
    for _ in range(rounds):
        for n, function in functions.items():
            start = time.perf_counter(), time.process_time()
            function()
            clock[n].append(time.perf_counter() - start[0])
            work[n].append(time.process_time() - start[1])
    one, two = (statistics.median(clock[n]) for n in (1, 2))
    busy = statistics.median(b / a for a, b in zip(clock[2], work[2], strict=True))
    more = statistics.median(work[2]) / statistics.median(work[1])
    head(
        f"Exact, 200 seeds, doria, 760 x 1135 (by the clock; {load()} other programs ran)",
        *("1 thread, s", "2 threads, s", "ratio", "processors that 2 threads got", "work of 2 threads to 1"),
    )
    row(f"{one:.2f}", f"{two:.2f}", f"{one / two:.2f}", f"{busy:.2f}", f"{more:.2f}")


def load():
    """About how many programs ran during the last minute besides this one."""
    return f"{max(os.getloadavg()[0] - 1, 0):.0f}" if hasattr(os, "getloadavg") else "some"


def incremental(rounds):
    """One seed more where 50 are: its field and its share in the sums."""
    from scipy.sparse.csgraph import dijkstra

    head(
        "One seed more where 50 are, 760 x 1135, one thread (milliseconds)",
        *("image", "scipy field", "field + blend", "ratio"),
    )
    for name in cases.SCANS:
        images = cases.case(name)
        pixels = cases.spread_seeds(images[2], 51)
        graph, colors = kernel.Graph(*images), cases.seed_colors(pixels)
        blend = kernel.Blend(graph.shape, ALPHA)
        blend.add_all([kernel.field(graph, pixel) for pixel in pixels[:-1]], colors[:-1])

        def add(graph=graph, blend=blend, pixels=pixels, colors=colors):
            blend.add(kernel.field(graph, pixels[-1]), colors[-1])
            return blend.mean()

        matrix = cases.pixel_graph(images).matrix
        functions = {"scipy": partial(dijkstra, matrix, indices=int(pixels[-1])), "add": add}
        found = medians(functions, rounds)
        shown = (f"{1e3 * found[key]:.0f}" for key in ("scipy", "add"))
        row(name, *shown, f"{found['add'] / found['scipy']:.2f}")


def memory():
    """Peak memory per pixel; the graph and the results count, the images do not."""
    head("Peak memory beyond the images, doria, 4 megapixels", "mode", "bytes per pixel", "bar")
    for count in (1, 2):
        found = apart("exact", "doria", 2000, 2000, 6, count)
        row(f"exact, {count} thread(s)", f"{found['bytes'] / found['pixels']:.1f}", 40 * count)
    for k in (8, 16, 32):
        found = apart("nearest", "doria", 2000, 2000, 1000, k)
        row(f"K = {k}", f"{found['bytes'] / found['pixels']:.1f}", 32 + 10 * k)


def growth(quick, rounds):
    """Time per pixel from 0.1 to 40 megapixels."""
    sides = (316, 1000, 2000) if quick else (316, 1000, 2000, 3162, 6325)
    # As many seeds per pixel as 1,000 are on the paper's size, and 1,000.
    per_pixel = 1000 / np.prod(cases.PAPER_SIZE)
    wanted = [(side, seeds) for side in sides for seeds in (round(side * side * per_pixel), 1000)]
    runs = {case: [] for case in wanted}
    for _ in range(rounds):
        for side, seeds in wanted:
            runs[side, seeds].append(apart("nearest", "tiled", side, side, seeds, 8))
    head(
        "Growth, the tiled image, K = 8, one thread, from images to chrominance",
        *("megapixels", "seeds", "us per valid pixel", "to 1 megapixel", "bytes per pixel"),
    )
    seconds = {case: statistics.median(run["seconds"] / run["valid"] for run in found) for case, found in runs.items()}
    for number, (side, seeds) in enumerate(wanted):
        ratio = seconds[side, seeds] / seconds[wanted[2 + number % 2]]
        first = runs[side, seeds][0]
        row(
            f"{side * side / 1e6:.1f}",
            first["seeds"],
            f"{1e6 * seconds[side, seeds]:.2f}",
            f"{ratio:.2f}",
            f"{first['bytes'] / first['pixels']:.0f}",
        )


def levin():
    """Levin's optimization against K = 8, the same 400 seeds."""
    head("400 seeds, doria, 760 x 1135, from images to chrominance", "method", "seconds", "MB", "to K = 8")
    runs = [apart("nearest", "doria", 760, 1135, 400, 8) for _ in range(5)]
    ours = {key: statistics.median(run[key] for run in runs) for key in ("seconds", "bytes")}
    row("K = 8", f"{ours['seconds']:.2f}", f"{ours['bytes'] / 1e6:.0f}", "")
    for solver, name in (
        ("each", "Levin, spsolve for each channel"),
        ("default", "Levin, spsolve for both at once"),
        ("symmetric", "Levin, splu with the best order found"),
    ):
        theirs = apart(solver, "doria", 760, 1135, 400, 0)
        ratios = f"{theirs['seconds'] / ours['seconds']:.0f} x time, {theirs['bytes'] / ours['bytes']:.0f} x memory"
        row(name, f"{theirs['seconds']:.1f}", f"{theirs['bytes'] / 1e6:.0f}", ratios)


def bandwidth(rounds):
    """What the memory would allow: every array read or written just once."""
    images = cases.case("tiled")
    graph, pixels = kernel.Graph(*images), cases.spread_seeds(images[2], 1000)
    source, target = np.ones(1 << 25, np.float32), np.ones(1 << 25, np.float32)
    functions = {
        "copy": partial(np.copyto, target, source),
        "field": partial(kernel.field, graph, int(pixels[500])),
        "nearest": partial(kernel.nearest, graph, pixels, 8),
    }
    found = medians(functions, rounds)
    rate = 2 * source.nbytes / found["copy"]
    # Luminance and range are read, a distance written; for K nearest, the lists and the bounds are written, too.
    floors = {"field": 12 * images[2].size / rate, "nearest": (12 + 8 * 8 + 4) * images[2].size / rate}
    head(f"Against memory bandwidth ({rate / 1e9:.1f} GB/s), tiled", "what", "floor ms", "measured ms", "ratio")
    for key, floor in floors.items():
        row(key, f"{1e3 * floor:.1f}", f"{1e3 * found[key]:.0f}", f"{found[key] / floor:.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="no Levin, at most 4 megapixels, fewer rounds")
    parser.add_argument("--rounds", type=int, help="runs per figure (7; 3 if quick)")
    options = parser.parse_args()
    if not kernel.available():
        raise SystemExit(kernel.reason())
    rounds = options.rounds or (3 if options.quick else 7)
    print(f"{processor()}, {platform.platform(terse=True)}, Python {platform.python_version()}, {time.strftime('%F')}")
    one_field(rounds)
    threads(min(rounds, 3))
    incremental(rounds)
    geodesic_use.changes(rounds)
    geodesic_use.bounds(options.quick)
    memory()
    growth(options.quick, min(rounds, 3))
    bandwidth(rounds)
    if not options.quick:
        geodesic_use.cancelling()
        levin()


def processor():
    """The processor's name."""
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":")[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


if __name__ == "__main__":
    main()
