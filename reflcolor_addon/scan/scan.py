"""A structured laser scan: one range and one reflectance at every pixel of the scanner's grid."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from ..errors import ScanError, require_kind
from ..messages import LONGEST_LINE, Message, one_line
from .limits import FARTHEST_M, LONGEST_NAME, MOST_PIXELS, SCALES, STRONGEST


class HandedOver(np.ndarray):
    """Points that nobody else will change: a `Scan` keeps them as they are instead of a copy of them.

    Made by ``points.view(HandedOver)``, of a C-contiguous float64 array.
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class Scan:
    """One scan, upright: row 0 is the top, columns run left to right as seen from the scanner.

    Parameters
    ----------
    name : str
        Name of the scan; the file's stem where the file gives none.
    points : (H, W, 3) float64
        Meters, in the scanner's frame (Z up, the scanner at the origin); zeros where not valid.
    reflectance : (H, W) float32
        Raw, in whatever unit the file has it.
    valid : (H, W) bool
        True where the scanner got a return.
    color : (H, W, 3) uint8, optional
        sRGB that came with the scan.
    pose : (4, 4) float64
        Scanner frame to world, column-vector convention (translation in the last column).
    source : Path, optional
        The file that the scan was read from.
    warnings : tuple of str
        What the reader noticed and mended, one line each.

    Raises
    ------
    ScanError
        If shapes or types disagree, the grid is empty, or a valid pixel or the pose holds a number that is not finite
        or beyond all reason (`limits`).

    Examples
    --------
    A wall two meters ahead, seen at 2 x 3 pixels of 0.1 radians:

    >>> import numpy as np
    >>> from reflcolor_addon import Scan
    >>> up, right = np.meshgrid([0.1, 0.0], [-0.1, 0.0, 0.1], indexing="ij")
    >>> points = np.stack([2 * right, np.full((2, 3), 2.0), 2 * up], axis=-1)
    >>> scan = Scan(name="wall", points=points, reflectance=np.ones((2, 3)), valid=np.ones((2, 3), bool))
    >>> scan.shape, round(float(scan.range.max()), 2)
    ((2, 3), 2.02)
    """

    name: str
    points: np.ndarray
    reflectance: np.ndarray
    valid: np.ndarray
    color: np.ndarray | None = None
    pose: np.ndarray = field(default_factory=lambda: np.eye(4))
    source: Path | None = None
    warnings: tuple[str, ...] = ()

    def __post_init__(self):
        object.__setattr__(self, "name", one_line(str(self.name), LONGEST_NAME))
        object.__setattr__(self, "warnings", tuple(map(_as_line, self.warnings)))
        shape = np.shape(self.valid)
        self._require_types()
        if len(shape) != 2 or 0 in shape:
            raise self._error("a scan is a grid of rows x columns, found shape {shape}", shape=shape)
        if shape[0] * shape[1] > MOST_PIXELS:
            raise self._error(
                "has {rows:,} rows x {columns:,} columns, expected at most {most:,} pixels",
                rows=shape[0],
                columns=shape[1],
                most=MOST_PIXELS,
            )
        arrays = {
            "points": _own(self.points),
            "reflectance": np.ascontiguousarray(self.reflectance, np.float32),
            "valid": np.ascontiguousarray(self.valid, bool),
            "pose": np.ascontiguousarray(self.pose, np.float64),
        }
        expected = {"points": (*shape, 3), "reflectance": shape, "valid": shape, "pose": (4, 4)}
        if self.color is not None:
            arrays["color"] = np.ascontiguousarray(self.color)
            expected["color"] = (*shape, 3)
            if arrays["color"].dtype != np.uint8:
                raise self._error("color must be uint8, found {kind}", kind=str(arrays["color"].dtype))
        for key, array in arrays.items():
            if array.shape != expected[key]:
                raise self._error(
                    "{array} has shape {shape}, expected {expected}",
                    array=key,
                    shape=array.shape,
                    expected=expected[key],
                )
        arrays["points"][~arrays["valid"]] = 0.0
        self._require_plausible(arrays["points"], arrays["reflectance"], arrays["valid"], arrays["pose"])
        for key, array in arrays.items():
            object.__setattr__(self, key, array)

    def _require_types(self):
        """Refuse types that NumPy would convert silently, and rarely as intended."""
        for key, kinds in (("points", "iuf"), ("reflectance", "biuf"), ("valid", "b"), ("pose", "iuf")):
            kind = np.asarray(getattr(self, key)).dtype
            if kind.kind in kinds:
                continue
            if key == "valid":
                raise self._error("valid: expected booleans, found {kind}; write valid > 0", kind=str(kind))
            raise self._error("{array}: expected numbers, found {kind}", array=key, kind=str(kind))

    def _require_plausible(self, points, reflectance, valid, pose):
        """The one gate that every reader's numbers pass."""
        if not np.isfinite(pose).all():
            raise self._error("the pose holds a number that is not finite")
        if not (is_plausible(pose) and np.array_equal(pose[3], [0, 0, 0, 1])):
            raise self._error(
                "the pose is not that of a scanner: expected 0 0 0 1 as its last row, and at most {most:g} m",
                most=FARTHEST_M,
            )
        # Where there is no return the points are 0 already.
        for what, values, most in (
            (Message("a point"), points, FARTHEST_M),
            (Message("a reflectance"), reflectance[valid], STRONGEST),
        ):
            seen = max(values.max(initial=0), -values.min(initial=0))
            if not np.isfinite(seen):
                raise self._error("a valid pixel has {what} that is not finite", what=what)
            if seen > most:
                raise self._error(
                    "a valid pixel has {what} of {found:g}, expected at most {most:g}", what=what, found=seen, most=most
                )

    def _error(self, template, **values):
        return ScanError("{scan}: {text}", scan=self.name, text=Message(template, **values))

    @property
    def shape(self) -> tuple[int, int]:
        """(H, W): rows and columns of the grid."""
        return self.valid.shape

    @cached_property
    def has_reflectance(self) -> bool:
        """False where the reflectance is the same everywhere, as in files without any: then there is nothing to
        colorize by."""
        seen = self.reflectance[self.valid]
        return seen.size < 2 or bool(seen.min() < seen.max())

    @cached_property
    def range(self) -> np.ndarray:
        """(H, W) float64, meters from the scanner; 0 where not valid."""
        return np.sqrt(np.einsum("ijk,ijk->ij", self.points, self.points))

    @cached_property
    def _azimuth_steps(self):
        """Median azimuth (radians) of each column that can be measured, and its column index."""
        horizontal = np.hypot(self.points[..., 0], self.points[..., 1])
        usable = self.valid & (horizontal > 0.05 * np.maximum(self.range, 1e-12))
        azimuth = np.arctan2(self.points[..., 1], self.points[..., 0])
        columns = np.flatnonzero(usable.any(axis=0))
        # The mean direction, so that a column at the cut of arctan2 does not average to nonsense.
        sine = np.where(usable, np.sin(azimuth), 0).sum(axis=0)[columns]
        cosine = np.where(usable, np.cos(azimuth), 0).sum(axis=0)[columns]
        return columns, np.arctan2(sine, cosine)

    @cached_property
    def step_deg(self) -> tuple[float, float]:
        """(vertical, horizontal) angle between neighboring pixels in degrees; NaN where it cannot be measured."""
        elevation = np.arctan2(self.points[..., 2], np.hypot(self.points[..., 0], self.points[..., 1]))
        both = self.valid[1:] & self.valid[:-1]
        vertical = np.degrees(np.median(np.abs(np.diff(elevation, axis=0))[both])) if both.any() else np.nan
        columns, azimuth = self._azimuth_steps
        turn = np.abs(_wrapped(np.diff(azimuth)))[np.diff(columns) == 1]
        return float(vertical), float(np.degrees(np.median(turn))) if turn.size else float("nan")

    @property
    def pixel_aspect(self) -> float:
        """Width of a pixel over its height, as angles; 1 where they are nearly equal or cannot be measured."""
        vertical, horizontal = self.step_deg
        aspect = horizontal / vertical if vertical > 0 and horizontal > 0 else 1.0
        return float(aspect) if not 0.9 < aspect < 1.1 and 0.02 < aspect < 50 else 1.0

    @cached_property
    def full_turn(self) -> bool:
        """True where the left and the right edge of the grid are neighbors: the scan covers 360 degrees."""
        columns, azimuth = self._azimuth_steps
        width = self.shape[1]
        if columns.size < 8 or columns.size < 0.5 * width:
            return False
        turn, gap = _wrapped(np.diff(azimuth)), np.diff(columns)
        step = np.median(np.abs(turn[gap == 1])) if (gap == 1).any() else 0.0
        # Sum over the measured columns, then the step that would join the last one to the first.
        covered = abs(turn.sum())
        joint = (width - columns[-1] + columns[0]) * step
        return bool(step > 0 and abs(covered + joint - 2 * np.pi) < 1.5 * step + 0.02 * joint)


def require_scan(scan):
    """Raise a ScanError where something else than a Scan was given."""
    require_kind(scan, Scan, "scan", "read_scans reads files, Scan(name=..., points=...) takes arrays", ScanError)


def is_plausible(pose):
    """Whether a (4, 4) pose can be a scanner's: within the `limits`, and invertible."""
    linear, place = pose[:3, :3], pose[:3, 3]
    if not (np.abs(place).max() <= FARTHEST_M and np.abs(linear).max() <= SCALES[1]):
        return False
    scales = np.linalg.svd(linear, compute_uv=False)
    return bool(SCALES[0] <= scales[-1] and scales[0] <= SCALES[1])


def _own(points):
    """C-contiguous float64; a copy, so that changes of the caller's array and of this one stay apart."""
    if isinstance(points, HandedOver) and points.dtype == np.float64 and points.flags.c_contiguous:
        return points.view(np.ndarray)
    return np.array(points, np.float64, order="C")


def _as_line(warning):
    return warning if isinstance(warning, Message) else one_line(warning, LONGEST_LINE)


def _wrapped(angle):
    """Radians brought to -pi..pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
