"""How fast a batch is: python -m benchmarks.batch [--scans N] [--photos M] [--rounds R] [--size S] [--folder DIR]

The archive of benchmarks.archive is worked on by a batch of one process for each processor, by one process with all
threads, and by one process that is held to one processor, in turn; the medians of the times by the clock are compared.
Memory is the most that all processes had together, beside the budget.

The machine must do nothing else. With --folder the archive and what was measured are kept there, and the command goes
on with the run that it was interrupted in.
"""

import argparse
import json
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
    parser.add_argument(
        "--size", type=float, default=0.5, help="of scans and photos, beside those of benchmarks.archive"
    )
    parser.add_argument("--folder", type=Path, help="where to put the archive, and to keep it")
    arguments = parser.parse_args()
    folder = arguments.folder or Path(tempfile.mkdtemp(prefix="batch-"))
    folder.mkdir(parents=True, exist_ok=True)
    make(folder, arguments.scans, arguments.photos, size=arguments.size)
    count = thread_count()
    ways = {
        f"{count} processes": (count, None),
        "one process, all threads": (1, None),
        "one process, one thread": (1, {min(os.sched_getaffinity(0))}),
    }
    known = folder / "measured.json"
    measured = json.loads(known.read_text()) if known.is_file() else []
    todo = [way for _ in range(arguments.rounds) for way in ways]
    for way in todo[len(measured) :]:
        measured.append([way, *run(folder, *ways[way])])
        known.write_text(json.dumps(measured))
        print("{}: {:.1f} s, at most {:.2f} GB".format(*measured[-1][:2], measured[-1][2] / 1e9), flush=True)
    times, peaks = ({way: [own[k] for own in measured if own[0] == way] for way in ways} for k in (1, 2))
    first, *others = (statistics.median(times[way]) for way in ways)
    print(f"{arguments.scans} scans, {arguments.photos} photos, {arguments.rounds} rounds, medians:")
    for way, seconds in zip(list(ways)[1:], others, strict=True):
        print(f"{next(iter(ways))} have {seconds / first:.2f} x the throughput of {way}")
    print(f"memory: at most {max(map(max, peaks.values())) / 1e9:.2f} GB of the {BUDGET_GB} GB that were allowed")
    if arguments.folder is None:
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
