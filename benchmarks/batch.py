"""How fast a batch is: python -m benchmarks.batch [--scans N] [--photos M] [--rounds R]

The archive of benchmarks.archive is worked on by a batch of one process for each processor, by one process with all
threads, and by one process that is held to one processor, in turn; the medians of the times by the clock are compared.
Memory is the most that all processes had together, beside the budget.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from benchmarks.archive import make
from reflcolor_addon.threads import thread_count

BUDGET_GB = 4.0


def main():
    """Make the archive, run the batches, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=60)
    parser.add_argument("--photos", type=int, default=12)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="batch-"))
    make(folder, arguments.scans, arguments.photos)
    count = thread_count()
    ways = {
        f"{count} processes": (count, None),
        "one process, all threads": (1, None),
        "one process, one thread": (1, {min(os.sched_getaffinity(0))}),
    }
    times, peaks = {way: [] for way in ways}, {way: [] for way in ways}
    for _ in range(arguments.rounds):
        for way, (jobs, processors) in ways.items():
            seconds, peak = run(folder, jobs, processors)
            times[way].append(seconds)
            peaks[way].append(peak)
            print(f"{way}: {seconds:.1f} s, at most {peak / 1e9:.2f} GB", flush=True)
    first, *others = (statistics.median(times[way]) for way in ways)
    print(f"{arguments.scans} scans, {arguments.photos} photos, {arguments.rounds} rounds, medians:")
    for way, seconds in zip(list(ways)[1:], others, strict=True):
        print(f"{next(iter(ways))} have {seconds / first:.2f} x the throughput of {way}")
    print(f"memory: at most {max(map(max, peaks.values())) / 1e9:.2f} GB of the {BUDGET_GB} GB that were allowed")
    shutil.rmtree(folder)


def run(folder, jobs, processors):
    """Work on the archive from the beginning; seconds by the clock, and the most memory of all processes together."""
    shutil.rmtree(folder / "colored", ignore_errors=True)
    line = [sys.executable, "-m", "reflcolor_addon", "batch", str(folder / "batch.toml")]
    line += ["--jobs", str(jobs), "--memory", str(BUDGET_GB), "--keep-going"]
    start = time.perf_counter()
    process = subprocess.Popen(
        line,
        stdout=subprocess.DEVNULL,
        preexec_fn=None if processors is None else lambda: os.sched_setaffinity(0, processors),
    )
    peak, watching = [0], threading.Event()

    def watch():
        while not watching.wait(0.2):
            peak[0] = max(peak[0], memory_of(process.pid))

    watcher = threading.Thread(target=watch)
    watcher.start()
    status = process.wait()
    watching.set()
    watcher.join()
    if status:
        sys.exit(f"the batch ended with {status}")
    return time.perf_counter() - start, peak[0]


def memory_of(pid):
    """Bytes that a process and all that it started have in memory, shared pages once (as far as Linux tells)."""
    total, waiting = 0, [pid]
    while waiting:
        own = waiting.pop()
        try:
            rollup = Path(f"/proc/{own}/smaps_rollup").read_text()
            total += next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Pss:")) * 1024
            for task in Path(f"/proc/{own}/task").iterdir():
                waiting += map(int, (task / "children").read_text().split())
        except (OSError, StopIteration):
            continue
    return total


if __name__ == "__main__":
    main()
