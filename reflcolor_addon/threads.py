"""The number of threads that the work may use."""

import os
from concurrent.futures import ThreadPoolExecutor

_limit = None


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


def _processors():
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # Windows, macOS
        return os.cpu_count() or 1
