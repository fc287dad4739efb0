"""Lines of numbers, read by the kernel."""

import numpy as np

from .library import BAD_VALUE, OK, address, check, library


def read_numbers(text, start, most_lines, width, room=None):
    """Read lines of numbers as far as they are plainly written, each rounded as `float` rounds it.

    Parameters
    ----------
    text : bytes
        Lines end in LF.
    start : int
        Where in it the first line begins.
    most_lines : int
    width : int
        Numbers in a line; lines without any are passed over.
    room : (N,) float64, optional
        Memory for the numbers; where it is too small, or missing, new memory is taken.

    Returns
    -------
    values : (n, width) float64
        A view of ``room``, or of new memory.
    lines : int
        How many were read.
    end : int
        Where in the text the next line begins: one that is of another make, or that there was no room for.
    """
    data = np.frombuffer(text, np.uint8)[start:]
    # No number is shorter than a digit and what parts it from the next.
    lines = min(most_lines, data.size // (2 * width) + 1)
    if room is None or room.size < lines * width:
        room = np.empty(lines * width)
    values = room[: lines * width].reshape(lines, width)
    read = np.zeros(3, np.int64)
    code = library().rc_numbers(data.size, address(data), len(values), width, address(values), address(read))
    check(OK if code == BAD_VALUE else code)
    lines, rows, size = read.tolist()
    return values[:rows], lines, start + size
