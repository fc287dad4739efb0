"""The number of threads that the work may use."""

import os

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


def _processors():
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # Windows, macOS
        return os.cpu_count() or 1
