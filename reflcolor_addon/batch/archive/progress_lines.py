"""The progress of a batch, and how long it will still take."""

import time

# The expected speed weighs as much as having measured this share of the work.
_EXPECTED_COUNTS = 0.05


class WholeProgress:
    """Estimates how far a batch is, and the time left, from what was expected and from the work done so far.

    Parameters
    ----------
    expected : dict of str to float
        The cost of each stage, in their order, in seconds of one processor.
    workers : int
        How many processors work on it.
    """

    def __init__(self, expected, workers):
        self._left, self._workers = dict(expected), workers
        self._stage, self._step, self._done, self._shown = None, 0.0, 0.0, 0.0
        # Seconds by the clock in the steps that ended, and when the one at work began.
        self._worked, self._began = 0.0, None

    def begin(self, stage, cost, only=False):
        """Begin a step of a stage; the stages before it are at their end.

        Parameters
        ----------
        stage : str
        cost : float
        only : bool
            Whether the stage has no other step, so that ``cost`` replaces what was expected.
        """
        for other in self._left:
            if other == stage:
                break
            self._left[other] = 0.0
        if only:
            self._left[stage] = cost
        self._stage, self._step = stage, cost
        self._began = time.monotonic()

    def pause(self):
        """End a step: what is done before the next one, such as reading files to compare them, is not timed."""
        self._worked += time.monotonic() - self._began
        self._began = None

    def end(self):
        """End the work; nothing is left."""
        self._left, self._step = {}, 0.0

    def expect_less(self, stage, cost):
        """Take out of a stage that has not ended what was done in an earlier run."""
        self._left[stage] = max(self._left.get(stage, 0.0) - cost, 0.0)

    def add(self, cost):
        """Count what was done."""
        self._done += cost
        self.drop(cost)

    def drop(self, cost):
        """Take out what need not be done."""
        self._step -= cost
        self.expect_less(self._stage, cost)

    def share(self, running=0.0):
        """Return how much is done, 0 to 1, and never less than before; ``running`` is what was done of what is not
        finished yet."""
        done, whole = self._counted(running)
        self._shown = min(max(self._shown, done / whole if whole > 0 else 1.0), 1.0)
        return self._shown

    def text(self, running=0.0):
        """Return the time left in words."""
        done, whole = self._counted(running)
        expected = max(_EXPECTED_COUNTS * whole, 1e-9)
        worked = self._worked + (0.0 if self._began is None else time.monotonic() - self._began)
        each = (worked + expected / self._workers) / (done + expected)
        return f"{duration(each * max(whole - done, 0.0))} left"

    def _counted(self, running):
        """What is done, and the whole, as far as it is known."""
        left = sum(self._left.values()) + max(self._step - self._left.get(self._stage, 0.0), 0.0)
        return self._done + running, self._done + left


def duration(seconds):
    """Return seconds in words: "40 s", "3 min", "2 h 5 min"."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
