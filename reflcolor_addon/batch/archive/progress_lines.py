"""The progress of a batch, and how long it will still take."""

import time


class TimeLeft:
    """Estimates the remaining time from the work done so far.

    Parameters
    ----------
    whole : float
        The cost of everything, in any unit.
    """

    def __init__(self, whole):
        self._whole, self._done, self._start = max(whole, 1e-9), 0.0, time.monotonic()

    def add(self, cost):
        """Count what was done."""
        self._done += cost

    def drop(self, cost):
        """Take out what need not be done."""
        self._whole = max(self._whole - cost, 1e-9)

    def share(self, running=0.0):
        """Return how much is done, 0 to 1; ``running`` is what was done of what is not finished yet."""
        return min((self._done + running) / self._whole, 1.0)

    def text(self, running=0.0):
        """Return the remaining time in words; an empty text while it cannot be estimated."""
        share = self.share(running)
        if share < 0.01:
            return ""
        return f"{duration((time.monotonic() - self._start) * (1 - share) / share)} left of this step"


def duration(seconds):
    """Return seconds in words: "40 s", "3 min", "2 h 5 min"."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
