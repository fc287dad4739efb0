"""The last step of every reader of scanners' files: from stored grids to a Scan that is upright and clean."""

from dataclasses import replace

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ...scan.limits import FARTHEST_M, NEAREST_M, STRONGEST
from ...scan.orientation import AS_STORED, infer_turn
from ...scan.scan import Scan

BYTES_PER_PIXEL = 120
"""What reading takes at its worst moment: the stored arrays, their upright copies and a mask or two."""

_FARTHEST_RETURN_M = 20_000.0
"""No terrestrial scanner measures farther; points beyond are geo-referenced."""

_MOST_TOLD = 5
"""So many of the scans that are left out are told one by one."""

_GRAY_SHARE = 0.999
"""Share of equal channels that makes a color image a gray one; a stray pixel is no color."""


class UnusableScan(ScanError):
    """One scan of a file cannot be used; others of the file may."""


def finish_scan(name, source, *, points, reflectance, valid, color, pose, warnings):
    """Clean the grids that a file holds, turn them upright and make a Scan of them.

    Parameters
    ----------
    name : str
    source : Path
    points : (H, W, 3) float64
        In the scanner's frame; exact zeros and numbers that are not finite are no returns.
    reflectance : (H, W) float32 or None
        None where the file has none: a gray color image then takes its place.
    valid : (H, W) bool
    color : (H, W, 3) uint8 or None
    pose : (4, 4) float64
    warnings : list of str
        What was noticed so far.

    Returns
    -------
    Scan

    Raises
    ------
    ScanError
        If no pixel has a return, or nothing in the file can serve as reflectance.
    """
    warnings = list(warnings)

    def warn(template, **values):
        warnings.append(Message("scan '{scan}': " + template, scan=name, **values))

    measured = valid & (points != 0).any(axis=-1)
    reflectance, color = _told_apart(reflectance, color, measured, name, warn, source)
    usable = measured & (np.abs(points) < FARTHEST_M).all(axis=-1) & (np.abs(reflectance) < STRONGEST)
    # A square of such a coordinate is no number any more, so that its range would be none.
    usable &= (np.abs(points) > NEAREST_M).any(axis=-1)
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

    nearest = _nearest(points, usable)
    if nearest > _FARTHEST_RETURN_M:
        warn(
            "every point is more than {distance:,.0f} km from the scanner's origin: the file holds world coordinates, "
            "so ranges and orientation mean little; rows and columns stay as stored",
            distance=nearest / 1000,
        )
        turn = AS_STORED
    else:
        turn = infer_turn(points, usable)
        if not turn.certain:
            warn("its points do not show which way is up; flip it if it looks wrong")
    return Scan(
        name=name,
        points=turn.of(points),
        reflectance=turn.of(np.where(usable, reflectance, np.float32(0))),
        valid=turn.of(usable),
        color=turn.of(color),
        pose=pose,
        source=source,
        warnings=tuple(warnings),
    )


def _nearest(points, usable):
    """Least distance from the scanner, metres."""
    chosen = points[usable]
    return np.sqrt(np.einsum("ij,ij->i", chosen, chosen).min())


def gray_is_no_color(color, valid):
    """True where red, green and blue are the same: an intensity stored as a color, or nothing stored at all."""
    seen = color[valid]
    equal = (seen[:, 0] == seen[:, 1]) & (seen[:, 0] == seen[:, 2])
    return np.count_nonzero(equal) >= _GRAY_SHARE * len(seen)


def _told_apart(reflectance, color, valid, name, warn, source):
    """Some files store the intensity as three equal colors: it is no color, and may be the only intensity there is."""
    if color is not None and gray_is_no_color(color, valid):
        gray, color = color[..., 0], None
        if gray[valid].any():
            if reflectance is None or (np.ptp(reflectance[valid]) == 0 and np.ptp(gray[valid]) > 0):
                warn("no intensity but gray colors; they are taken as the intensity")
                reflectance = gray.astype(np.float32)
            else:
                warn("its colors are gray (red = green = blue); taken as a scan without color")
    if reflectance is None:
        raise UnusableScan(
            "{file}: scan '{scan}' has no intensity, which is what is colorized; export it with intensity",
            file=source.name,
            scan=name,
        )
    return reflectance, color


def finish_scans(stored, source, *, cancelled=None):
    """Finish every scan of a file; leave out those that cannot be used, and say so, unless there is no other.

    Parameters
    ----------
    stored : list of dict
        Keyword arguments of `finish_scan` (all but `source`). Emptied on the way, so that memory is given back.
    source : Path
    cancelled : callable, optional

    Returns
    -------
    list of Scan

    Raises
    ------
    ScanError
        The reason of the first scan, if none can be used.
    Cancelled
        If `cancelled()` returned True.
    """
    finished, problems, count = [], [], len(stored)
    while stored:
        if cancelled and cancelled():
            raise Cancelled
        try:
            finished.append(finish_scan(source=source, **stored.pop(0)))
        except UnusableScan as error:
            problems.append(error)
    return with_problems(finished, problems, count, source)


def with_problems(finished, problems, count, source):
    """The finished scans, the first of which says what the left out ones lack; an error if there are none."""
    if not problems:
        return finished
    reasons = [_without_file(problem.message) for problem in problems]
    if not finished and count == 1:
        raise problems[0]
    if not finished:
        raise ScanError(
            "{file}: none of its {count} scans can be used: {reason}",
            file=source.name,
            count=count,
            reason=reasons[0],
        )
    left_out = [Message("left out: {reason}", reason=reason) for reason in reasons[:_MOST_TOLD]]
    if more := len(reasons) - len(left_out):
        left_out.append(Message("left out: {count:,} more scans, for such reasons", count=more))
    return [replace(finished[0], warnings=finished[0].warnings + tuple(left_out)), *finished[1:]]


def _without_file(message):
    """What a message says behind the name of the file."""
    template = message.template.removeprefix("{file}: ")
    return Message(template, **message.values) if template != message.template else message
