"""Print the tables of docs/quality.md, and draw its plots: python -m benchmarks.quality [SCAN ...] [--plots FOLDER]

Takes some ten minutes for all scans. Ends with 1 if a bar is not met.
"""

import argparse
import sys
from pathlib import Path

from . import tables
from .measure import measure
from .plots import draw
from .scenes import COUNTS, NAMES


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.quality", description=__doc__.partition("\n")[0])
    parser.add_argument("scans", metavar="SCAN", nargs="*", help=f"by default all: {', '.join(NAMES)}")
    parser.add_argument("--plots", metavar="FOLDER", type=Path, help="draw error against number of seeds, as PNG")
    parser.add_argument("--kept", metavar="FOLDER", type=Path, help="keep figures there, and go on from those")
    arguments = parser.parse_args()
    if unknown := set(arguments.scans) - set(NAMES):
        parser.error(f"no scan {', '.join(sorted(unknown))}; there are {', '.join(NAMES)}")
    results = []
    for name in arguments.scans or NAMES:
        for count in COUNTS:
            print(f"{name}, {count} seeds", file=sys.stderr, flush=True)
            results.append(measure(name, count, arguments.kept))
    print(f"\nNatural, as the colors come\n\n{tables.natural_summary(results)}")
    for title, table in (
        ("Mean CIEDE2000 as the colors come / structural similarity of the luminance", tables.as_is_table),
        ("Mean CIEDE2000 after one exposure gain", tables.exposed_table),
        ("With the true luminance: mean CIEDE2000 / chrominance PSNR in dB", tables.alone_table),
    ):
        for count in COUNTS:
            print(f"\n{title}, about {count} seeds\n\n{table(results, count)}")
    print(f"\nEnhanced against Levin's and Paper, with the true luminance\n\n{tables.summary(results)}")
    print(f"\nConfidence and error\n\n{tables.confidence_table(results)}")
    print(f"\nMean CIEDE2000 by confidence\n\n{tables.calibration_table(results)}")
    print(f"\nTime\n\n{tables.time_table(results)}")
    if arguments.plots:
        draw(results, arguments.plots)
    failures = tables.failures(results)
    print("\nAll bars are met." if not failures else "\n" + "\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
