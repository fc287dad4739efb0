"""What users meet of the geodesic engine: changes of one seed, how far "auto" is from exact, and cancelling."""

import statistics
import threading
import time

import numpy as np

from benchmarks import geodesic_cases as cases
from benchmarks import real_scans
from benchmarks.geodesic_tables import head, row
from reflcolor_addon import Colorizer, Seeds, Settings, colorize
from reflcolor_addon.color import colorspaces
from reflcolor_addon.color.nearest_seeds import NUMBERS, doubled_levels, sample_of
from reflcolor_addon.errors import Cancelled
from reflcolor_addon.geodesic import kernel

# Seconds after its start at which a call is cancelled.
_MOMENTS = {
    "graph": (0.0, 0.03, 0.06),
    "one field": (0.0, 0.05, 0.3, 0.7),
    "K = 8": (0.0, 0.05, 0.2, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 10.0),
    "blend of K = 8": (0.0, 0.1, 1.0),
    "sum of a field": (0.0, 0.02, 0.05),
}


def changes(rounds):
    """Seeds added, moved, recolored and removed, by `Colorizer.colorize`, all of it."""
    head(
        "One of 50 seeds changed, 760 x 1135, Colorizer.colorize as a whole (ms of the processor; by the clock)",
        *("image", "stride", "new Colorizer", "all 50", "add", "move", "recolor", "remove"),
    )
    for name in cases.SCANS:
        for stride in (1, 4):
            found = _changes(name, stride, rounds)
            shown = (f"{1e3 * work:.0f} ({1e3 * clock:.0f})" for work, clock in found.values())
            row(name, stride, *shown)


def _changes(name, stride, rounds):
    """Median seconds, of the processor and by the clock, of every kind of change to the middle one of 50 seeds."""
    scan = cases.whole_scan(name, stride)
    pixels = cases.spread_seeds(scan.valid, 51)
    rgb = np.random.default_rng(1).integers(0, 256, (len(pixels), 3))
    middle, times, made = len(pixels) // 2, {}, []

    def timed(kind, function, *arguments):
        start = time.process_time(), time.perf_counter()
        result = function(*arguments)
        times.setdefault(kind, []).append((time.process_time() - start[0], time.perf_counter() - start[1]))
        return result

    def colored(kind, pixels, rgb):
        return timed(kind, made[-1].colorize, Seeds(*np.divmod(pixels, scan.shape[1]), rgb))

    for number in range(rounds):
        made.append(timed("new", Colorizer, scan))
        colored("all", pixels[:-1], rgb[:-1])
        colored("add", pixels, rgb)
        moved = pixels.copy()
        moved[middle] = np.flatnonzero(scan.valid)[1000 + number]
        colored("move", moved, rgb)
        other = rgb.copy()
        other[middle] = 255 - other[middle]
        colored("recolor", moved, other)
        colored("remove", np.delete(moved, middle), np.delete(other, middle, axis=0))
        made.clear()
    return {kind: [statistics.median(column) for column in zip(*each, strict=True)] for kind, each in times.items()}


def bounds(quick):
    """What nearest="auto" picks and why, the bound on what the seeds left out could change, and what they do change."""
    levels = colorspaces.levels_per_unit("ycbcr")
    head(
        'Nearest seeds against all, 8-bit levels; what "auto" picks. Doubled: 95 of 100 pixels change no more from '
        "K / 2 to K. Bound: mean / p99.9. Truth: mean / p95 / p99.9",
        *("scan", "seeds", "auto", *(f"K = {k}: {what}" for k in NUMBERS for what in ("doubled", "bound", "truth"))),
        "beyond the bound",
    )
    wanted = (("pumpA", 450), ("bildstein_25", 1200), ("doria", 1000))
    for name, count in wanted[: 1 if quick else None]:
        scan = cases.whole_scan(name, 1) if name == "doria" else real_scans.load(name, cases.DATA)
        pixels = cases.spread_seeds(scan.valid, count)
        rows, cols = np.divmod(pixels, scan.shape[1])
        seeds = Seeds(rows, cols, scan.color[rows, cols])
        picked = colorize(scan, seeds, Settings(nearest="auto")).method["nearest"]
        colors = colorspaces.chrominance(seeds.rgb, "ycbcr").astype(np.float32)
        every = cases.exact(cases.images_of(scan), pixels, 6.0, 2, colors)
        graph, cells, beyond = kernel.Graph(*cases.images_of(scan)), [], 0
        for k in NUMBERS:
            found = kernel.nearest(graph, pixels, k)
            mean, bound = found.blend(colors, 6.0)
            truth = np.abs(mean.values - every.values).max(axis=0)
            # Half of a hundredth of a level is for the rounding of sums of this many seeds.
            beyond += np.count_nonzero(truth > bound + 0.005)
            cells.append(f"{doubled_levels(found.at(sample_of(scan.valid)), colors, 6.0, levels):.2f}")
            for values, shares in ((bound[scan.valid] * levels, [99.9]), (truth[scan.valid] * levels, [95, 99.9])):
                shown = (f"{value:.1f}" for value in np.percentile(values, shares))
                cells.append(" / ".join([f"{values.mean():.2f}", *shown]))
        row(name, len(pixels), "all" if picked is None else f"K = {picked}", *cells, f"{beyond} pixels")


def cancelling():
    """How long calls go on after they were cancelled, at 40 megapixels."""
    images = cases.case("tiled", (6325, 6325))
    pixels = cases.spread_seeds(images[2], 46178)
    graph, colors = kernel.Graph(*images), cases.seed_colors(pixels)
    found, blend = kernel.nearest(graph, pixels, 8), kernel.Blend(graph.shape, 6.0)
    field = kernel.field(graph, pixels[0])
    calls = {
        "graph": lambda control: kernel.Graph(*images, control=control),
        "one field": lambda control: kernel.field(graph, pixels[0], control=control),
        "K = 8": lambda control: kernel.nearest(graph, pixels, 8, control=control),
        "blend of K = 8": lambda control: found.blend(colors, 6.0, control=control),
        "sum of a field": lambda control: blend.add(field, (0, 0), control),
    }
    head(
        "Cancelled at 40 megapixels (ms of the processor until the call returns)",
        *("call", "cancelled at so many moments", "median", "worst"),
    )
    for name, call in calls.items():
        taken = [each for moment in _MOMENTS[name] if (each := _cancelled(call, moment)) is not None]
        row(name, len(taken), f"{1e3 * statistics.median(taken):.1f}", f"{1e3 * max(taken):.1f}")


def _cancelled(call, moment):
    """Seconds of the processor from a call's cancellation to its end; None if it had ended before."""
    control, start = kernel.Control(), []

    def cancel():
        start.append(time.process_time())
        control.cancel()

    timer = threading.Timer(moment, cancel)
    timer.start()
    try:
        call(control)
    except Cancelled:
        return time.process_time() - start[0]
    finally:
        timer.cancel()
        timer.join()
    return None
