"""Points without a grid onto one that is laid over them by angle."""

import numpy as np

from ...errors import ScanError
from ...scan.angle_grid import grid_by_angle
from ...scan.cloud_position import position_of_cloud
from .grid import UnusableScan


def gridded_by_angle(header, points, valid, reflectance, color, named, options, warn):
    """Return stored grids of a list of points, and where each point went.

    Parameters
    ----------
    header : object with ``place``
        Values of messages: file and scan.
    points : (N, 3) float64
    valid : (N,) bool
    reflectance : (N,) float or None
    color : (N, 3) uint8 or None
    named : list of (3,) float64
        Where the scanner may have stood, as the file says; one that the person names is the only one.
    options : ReadOptions
    warn : callable
        Takes what `Message` takes.

    Returns
    -------
    arrays : dict
        ``points`` (as stored, not moved), ``reflectance``, ``valid``, ``color`` and ``origin``.
    cells : (N,) int64
        Pixel of every point in these grids, row by row; -1 where it is none.

    Raises
    ------
    UnusableScan
        If it is not known and not found where the scanner stood, or there are too few points.
    """
    usable = valid & (np.abs(points) < 1e9).all(axis=-1)
    if not usable.any():
        raise UnusableScan(
            "{file}: scan '{scan}' has no pixel with a return; there is nothing to import", **header.place
        )
    if options.position is not None:
        place = np.array(options.position) * 1.0
    else:
        place = position_of_cloud(points[usable], named)
    if place is None:
        raise UnusableScan(
            "{file}: scan '{scan}': the scanner's position is not known, and its points do not show it; give it with "
            "--position X Y Z, or Scanner Position in the import dialog",
            **header.place,
        )
    away = points[usable] - place
    try:
        grid = grid_by_angle(away)
    except ScanError as error:
        raise UnusableScan("{file}: scan '{scan}': {reason}", reason=error.message, **header.place) from None
    distance = np.einsum("ij,ij->i", away, away)
    pixel = grid.rows.astype(np.int64) * grid.shape[1] + grid.cols
    # The nearest of several points in one direction hides the others.
    order = np.lexsort((distance, pixel))
    first = np.concatenate([[True], np.diff(pixel[order]) != 0])
    taken, pixels = np.flatnonzero(usable)[order[first]], pixel[order[first]]
    warn(
        "a grid of {rows} x {columns} pixels was laid over its points by angle, as seen from {place}; {lost:,} points "
        "lie behind others and were left out",
        rows=grid.shape[0],
        columns=grid.shape[1],
        place="(" + " ".join(f"{number:.6g}" for number in place) + ")",
        lost=int(np.count_nonzero(usable)) - len(taken),
    )

    def spread(values):
        if values is None:
            return None
        laid = np.zeros((grid.shape[0] * grid.shape[1], *values.shape[1:]), values.dtype)
        laid[pixels] = values[taken]
        return laid.reshape(*grid.shape, *values.shape[1:])

    cells = np.full(len(points), -1, np.int64)
    cells[np.flatnonzero(usable)] = pixel
    arrays = {
        "points": spread(points),
        "reflectance": None if reflectance is None else spread(np.asarray(reflectance, np.float32)),
        "valid": spread(usable),
        "color": spread(color),
        "origin": place,
    }
    return arrays, cells
