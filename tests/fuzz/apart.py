"""Changed files read in a process of its own, as small as a user's.

Of a child process, the memory counts that its parent had when it started; a process that has run many tests has more
than a file may take.
"""

import contextlib
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from fuzz.trial import Trials

_trials = None


@contextlib.contextmanager
def outcomes_apart(folder, seed):
    """Give a function of a kind and a count, which returns the list of the `Outcome` of each of so many files."""
    with ProcessPoolExecutor(1, get_context("spawn"), _begin, (folder, seed)) as pool:
        yield lambda kind, count: pool.submit(_outcomes, kind, count).result()


def _begin(folder, seed):
    global _trials
    _trials = Trials(folder, seed)


def _outcomes(kind, count):
    return [_trials.run(kind, number) for number in range(count)]
