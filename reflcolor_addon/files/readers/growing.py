"""Arrays that are filled piece by piece, in the smallest type that holds all their values."""

import numpy as np


class Growing:
    """An array of at most so many rows.

    Parameters
    ----------
    shape : tuple of int
        The most that it can have; memory is taken as it is filled.
    dtype : dtype
        What the values are expected to be.
    """

    def __init__(self, shape, dtype):
        self._values, self._filled = np.empty(shape, dtype), 0

    def add(self, values, *, exactly=False):
        """Add rows.

        Parameters
        ----------
        values : (n, ...) array
        exactly : bool
            Take a wider type, for all of them, as soon as the expected one cannot hold these; else they are rounded.
        """
        here = slice(self._filled, self._filled + len(values))
        with np.errstate(over="ignore", invalid="ignore"):
            np.copyto(self._values[here], values, casting="unsafe")
        if exactly and not np.array_equal(self._values[here], values) and self._values.dtype != np.float64:
            wider = np.empty(self._values.shape)
            wider[: here.start], wider[here] = self._values[: here.start], values
            self._values = wider
        self._filled = here.stop

    def whole(self):
        """Return what it was filled with."""
        return self._values[: self._filled]
