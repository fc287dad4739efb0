"""How long work reports its progress and is cancelled; the progress of several pieces of work as one."""

from collections.abc import Callable

from .messages import Message

Progress = Callable[[float, str], object]
"""``progress(fraction, text)``, called now and then with a fraction of 0 to 1."""
IsCancelled = Callable[[], bool]
"""``cancelled()``, asked now and then; when it returns True, the work ends with `Cancelled`."""


def part(progress, number, count, name):
    """Return the ``progress(fraction, text)`` of one of several equal pieces of work.

    Parameters
    ----------
    progress : callable or None
        That of all of them; with None, nothing is told.
    number : int
        Which piece, from 0.
    count : int
        How many there are. Where it is one, it tells what it tells alone.
    name : str
        Stands before what it tells.
    """
    if progress is None or count == 1:
        return progress
    return lambda fraction, text: progress((number + fraction) / count, Message("{name}: {text}", name=name, text=text))
