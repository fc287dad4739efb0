"""From stored points to a scanner's grid: the scanner's position, the unit, which way is up, and whether there is a
grid at all. Headers are not trusted alone; the points decide.
"""

import math

import numpy as np

from ...messages import Message
from ...scan.coherence import is_cut_anywhere, is_unordered
from ...scan.grid_health import coarser, compacted
from ...scan.orientation import AS_STORED, Z_UP, frame_with_up, infer_turn, up_of_camera
from ...scan.origin import better_origin, repeated_point
from ...scan.units import MILLIMETRE, counts_millimeters, scale_of_pose
from .grid_memory import strips
from .grid_order import GridOrder
from .options import AUTO, BY_ANGLE, UNITS

_FARTHEST_RETURN_M = 20_000.0
"""No terrestrial scanner measures farther; points beyond are geo-referenced."""

_NEAREST_M = 0.02
"""Half of the returns are never nearer."""

_SAMPLE = 1 << 16
_FEWEST = 1 << 10
"""Returns; where a sample has fewer, all are looked at."""
_NEARLY_UP = 0.7


NO_GRID = Message(
    "has no grid: points that are neighbors by their numbers are not neighbors in space. Export it with rows and "
    "columns (structured E57, PTX), or {way}",
    way=BY_ANGLE,
)
NO_ROWS = Message(
    "has no grid: its points have neither rows nor columns. Export it with rows and columns (structured E57, PTX), or "
    "{way}",
    way=BY_ANGLE,
)


class NoGrid(Exception):
    """The points of a scan lie on no grid."""


