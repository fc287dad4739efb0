"""How long Blender's window stands still, beside an older build: python -m benchmarks.stalls BASE [--rounds 3]

BASE is a checkout of the older build. Both builds play the scenario `stalls_without_a_3d_view` of tests/window as it is
here (BASE has it for as long as it plays): a scan of 760 x 1135 is imported, colorized from 50 seeds and matched with a
photo, with Image Editors alone in view, whose drawing costs little without a graphics card. The builds take turns. What
is printed are medians, over the rounds, of the longest gap between two turns of Blender's event loop: by the clock, and
what the window's thread itself computed in the gap with most of that, which other programs change little.

Runs are kept in build/bench-stalls/, so that a call that was interrupted goes on where it was. For a quiet machine.
"""

import argparse
import hashlib
import json
import os
import statistics
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

from benchmarks.geodesic_tables import ROOT, head, row

FOLDER = ROOT / "build" / "bench-stalls"
SCENARIO = "stalls_without_a_3d_view"
SCENARIO_FILE = Path("tests/window/scenario_stalls.py")
FIGURES = ("loop_ms", "loop_cpu_ms")


def main():
    """Play what has not been played yet, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("base", type=Path, help="checkout of the older build")
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    base = args.base.resolve(strict=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    played = {base: [], ROOT: []}
    for number in range(args.rounds):
        for checkout, rounds in played.items():
            rounds.append(stalls_of(checkout, number))
    head(
        "Longest stall of the window, 760 x 1135 pixels",
        *("act", "base, ms", "now, ms", "ratio", "base, computing, ms", "now, computing, ms", "ratio"),
    )
    for act in played[ROOT][0]:
        cells = []
        for figure in FIGURES:
            before, now = (statistics.median(each[act][figure] for each in played[build]) for build in (base, ROOT))
            cells += [f"{before:.0f}", f"{now:.0f}", f"{now / max(before, 1e-3):.2f}"]
        row(act, *cells)


def stalls_of(checkout, number):
    """Return {act: {figure: ms}} of a checkout's scenario, played now unless it was before."""
    commit = subprocess.run(
        ["git", "-C", checkout, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
    ).stdout.strip()
    scenario = (ROOT / SCENARIO_FILE).read_bytes()
    kept = FOLDER / f"{commit}-{hashlib.sha256(scenario).hexdigest()[:8]}-{number}.json"
    if not kept.is_file():
        line = [sys.executable, "-m", "pytest", "-q", "tests/window/run_scenarios.py", "-k", SCENARIO]
        # Another checkout's folders are not this one's.
        environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "REFLCOLOR_ZIP")}
        with _put_into(checkout / SCENARIO_FILE, scenario):
            done = subprocess.run(line, cwd=checkout, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{checkout}: the scenario failed\n{done.stdout[-3000:]}")
        kept.write_text((checkout / "build" / "window" / "scenario_stalls.jsonl").read_text(encoding="utf-8"))
    lines = [json.loads(line) for line in kept.read_text(encoding="utf-8").splitlines()]
    notes = next(line["notes"] for line in lines if line["event"] == "end")
    return {note["stall"]: note for note in notes}


@contextmanager
def _put_into(path, content):
    """Another content of a file, for as long as this lasts."""
    own = path.read_bytes()
    path.write_bytes(content)
    try:
        yield
    finally:
        path.write_bytes(own)


if __name__ == "__main__":
    main()
