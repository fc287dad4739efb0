"""Blender's --python script: runs the scenarios of one file in this window, one after another, and quits.

The results go to RESULTS, one JSON object per line: one when a scenario begins, one when it ends.
"""

import argparse
import faulthandler
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[2])]

from inside.driver import Driver  # noqa: E402


def main() -> None:
    """Read the arguments behind "--" and set the driver going as soon as there is a window."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenarios", type=Path, required=True, help="the file")
    parser.add_argument("--names", nargs="+", required=True, help="which of its scenarios")
    parser.add_argument("--zip", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True, help="folder for pictures and files")
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--examples", type=Path, required=True)
    parser.add_argument("--data", type=Path, help="folder of the public scans")
    parser.add_argument("--limit", type=float, required=True, help="seconds for all of it")
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    # A Blender that hangs says where.
    faulthandler.dump_traceback_later(args.limit, file=sys.stderr)
    Driver(args).start()


main()
