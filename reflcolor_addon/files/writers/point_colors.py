"""The color of every point of a scanned file, in the file's own order, for copies that get colors."""

import numpy as np

from ...errors import OutputError
from ..readers.grid import UnusableScan


def colors_of_points(scans, colors, path, source):
    """Yield what each scan of a file gets.

    Parameters
    ----------
    scans : iterable
        As a reader's ``each_scan`` gives them: (scan, order, cells) for each scan of the file.
    colors : dict of int to (H, W, 3) uint8
        By the number of the scan among those that can be used, from 0.
    path, source : Path
        The copy and the file, for messages.

    Yields
    ------
    index : int
        The scan's place in the file, from 0.
    scan : Scan
    rgb : (N, 3) uint8
        Of every point; 0 where it has no color.
    known : (N,) bool
        Whether it has one. A scan that was given no colors is left out.

    Raises
    ------
    OutputError
        If a scan's size is no longer that of its colors, or the file has no such scan.
    """
    number = -1
    for index, (scan, order, cells) in enumerate(scans):
        if isinstance(scan, UnusableScan):
            continue
        number += 1
        rgb = colors.get(number)
        if rgb is None:
            continue
        if rgb.shape[:2] != scan.shape:
            raise OutputError("{file}: {source} has changed since its scans were read", file=path, source=source.name)
        places = cells()
        there = places >= 0
        pixels = np.full(len(places), -1, np.int64)
        pixels[there] = order.pixels(*np.divmod(places[there], order.stored[1]))
        known = (pixels >= 0) & scan.valid.ravel()[pixels]
        found = np.zeros((len(places), 3), np.uint8)
        found[known] = rgb.reshape(-1, 3)[pixels[known]]
        yield index, scan, found, known
    if max(colors, default=-1) > number or min(colors, default=0) < 0:
        raise OutputError("{file}: {source} has changed since its scans were read", file=path, source=source.name)
