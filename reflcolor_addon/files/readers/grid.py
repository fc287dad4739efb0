"""The last step of every reader of scanners' files: from stored grids to a Scan that is upright and clean."""

from dataclasses import replace

import numpy as np

from ...errors import ScanError
from ...messages import Message, of_scan, without_file
from ...scan.limits import FARTHEST_M, NEAREST_M, STRONGEST
from ...scan.scan import HandedOver, Scan
from .grid_memory import in_order, strips
from .options import AS_IT_IS
from .reflectance import told_apart
from .settle import NO_GRID, NoGrid, Settled

BYTES_PER_PIXEL = 80
"""Peak memory of reading: the points, the other arrays and their upright copies, and some masks."""

_MOST_REASONS = 5
"""This many of the scans that are left out are listed one by one."""


class UnusableScan(ScanError):
    """One scan of a file cannot be used; others of the file may."""


def finish_scan(
    name, source, *, points, reflectance, valid, color, pose, warnings, places=None, origin=None, options=AS_IT_IS
):
    """Clean the grids that a file holds, turn them upright and make a Scan of them; see `finish_grid`."""
    return finish_grid(
        name,
        source,
        points=points,
        reflectance=reflectance,
        valid=valid,
        color=color,
        pose=pose,
        warnings=warnings,
        places=places,
        origin=origin,
        options=options,
    )[0]


def finish_grid(
    name, source, *, points, reflectance, valid, color, pose, warnings, places=None, origin=None, options=AS_IT_IS
):
    """Clean the grids that a file holds, turn them upright and make a Scan of them.

    Parameters
    ----------
    name : str
    source : Path
    points : (H, W, 3) float64
        In the scanner's frame, or another that the file counts in; exact zeros and numbers that are not finite are no
        returns. It may be changed.
    reflectance : (H, W) float32 or None
        None where the file has none.
    valid : (H, W) bool
    color : (H, W, 3) uint8 or None
    pose : (4, 4) float64
    warnings : list of str
        What was noticed so far.
    places : dict of str to (3,) float64, optional
        Where the scanner may have stood, in the frame of the points; see `Settled`.
    origin : (3,) float64, optional
        Where it did stand, if that is known.
    options : ReadOptions

    Returns
    -------
    Scan
    GridOrder
        The way from the stored grid to the scan's.

    Raises
    ------
    UnusableScan
        If no pixel has a return, or the points lie on no grid.
    """
    warnings = list(warnings)

    def warn(template, **values):
        warnings.append(of_scan(name, template, **values))

    measured, usable = _told_apart_by_size(points, valid)
    reflectance, color = told_apart(reflectance, color, measured, warn)
    usable &= np.abs(reflectance) < STRONGEST
    if lost := np.count_nonzero(measured) - np.count_nonzero(usable):
        warn(
            "{count:,} points hold a number that is not finite, far too large or far too small, and were taken as no "
            "return",
            count=lost,
        )
    if not usable.any():
        raise UnusableScan(
            "{file}: scan '{scan}' has no pixel with a return; there is nothing to import", file=source.name, scan=name
        )
    if lost or not measured.all():
        points[~usable] = 0.0
    try:
        settled = Settled(points, usable, pose, places or {}, origin, options, warn)
    except NoGrid:
        raise UnusableScan("{file}: scan '{scan}' {problem}", file=source.name, scan=name, problem=NO_GRID) from None
    if not settled.valid.any():
        raise UnusableScan(
            "{file}: scan '{scan}' has no pixel with a return; there is nothing to import", file=source.name, scan=name
        )
    try:
        scan = Scan(
            name=name,
            points=in_order(settled.points).view(HandedOver),
            reflectance=np.where(settled.valid, settled.order.of(reflectance), np.float32(0)),
            valid=settled.valid,
            color=settled.order.of(color),
            pose=settled.pose,
            source=source,
            warnings=tuple(warnings),
        )
    except ScanError as error:
        raise UnusableScan("{file}: {reason}", file=source.name, reason=error.message) from None
    return scan, settled.order


def _told_apart_by_size(points, valid):
    """(H, W) where there is a return at all, and where its coordinates can be used."""
    measured, usable = np.empty(valid.shape, bool), np.empty(valid.shape, bool)
    for rows in strips(valid.shape):
        x, y, z = (np.abs(points[rows, :, axis]) for axis in range(3))
        # NaN stays NaN.
        largest = np.maximum(np.maximum(x, y), z)
        np.logical_and(valid[rows], largest != 0, out=measured[rows])
        # The square of a smaller coordinate would underflow, and its range would be 0.
        usable[rows] = measured[rows] & (largest < FARTHEST_M) & (largest > NEAREST_M)
    return measured, usable


def with_problems(finished, problems, count, source):
    """The finished scans, the first of which says what the left out ones lack; an error if there are none."""
    if not problems:
        return finished
    reasons = [without_file(problem.message) for problem in problems]
    if not finished and count == 1:
        raise problems[0]
    if not finished:
        raise ScanError(
            "{file}: none of its {count} scans can be used: {reason}",
            file=source.name,
            count=count,
            reason=reasons[0],
        )
    left_out = [Message("left out: {reason}", reason=reason) for reason in reasons[:_MOST_REASONS]]
    if more := len(reasons) - len(left_out):
        left_out.append(Message("left out: {count:,} more scans, for similar reasons", count=more))
    return [replace(finished[0], warnings=finished[0].warnings + tuple(left_out)), *finished[1:]]
