"""One changed file read: what came of it, and whether that is allowed."""

import contextlib
import os
import random
import re
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

from fuzz.mutations import mutated
from fuzz.samples import samples
from reflcolor_addon.errors import ReflcolorError, UsageError
from reflcolor_addon.messages import LONGEST_LINE

SLOWEST_S = 5.0
"""By the clock; what takes longer is read twice more, and the quickest counts, so that a busy machine is no fault."""
MOST_BYTES = 300 << 20
"""Beyond what the file honestly needs, which for files of a few kilobytes is nothing beside this."""

SHARES = {
    "PTX": 12,
    "PCD": 8,
    "PLY": 9,
    "LAS": 4,
    "LAZ": 3,
    "NumPy": 8,
    "text": 4,
    "image pair": 7,
    "PNG": 5,
    "JPEG": 3,
    "WebP": 2,
}
SHARES |= {"BMP": 2, "TIFF": 8, "EXR": 5, "seeds": 4, "report": 3, "manifest": 1, "pairs": 1, "E57": 11}
"""Of a hundred files, how many are of a kind."""


@dataclass(frozen=True)
class Outcome:
    """What came of a file: "read", "refused", or the fault in one line."""

    kind: str
    number: int
    state: str
    seconds: float = 0.0
    megabytes: float = 0.0


class Trials:
    """Makes and reads changed files, each determined by its kind and number alone.

    Parameters
    ----------
    folder : Path
        Where the files are.
    seed : int
    """

    def __init__(self, folder, seed=1):
        self.folder, self._seed = folder, seed
        self.samples = samples(folder)
        self.kinds = list(self.samples)

    def data(self, kind, number):
        """Return the sample and the bytes of a changed file."""
        chance = random.Random(f"{self._seed} {kind} {number}")
        known = self.samples[kind]
        sample = chance.choice(known)
        return sample, mutated(kind, sample.data, [other.data for other in known], chance)

    def run(self, kind, number):
        """Read a changed file and return the `Outcome`."""
        sample, data = self.data(kind, number)
        path = self.folder / sample.name
        path.write_bytes(data)
        state, seconds, taken = _read(sample, path)
        for _ in range(2):
            if seconds > SLOWEST_S:
                seconds = min(seconds, _read(sample, path)[1])
        if state in ("read", "refused"):
            if seconds > SLOWEST_S:
                state = f"takes {seconds:.1f} s"
            elif taken > MOST_BYTES:
                state = f"takes {taken >> 20} MB"
        return Outcome(kind, number, state, seconds, taken / (1 << 20))


def _read(sample, path):
    """Read a file once; return "read", "refused" or a fault in one line, seconds, and bytes of memory."""
    before, children = _peak(reset=True), _children_peak()
    start = time.monotonic()
    with warnings.catch_warnings(), _listening() as heard:
        warnings.simplefilter("error")
        try:
            sample.read(path)
            state = "read"
        except (ReflcolorError, UsageError) as error:
            state = _fault_of(str(error)) or "refused"
        except Exception as error:
            trace = error.__traceback__
            while trace.tb_next is not None:
                trace = trace.tb_next
            place = f"{Path(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}"
            state = f"{type(error).__name__} at {place}: {error}"[:300]
    seconds = time.monotonic() - start
    taken = max(0, _peak() - before)
    # A child process counts whole, with what its parent had when it started; one below the largest so far is not
    # seen, and need not be.
    if _children_peak() > children:
        taken = max(taken, _children_peak())
    return (f"prints {heard[0][:200]!r}" if heard else state), seconds, taken


def _fault_of(line):
    if not line or len(line) > LONGEST_LINE or not line.isprintable():
        return f"an error that is no line of text: {line[:100]!r}"
    return "an error that quotes a traceback" if re.search(r"Traceback|object at 0x", line) else None


def _peak(*, reset=False):
    """The greatest memory that this process has had since the last reset, or since it began; 0 where unknown."""
    try:
        if reset:
            Path("/proc/self/clear_refs").write_text("5")
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) << 10
    except OSError:
        pass
    return 0


def _children_peak():
    """The greatest memory that any ended child process has had; 0 where unknown."""
    try:
        import resource
    except ImportError:
        return 0
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss << 10


@contextlib.contextmanager
def _listening():
    """Give a list that afterwards holds what was printed meanwhile, by native code, too."""
    heard, kept = [], [os.dup(1), os.dup(2)]
    sys.stdout.flush()
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield heard
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for number, copy in zip((1, 2), kept, strict=True):
                os.dup2(copy, number)
                os.close(copy)
            file.seek(0)
            if said := file.read():
                heard.append(said)
