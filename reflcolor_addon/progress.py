"""Progress of several pieces of work as that of one."""

from .messages import Message


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