class Settled:
    """A scan's points in the scanner's frame, Z up, in meters, on a whole and upright grid.

    Parameters
    ----------
    points : (H, W, 3) float64
        As stored; changed in place.
    valid : (H, W) bool
        Where there is a return that can be used; changed in place.
    pose : (4, 4) float64
        Stored points to world.
    places : dict of str to (3,) float64
        Where the scanner may have stood, in the frame of the points: ``"position"`` of a header, ``"matrix"``.
    origin : (3,) float64 or None
        Where it did stand, if that is known; what the person says goes before.
    options : ReadOptions
    warn : callable
        Takes what `Message` takes.

    Attributes
    ----------
    points, valid, pose
        What has come of them, points and mask on the new grid.
    order : GridOrder
        For all other arrays.

    Raises
    ------
    NoGrid
        If the points lie on no grid.
    """

    def __init__(self, points, valid, pose, places, origin, options, warn):
        self.points, self.valid, self.pose = points, valid, pose
        self._places = {name: np.asarray(place, np.float64) for name, place in places.items()}
        self._origin, self._options, self._warn = origin, options, warn
        if options.position is not None:
            self._origin = np.array(options.position, np.float64)
        self.order = GridOrder(valid.shape)
        self._leave_out_repeated()
        if not self.valid.any():
            return
        self._scale()
        self._make_whole()
        self._find_scanner()
        if is_cut_anywhere(self.points, self.valid):
            raise NoGrid
        self._turn_upright()
        self._by_hand()

    def _leave_out_repeated(self):
        """Some programs write the scanner's position, or any other point, where there is no return."""
        place = repeated_point(self._sample())
        if place is None:
            return
        repeated = self.valid & (self.points == place).all(axis=-1)
        self.valid &= ~repeated
        self._places.setdefault("repeated", place)
        self._warn(
            "{count:,} pixels repeat one and the same point, {place}, and were taken as no return",
            count=np.count_nonzero(repeated),
            place=numbers(place),
        )

    def _scale(self):
        """Bring the points, and with them the pose, to meters."""
        scale, before = scale_of_pose(self.pose), self.points
        self.points, self.pose = scaled_by_pose(self.points, self.pose, self.valid, self._warn)
        if self.points is not before:
            self._places = {name: place * scale for name, place in self._places.items()}
            self._origin = None if self._origin is None else self._origin * scale
        if self._options.unit != AUTO:
            self._count(UNITS[self._options.unit])

    def _count(self, meters):
        if meters != 1.0:
            self.points *= meters
            self.pose = self.pose.copy()
            self.pose[:3, 3] *= meters
            self._places = {name: place * meters for name, place in self._places.items()}
            self._origin = None if self._origin is None else self._origin * meters

    def _make_whole(self):
        """Close gaps in the numbering, make a thinned grid coarser, and check that it is a grid at all."""
        if cells := compacted(self.valid):
            self._regrid(cells)
            self._warn(
                "its row numbers go up by {rows} and its column numbers by {columns}; the gaps were closed",
                rows=cells.stride[0],
                columns=cells.stride[1],
            )
        if is_unordered(self.points, self.valid):
            raise NoGrid
        before = np.count_nonzero(self.valid)
        try:
            cells = coarser(self.valid)
        except ValueError:
            raise NoGrid from None
        if cells:
            self._regrid(cells)
            self._warn(
                "was thinned out: {share:.0%} of its pixels hold a point; {stride} x {stride} of them were made one, "
                "and {lost:,} points left out",
                share=before / (self.order.shape[0] * self.order.shape[1] * cells.stride[0] ** 2),
                stride=cells.stride[0],
                lost=before - np.count_nonzero(self.valid),
            )

    def _regrid(self, cells):
        step = GridOrder(self.valid.shape)
        step.closed_up(cells, self.valid)
        self.order.closed_up(cells, self.valid)
        self.points, self.valid = step.of(self.points), step.of(self.valid)

    def _find_scanner(self):
        """Measure the points from the scanner, with Z up or the camera's up."""
        if self._origin is not None:
            self._move(self._origin)
            self._camera = up_of_camera(self.points, self.valid)
        else:
            self._camera = up_of_camera(self.points, self.valid)
            if self._camera is None:
                self._find_place()
        if self._options.unit == AUTO and counts_millimeters(self._sample(), camera=self._camera is not None):
            self._count(MILLIMETRE)
            self._warn("its coordinates count millimeters; they were brought to meters")

    def _find_place(self):
        found = better_origin(self.points, self.valid, self._places)
        if found is None:
            return
        kind, origin = found
        if kind == "matrix":
            # The points are already transformed by the pose: they are transformed back.
            inverse = np.linalg.inv(self.pose[:3, :3])
            for rows in strips(self.valid.shape):
                self.points[rows] = (self.points[rows] - self.pose[:3, 3]) @ inverse.T
            self._warn("its points are in world coordinates already; its pose is not applied to them again")
            return
        self._move(origin.place)
        self._warn(
            "its points were not measured from the scanner; it stood at {place}, as {source} shows, and ranges count "
            "from there",
            place=numbers(origin.place),
            source=_SOURCES[kind],
        )

    def _move(self, place):
        self.points -= place
        self.pose = self.pose.copy()
        self.pose[:3, 3] += self.pose[:3, :3] @ place

    def _turn_upright(self):
        nearest = self._nearest()
        if nearest > _FARTHEST_RETURN_M:
            self._warn(
                "every point is more than {distance:,.0f} km from the scanner's origin: the file holds world "
                "coordinates, so ranges and orientation mean little; rows and columns stay as stored",
                distance=nearest / 1000,
            )
            return
        up = self._up()
        frame = frame_with_up(up)
        if not np.array_equal(frame, np.eye(3)):
            for rows in strips(self.valid.shape):
                self.points[rows] = self.points[rows] @ frame.T
            self.pose = self.pose.copy()
            self.pose[:3, :3] = self.pose[:3, :3] @ frame.T
        turn = infer_turn(self.points, self.valid)
        if not turn.certain:
            self._warn("its points do not show which way is up; turn or flip it if it looks wrong")
        elif turn.transposed and (up is Z_UP or up is self._camera):
            self._warn("its rows and columns are swapped in the file; they were swapped back")
        if turn[:3] != AS_STORED[:3]:
            self.order.turned(turn)
            self.points, self.valid = turn.of(self.points), turn.of(self.valid)

    def _up(self):
        """Up in the frame of the points: the world's by the pose; a camera's own where that says nothing."""
        up = np.linalg.inv(self.pose[:3, :3]) @ Z_UP
        up /= np.linalg.norm(up)
        if self._camera is not None and abs(up[2]) > _NEARLY_UP:
            # By its pose the camera looks straight up or down: most likely the file has no real pose.
            return self._camera
        if up[2] > _NEARLY_UP:
            return Z_UP
        if self._camera is None:
            self._warn(
                "its pose says that the scanner hung upside down or lay on its side; row 0 is what was up in the world"
            )
        return up

    def _by_hand(self):
        options = self._options
        step = GridOrder(self.valid.shape)
        for order in (step, self.order):
            if options.turn_deg or options.flip_vertical or options.flip_horizontal:
                order.by_hand(options.turn_deg, options.flip_vertical, options.flip_horizontal)
            if options.step > 1:
                order.every(options.step)
        self.points, self.valid = step.of(self.points), step.of(self.valid)

    def _sample(self):
        """Some of the returns, as (N, 3): those of every n-th row and column, or all of a nearly empty grid."""
        step = math.isqrt(self.valid.size // _SAMPLE) + 1
        for every in ((slice(None, None, step),) * 2, ...):
            found = self.points[every][self.valid[every]]
            if len(found) > _FEWEST:
                break
        return found

    def _nearest(self):
        """Least distance from the scanner, meters."""
        chosen = self._sample()
        return np.sqrt(np.einsum("ij,ij->i", chosen, chosen).min())


def scaled_by_pose(points, pose, valid, warn):
    """Return points and pose with an even scale of the pose put into the points, or left out where it makes no sense.

    Parameters
    ----------
    points : (H, W, 3) float64
    pose : (4, 4) float64
    valid : (H, W) bool
    warn : callable
        Takes what `Message` takes.
    """
    scale = scale_of_pose(pose)
    if scale == 1.0 or not valid.any():
        return points, pose
    pose = pose.copy()
    pose[:3, :3] /= scale
    seen = points[valid][:: max(1, np.count_nonzero(valid) // _SAMPLE)]
    distance = float(np.median(np.sqrt(np.einsum("ij,ij->i", seen, seen))))
    if not _NEAREST_M < distance * scale < _FARTHEST_RETURN_M and _NEAREST_M < distance < _FARTHEST_RETURN_M:
        warn(
            "its matrix scales by {scale:g}, which would put its points {distance:.3g} m away; the scale was left out",
            scale=scale,
            distance=distance * scale,
        )
        return points, pose
    warn("its matrix scales by {scale:g}: its points are {scale:g} times as far away", scale=scale)
    return points * scale, pose


_SOURCES = {
    "position": Message("the position in its header"),
    "repeated": Message("the point that its pixels without a return repeat"),
    "fit": Message("the regularity of its rows and columns"),
}


def numbers(values):
    """Return numbers as a text in brackets."""
    return "(" + " ".join(f"{value:.10g}" for value in values) + ")"
