"""Live Update's computing, one seed added to 50, 760 x 1135, preset Natural: python -m benchmarks.live [--rounds 9]

Seconds of the processor of all threads, medians: the first colors with what is kept from the seed before, the same with
all lists of nearest seeds made anew, and all colors. What the window takes besides is measured by the window scenarios
`live` (docs/picking.md).
"""

import argparse
import statistics
import time

import numpy as np

from benchmarks import geodesic_cases as cases
from benchmarks.geodesic_tables import head, row
from reflcolor_addon import Seeds, Settings
from reflcolor_addon.view.live import _LiveScan


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.live", description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=9, help="seeds that are added (9)")
    options = parser.parse_args()
    head(
        "One seed added to 50, Natural, 760 x 1135: milliseconds of the processor",
        *("scan", "first colors", "lists made anew", "ratio", "all colors"),
    )
    for name in ("doria", "bildstein_25"):
        scan = cases.whole_scan(name, 1)
        kept, anew = _LiveScan(scan), _LiveScan(scan)
        pixels = cases.spread_seeds(scan.valid, 50 + options.rounds)
        order = np.random.default_rng(1).permutation(len(pixels))
        times = {"kept": [], "anew": [], "full": []}
        for count in range(50, len(pixels)):
            seeds = _seeds(scan, pixels[order[:count]])
            if anew._coarse is not None:
                anew._coarse._spreader._paths._lists.clear()
                anew._coarse._spreader._unsmoothed_paths = None
            for key, colored in (("kept", kept.coarse), ("anew", anew.coarse), ("full", kept.full)):
                times[key].append(_milliseconds(colored, seeds))
        # The first time, everything is made.
        first, again, full = (statistics.median(each[1:]) for each in times.values())
        row(name, f"{first:.0f}", f"{again:.0f}", f"{first / again:.2f}", f"{full:.0f}")


def _seeds(scan, pixels):
    rows, cols = np.divmod(pixels, scan.shape[1])
    return Seeds(rows, cols, np.random.default_rng(2).integers(0, 256, (len(pixels), 3)).astype(np.uint8))


def _milliseconds(colored, seeds):
    begun = time.process_time()
    colored(seeds, Settings.preset("Natural"), None, lambda: False)
    return 1000 * (time.process_time() - begun)


if __name__ == "__main__":
    main()
