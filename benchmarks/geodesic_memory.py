"""Time and peak memory of one case, in a process of its own.

    python -m benchmarks.geodesic_memory exact IMAGE HEIGHT WIDTH SEEDS THREADS
    python -m benchmarks.geodesic_memory nearest IMAGE HEIGHT WIDTH SEEDS K
    python -m benchmarks.geodesic_memory SOLVER IMAGE HEIGHT WIDTH SEEDS 0

SOLVER is how Levin's system is solved: symmetric, default or each.

Prints JSON: seconds of the processor, valid pixels, all pixels, bytes at the peak beyond what was there before.
"""

import json
import sys
import time
from pathlib import Path

from benchmarks import geodesic_cases as cases
from benchmarks.quality import peers
from reflcolor_addon.geodesic import kernel

_ALPHA = 6.0
SOLVERS = {
    "symmetric": peers.solve_symmetrically,
    "default": peers.solve_by_default,
    "each": peers.solve_each_by_default,
}


def status(field):
    """Bytes of one line of this process's memory status (Linux)."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1]) * 1024
    raise KeyError(field)


def run(method, images, pixels, number):
    """The work that is measured, from images to means."""
    if method in SOLVERS:
        return peers.levin(*cases.as_scan(images, pixels), SOLVERS[method])
    if method == "exact":
        return cases.exact(images, pixels, _ALPHA, number)
    return kernel.nearest(kernel.Graph(*images), pixels, number).blend(cases.seed_colors(pixels), _ALPHA)


def main():
    method, image, height, width, seeds, number = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:])
    images = cases.case(image, (height, width))
    pixels = cases.spread_seeds(images[2], seeds)
    # From here on, the peak is counted anew.
    Path("/proc/self/clear_refs").write_text("5")
    before, start = status("VmRSS"), time.process_time()
    result = run(method, images, pixels, number)
    seconds = time.process_time() - start
    print(
        json.dumps(
            {
                "seconds": seconds,
                "seeds": len(pixels),
                "valid": int(images[2].sum()),
                "pixels": images[2].size,
                "bytes": status("VmHWM") - before,
            }
        )
    )
    return result


if __name__ == "__main__":
    main()
