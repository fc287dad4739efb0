"""Lays a grid over points that have none, by the angles at which the scanner saw them."""

from dataclasses import dataclass

import numpy as np

from ..errors import ScanError
from ..messages import Message
from .grid_health import neighbor_share

_SAMPLES = 1 << 16
_FEWEST = 30
_FULL = 0.8
"""Share of returns that have neighbors in a grid that is fine enough but not too fine."""

_FINER = 1.1
"""Factor from one try to the next."""

_PERIODS = 32
"""Steps of a lattice in the first search; more would need finer tries."""

_SHARP = 0.1
"""How sharp the lattice of angles must be, 0 to 1, to be accepted; noise of a third of a step leaves 0.12."""

_ABOVE_CHANCE = 5.0
"""How many times sharper it must be than that of random points."""

_ASPECTS = np.geomspace(1 / 8, 8, 13)

_FEWEST_RINGS, _MOST_RINGS = 8, 256
_CLEAR_GAP = 3.0
_MULTIPLES = ((1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (1, 3), (3, 2), (2, 3), (3, 3))
_MOST_LINES = 65536
_FEW_PIXELS, _MOST_PER_POINT = 1 << 21, 64
"""A grid has at most so many pixels, or so many for each point: others would be all but empty."""

_WAY = Message("check the scanner's position, and the step if one was given")
_FULL_TURN_GAP_DEG = 12.0


@dataclass(frozen=True, eq=False, kw_only=True)
class AngleGrid:
    """Where points belong in a grid of equal angles.

    Parameters
    ----------
    rows, cols : (N,) int32
        Row 0 is the top, columns run from left to right as seen from the scanner.
    shape : (H, W)
    step_deg : (vertical, horizontal) of float
    """

    rows: np.ndarray
    cols: np.ndarray
    shape: tuple[int, int]
    step_deg: tuple[float, float]


def grid_by_angle(points, *, step_deg=None):
    """Lay a grid of equal angles over points.

    The steps are the scanner's own where its lattice still shows in the angles; else as fine as leaves few holes.

    Parameters
    ----------
    points : (N, 3) float64
        Measured from the scanner, Z up; none of them at the scanner itself.
    step_deg : float, optional
        The step, both ways, if it is known.

    Returns
    -------
    AngleGrid

    Raises
    ------
    ScanError
        If there are too few points, or they lie in one direction.
    """
    level = np.hypot(points[:, 0], points[:, 1])
    elevation = np.degrees(np.arctan2(points[:, 2], level))
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    if len(points) < _FEWEST:
        raise ScanError("{count} points are too few for a grid by angle", count=len(points))
    left = _left_edge(azimuth)
    # To the right from the left edge.
    along = (left - azimuth) % 360.0
    down = elevation.max() - elevation
    # Angles at the edge may be off by a full turn.
    along[along > 360.0 - 1e-9] = 0.0
    if np.ptp(along) == 0 or np.ptp(down) == 0:
        raise ScanError("the points lie in one line as seen from the scanner; there is no grid to lay over them")
    if step_deg is not None:
        steps = (_Lattice(step_deg, 0.0), _Lattice(step_deg, 0.0))
    else:
        guesses = _steps_by_filling(down, along)
        rings = _rings(down)
        lattices = [_lattice(angles, guess) for angles, guess in zip((down, along), guesses, strict=True)]
        steps = tuple(lattice or _Lattice(guess, 0.0) for lattice, guess in zip(lattices, guesses, strict=True))
        uneven = rings is not None and lattices[0] is None
        steps = (rings, steps[1]) if uneven else _joined(steps, down, along)
    rows, cols = (step.numbers(angles) for step, angles in zip(steps, (down, along), strict=True))
    shape = _shape(rows, cols)
    if shape[0] * shape[1] > _most_pixels(points):
        raise ScanError(
            "a grid by angle would have {rows:,} x {columns:,} pixels for {count:,} points; {way}",
            rows=shape[0],
            columns=shape[1],
            count=len(points),
            way=_WAY,
        )
    return AngleGrid(rows=rows, cols=cols, shape=shape, step_deg=(steps[0].step, steps[1].step))


def _shape(rows, cols):
    return int(rows.max()) + 1, int(cols.max()) + 1


def _most_pixels(points):
    return max(_FEW_PIXELS, _MOST_PER_POINT * len(points))


@dataclass(frozen=True)
class _Lattice:
    """Equal steps: numbers are 0 at ``first``."""

    step: float
    first: float

    def times(self, count):
        """Return the lattice of every so many steps."""
        return _Lattice(self.step * count, self.first)

    def numbers(self, angles):
        numbers = np.rint((angles - self.first) / self.step)
        numbers -= numbers.min()
        # Points in next to one direction and some opposite to them have steps too small for the angle between.
        if numbers.max() >= _MOST_LINES:
            raise ScanError(
                "a grid by angle would have more than {most:,} rows or columns; {way}", most=_MOST_LINES, way=_WAY
            )
        return numbers.astype(np.int32)


@dataclass(frozen=True, eq=False)
class _Rings:
    """Rows of uneven steps, as the beams of a spinning lidar have: numbers count the borders above."""

    step: float
    borders: np.ndarray

    def numbers(self, angles):
        return np.searchsorted(self.borders, angles).astype(np.int32)


def _rings(down):
    """The _Rings that angles gather in; None where they spread evenly."""
    every = max(1, len(down) // _SAMPLES)
    ordered = np.sort(down[::every])
    gaps = np.diff(ordered)
    order = np.argsort(gaps)[::-1][: 2 * _MOST_RINGS]
    widest = gaps[order]
    # The gaps between rings are wider than any within one.
    falls = widest[:-1] / np.maximum(widest[1:], 1e-9)
    count = int(np.argmax(falls[_FEWEST_RINGS - 2 :])) + _FEWEST_RINGS - 1 if len(falls) >= _FEWEST_RINGS else 0
    if not _FEWEST_RINGS - 1 <= count < _MOST_RINGS or falls[count - 1] < _CLEAR_GAP:
        return None
    places = np.sort(order[:count])
    return _Rings(float(np.median(np.diff(ordered[places]))), (ordered[places] + ordered[places + 1]) / 2)


def _left_edge(azimuth):
    """Where the columns begin: left of the widest gap; straight behind for a full turn."""
    ordered = np.sort(azimuth)
    gaps = np.diff(np.append(ordered, ordered[0] + 360.0))
    widest = int(np.argmax(gaps))
    return 180.0 if gaps[widest] < _FULL_TURN_GAP_DEG else float(ordered[widest])


def _steps_by_filling(down, along):
    """The finest steps (vertical, horizontal) with which most returns have neighbors."""
    # A contiguous part gives the same answer as the whole.
    share = min(1.0, _SAMPLES / len(along))
    middle, half = np.median(along), np.ptp(along) * share / 2
    part = np.abs(along - middle) <= half
    if np.ptp(along[part]) == 0 or np.ptp(down[part]) == 0:
        part[:] = True
    down, along = (angles[part] - angles[part].min() for angles in (down, along))
    best, most = None, 0
    for aspect in _ASPECTS:
        steps, cells = _filled_steps(down, along, aspect)
        if cells > most:
            best, most = steps, cells
    return best


def _filled_steps(down, along, aspect):
    """Such steps of a given width over height, and how many pixels hold a return then."""
    step = np.sqrt(np.ptp(along) * np.ptp(down) / len(along)) / 2
    if step == 0:
        # The product is too small for a float, its factors are not.
        step = np.sqrt(np.ptp(along)) * np.sqrt(np.ptp(down)) / len(along)
    while True:
        steps = float(step / np.sqrt(aspect)), float(step * np.sqrt(aspect))
        # Almost in one line, points would otherwise have more rows or columns than can be counted.
        steps = max(steps[0], np.ptp(down) / _MOST_LINES), max(steps[1], np.ptp(along) / _MOST_LINES)
        rows, cols = ((angles / size).astype(np.int64) for angles, size in zip((down, along), steps, strict=True))
        filled = np.zeros((rows.max() + 1, cols.max() + 1), bool)
        filled[rows, cols] = True
        if neighbor_share(filled) >= _FULL or min(filled.shape) < 4:
            return steps, np.count_nonzero(filled)
        step *= _FINER


def _joined(steps, down, along):
    """The finest multiples of the steps that leave few holes: some scanners shift every other line by half a step."""
    best, most = steps, 0
    for by_row, by_col in _MULTIPLES:
        tried = steps[0].times(by_row), steps[1].times(by_col)
        try:
            rows, cols = tried[0].numbers(down), tried[1].numbers(along)
        except ScanError:
            continue
        shape = _shape(rows, cols)
        if shape[0] * shape[1] > _most_pixels(down):
            continue
        filled = np.zeros(shape, bool)
        filled[rows, cols] = True
        cells = np.count_nonzero(filled)
        if cells > most and neighbor_share(filled) >= _FULL:
            best, most = tried, cells
    return best


def _lattice(angles, guess):
    """The _Lattice that angles lie on, with steps of about a guess; None where they lie on none."""
    every = max(1, len(angles) // _SAMPLES)
    angles = np.sort(angles[::every])
    low, span = angles[0], angles[-1] - angles[0]
    width = _PERIODS * guess
    steps = guess * np.geomspace(0.25, 4, 3000)
    best = None
    while True:
        start = low + max(0.0, span - width) / 2
        inside = angles[np.searchsorted(angles, start) : np.searchsorted(angles, start + width)]
        if len(inside) < _FEWEST:
            return None
        sharpness, phases = _sharpness(inside - start, steps)
        # Half a lattice's step is as sharp as the step itself; the widest step is the right one.
        best = int(np.flatnonzero(sharpness >= 0.95 * sharpness.max()).max())
        if sharpness[best] < max(_SHARP, _ABOVE_CHANCE / np.sqrt(len(inside))):
            return None
        step, first = steps[best], start + phases[best] * steps[best]
        if width >= span:
            return _Lattice(float(step), float(first))
        width = min(2 * width, span)
        steps = step * np.linspace(1 - 0.5 * step / width, 1 + 0.5 * step / width, 201)


def _sharpness(angles, steps):
    """For every step how nearly the angles are a whole number of them apart, 0..1, and where they start, in steps."""
    found = np.empty(len(steps), complex)
    for number, step in enumerate(steps):
        found[number] = np.exp(2j * np.pi * angles / step).mean()
    return np.abs(found), np.angle(found) / (2 * np.pi)
