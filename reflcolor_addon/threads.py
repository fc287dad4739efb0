"""The number of threads that the work may use, and how soon they let others run."""

import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

# Seconds after which Python lets a waiting thread run.
_SOON_S = 0.0005

_limit = None
_considerate, _usual_s = 0, 0.0
_lock = threading.Lock()


def thread_count():
    """Return how many threads the work may use: as many as this process has processors, or fewer if it was limited."""
    return _limit or _processors()


def limit_threads(count):
    """Let the work in this process use no more than so many threads; results do not depend on it."""
    global _limit
    import cv2

    _limit = max(1, count)
    cv2.setNumThreads(_limit)


def in_threads(function, items):
    """Yield what ``function`` returns for each of ``items``, in their order, computed in as many threads as allowed.

    What was not begun when the caller ends early is not begun any more.
    """
    if thread_count() == 1:
        yield from map(function, items)
        return
    with ThreadPoolExecutor(thread_count(), "reflcolor") as pool:
        futures = [pool.submit(function, item) for item in items]
        try:
            for future in futures:
                yield future.result()
        finally:
            for future in futures:
                future.cancel()


@contextmanager
def letting_others_run():
    """While threads work within it, let another thread that waits to run Python do so ten times sooner than usual.

    A window's thread waits for its turn whenever it begins to run Python, dozens of times to draw a panel: by Python's
    usual 5 ms a turn the window would stand still for tenths of a second.
    """
    global _considerate, _usual_s
    with _lock:
        if not _considerate:
            _usual_s = sys.getswitchinterval()
            sys.setswitchinterval(_SOON_S)
        _considerate += 1
    try:
        yield
    finally:
        with _lock:
            _considerate -= 1
            if not _considerate:
                sys.setswitchinterval(_usual_s)


def _processors():
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # Windows, macOS
        return os.cpu_count() or 1
