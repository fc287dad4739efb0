"""Read many changed files (make fuzz), or one of them again.

python -m fuzz [--inputs N] [--seed N] [--minutes N --state FILE] [--one KIND NUMBER FILE]

Runs in a process of its own, which is started again where a file ends it. With --state a run goes on where it was
stopped. Ends with 1 where anything was found.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

from fuzz.trial import SHARES, SLOWEST_S, Trials


def main():
    """Run all, or one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, help="stop after so long; with --state to be continued")
    parser.add_argument("--state", type=Path)
    parser.add_argument("--one", nargs=3, metavar=("KIND", "NUMBER", "FILE"), help="write that file and read it")
    parser.add_argument("--work", nargs=3, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.work:
        _work(arguments.seed, *arguments.work)
        return 0
    if arguments.one:
        return _one(arguments.seed, *arguments.one)
    return _all(arguments)


def _one(seed, kind, number, path):
    with tempfile.TemporaryDirectory() as folder:
        trials = Trials(Path(folder), seed)
        Path(path).write_bytes(trials.data(kind, int(number))[1])
        print(trials.run(kind, int(number)))
    return 0


def _work(seed, kind, start, end):
    """In a process of its own: one line for each file, before it is read and after."""
    with tempfile.TemporaryDirectory() as folder:
        trials = Trials(Path(folder), seed)
        for number in range(int(start), int(end)):
            print(f"begin {number}", flush=True)
            outcome = trials.run(kind, number)
            print(json.dumps([outcome.state, outcome.seconds, outcome.megabytes]), flush=True)


def _all(arguments):
    end = time.monotonic() + 60 * arguments.minutes if arguments.minutes else None
    wanted = {kind: arguments.inputs * share // 100 for kind, share in SHARES.items()}
    state = {kind: {"done": 0, "counts": {}, "slowest": 0, "largest": 0, "faults": []} for kind in SHARES}
    if arguments.state and arguments.state.exists():
        state = json.loads(arguments.state.read_text())
    for kind, entry in state.items():
        while entry["done"] < wanted[kind] and (end is None or time.monotonic() < end):
            _batch(arguments.seed, kind, entry, min(wanted[kind], entry["done"] + 1000))
            if arguments.state:
                arguments.state.write_text(json.dumps(state))
    _print(state)
    return int(any(entry["faults"] for entry in state.values()))


def _batch(seed, kind, entry, end):
    """Read files up to a number; one that ends the process, or hangs it, is a fault, and the next is taken."""
    line = [sys.executable, "-m", "fuzz", "--seed", str(seed), "--work", kind, str(entry["done"]), str(end)]
    counts = Counter(entry["counts"])
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        timer = _Watch(process, 6 * SLOWEST_S)
        for said in process.stdout:
            timer.fed()
            if said.startswith("begin"):
                continue
            state, seconds, megabytes = json.loads(said)
            number, entry["done"] = entry["done"], entry["done"] + 1
            counts[state if state in ("read", "refused") else "fault"] += 1
            entry["slowest"] = max(entry["slowest"], seconds)
            entry["largest"] = max(entry["largest"], megabytes)
            if state not in ("read", "refused"):
                entry["faults"].append([number, state])
        timer.end()
        said = process.stderr.read()
        status = process.wait()
    if status:
        if not entry["done"] and "Error" in said:
            sys.exit(said)
        counts["fault"] += 1
        entry["faults"].append([entry["done"], f"ends the process ({status}): {said.strip().splitlines()[-1:]}"])
        entry["done"] += 1
    entry["counts"] = dict(counts)


class _Watch:
    """Kills a process that says nothing for too long."""

    def __init__(self, process, seconds):
        self._process, self._seconds = process, seconds
        self._timer = None
        self.fed()

    def fed(self):
        self.end()
        self._timer = threading.Timer(self._seconds, self._process.kill)
        self._timer.daemon = True
        self._timer.start()

    def end(self):
        if self._timer is not None:
            self._timer.cancel()


def _print(state):
    print(f"{'kind':<12}{'files':>8}{'read':>8}{'refused':>9}{'faults':>8}{'slowest':>10}{'most memory':>13}")
    total = Counter()
    for kind, entry in state.items():
        counts = Counter(entry["counts"])
        total.update(counts)
        print(
            f"{kind:<12}{entry['done']:>8}{counts['read']:>8}{counts['refused']:>9}{counts['fault']:>8}"
            f"{entry['slowest']:>8.2f} s{entry['largest']:>10.0f} MB"
        )
    print(f"{'all':<12}{total.total():>8}{total['read']:>8}{total['refused']:>9}{total['fault']:>8}")
    for kind, entry in state.items():
        for number, fault in entry["faults"]:
            print(f"{kind} {number}: {fault}")


if __name__ == "__main__":
    sys.exit(main())
