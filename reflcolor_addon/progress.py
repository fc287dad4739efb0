"""Several pieces of long work as one."""


def in_turn(pieces):
    """Return ``work(progress, cancelled)`` that does pieces of work one after the other and returns their results.

    Parameters
    ----------
    pieces : dict of str to callable
        Each is called as ``piece(progress, cancelled)``; either may be None. Where there are several, each has an
        equal share of the progress, and its name stands before what it says.
    """

    def work(progress, cancelled):
        return [
            piece(_share(progress, number, len(pieces), name), cancelled)
            for number, (name, piece) in enumerate(pieces.items())
        ]

    return work


def _share(progress, number, count, name):
    """A ``progress(fraction, text)`` for one of ``count`` pieces."""
    if progress is None or count == 1:
        return progress
    return lambda fraction, text: progress((number + fraction) / count, f"{name}: {text}")
