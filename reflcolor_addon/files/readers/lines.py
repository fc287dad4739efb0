"""Rows and columns of points that only say in which line they are."""

import numpy as np

_FEWEST_LINES = 2


def indices_of_lines(stored, header):
    """Return (N,) rows and (N,) columns, or None where the points tell no lines.

    Parameters
    ----------
    stored : dict of (N,) float64
        ``rowIndex`` or ``columnIndex``, where the file has one of them.
    header : E57Header
        Its groups say which points follow each other in a line.
    """
    name = next(iter(stored), header.grouped_by)
    if name is None:
        return None
    if name in stored:
        line, place = _from_index(stored[name])
    else:
        line, place = _from_groups(header.groups, header.count)
    if line is None:
        return None
    return (line, place) if name == "rowIndex" else (place, line)


def _from_groups(groups, count):
    """(N,) number of the line that each point is in, and its place in it."""
    start, size = (groups[name].astype(np.int64) for name in ("startPointIndex", "pointCount"))
    whole = (start >= 0) & (size >= 0) & (start + size <= count)
    if not whole.all() or size.sum() != count or len(start) < _FEWEST_LINES:
        return None, None
    line, place = np.full(count, -1.0), np.zeros(count)
    for number, (first, length) in enumerate(zip(start.tolist(), size.tolist(), strict=True)):
        line[first : first + length] = groups["idElementValue"][number]
        place[first : first + length] = np.arange(length)
    return (None, None) if (line < 0).any() else (line, place)


def _from_index(index):
    """The same, of one index alone: within a line it stays the same, or counts up or down until it starts anew."""
    steps = np.diff(index)
    same = np.count_nonzero(steps == 0)
    if same > len(steps) / 2:
        # The index numbers the lines.
        starts = np.concatenate([[0], np.flatnonzero(steps != 0) + 1])
        place = np.arange(len(index)) - np.repeat(starts, np.diff(np.append(starts, len(index))))
        return index, place.astype(np.float64)
    # The index is the place in the line: where it jumps back, the next line begins.
    forward = np.median(steps) > 0
    breaks = steps <= 0 if forward else steps >= 0
    other = np.concatenate([[0], np.cumsum(breaks)]).astype(np.float64)
    return (None, None) if other[-1] < _FEWEST_LINES - 1 else (index, other)
