"""Medians, tables and processes of their own, for the measurements of the geodesic engine."""

import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def medians(functions, rounds, clock=time.process_time):
    """Seconds of each of the named functions: they take turns ``rounds`` times."""
    seconds = {name: [] for name in functions}
    for _ in range(rounds):
        for name, function in functions.items():
            start = clock()
            function()
            seconds[name].append(clock() - start)
    return {name: statistics.median(values) for name, values in seconds.items()}


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def head(title, *cells):
    print(f"\n{title}\n", flush=True)
    row(*cells)
    row(*["---"] * len(cells))


def apart(*arguments, module="benchmarks.geodesic_memory"):
    """What a module prints of one case, in a process of its own."""
    command = [sys.executable, "-m", module, *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)
