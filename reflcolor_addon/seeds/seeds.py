"""Seeds: pixels of the scan whose color is known."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np

from ..errors import SeedsError, require_kind
from ..messages import Message
from .seeds_file import read_columns, write_seeds
from .sources import FOUND, GUESSED, SOURCES

# With this many seeds on pixels without a return, a warning asks whether they belong to the scan.
_MANY_MOVED = 5


@dataclass(frozen=True, eq=False)
class Seeds:
    """Where in the scan which color is.

    Parameters
    ----------
    rows, cols : (S,) int
        Pixels of the scan's grid, row 0 at the top.
    rgb : (S, 3) uint8
        sRGB.
    photos : (S,) sequence of str or None, optional
        Name of the photo that a seed's color was taken from.
    photo_xy : (S, 2) float, optional
        Where in that photo, in pixels from its top left corner (the first pixel's center is at 0.5, 0.5); NaN where
        the color was given directly.
    confidence : (S,) float, optional
        How sure a color is, 0..1; NaN where nobody says.
    reason : (S,) sequence of {"pose", "homography", "appearance", "hand"} or None, optional
        Why the seed has its color: by the photo's verified camera or homography, by likeness, picked by hand.
    locked : (S,) bool, optional
        Which ones a person wants to stay as they are: no photo tells more than they do. By default none.

    Raises
    ------
    SeedsError
        If the arrays disagree in length, or hold what is no pixel or no color.

    Examples
    --------
    >>> from reflcolor_addon import Seeds
    >>> seeds = Seeds(rows=[10, 5], cols=[20, 7], rgb=[[200, 80, 40], [40, 90, 60]])
    >>> seeds.save("garage.seeds.json")
    >>> len(Seeds.load("garage.seeds.json"))
    2
    """

    rows: np.ndarray
    cols: np.ndarray
    rgb: np.ndarray
    # None only until __post_init__ has put arrays in its place.
    photos: tuple[str | None, ...] = None  # type: ignore[assignment]
    photo_xy: np.ndarray = None  # type: ignore[assignment]
    confidence: np.ndarray = None  # type: ignore[assignment]
    reason: tuple[str | None, ...] = None  # type: ignore[assignment]
    locked: np.ndarray = None  # type: ignore[assignment]

    def __post_init__(self):
        count = np.size(self.rows)
        reason = (None,) * count if self.reason is None else tuple(self.reason)
        confidence = np.full(count, np.nan) if self.confidence is None else self.confidence
        photos = (None,) * count if self.photos is None else tuple(self.photos)
        photo_xy = np.full((count, 2), np.nan) if self.photo_xy is None else self.photo_xy
        arrays = {
            "rows": _whole_numbers("rows", self.rows, np.int64),
            "cols": _whole_numbers("cols", self.cols, np.int64),
            "rgb": _whole_numbers("rgb", self.rgb, np.uint8).reshape(-1, 3)
            if count == 0
            else _whole_numbers("rgb", self.rgb, np.uint8),
            "photo_xy": np.asarray(photo_xy, np.float64).reshape(-1, 2),
            "confidence": np.asarray(confidence, np.float64),
            "locked": np.zeros(count, bool) if self.locked is None else np.asarray(self.locked, bool),
        }
        for name, array in arrays.items():
            expected = (count, *{"rgb": (3,), "photo_xy": (2,)}.get(name, ()))
            if array.shape != expected:
                raise SeedsError(
                    "seeds: {name} has shape {shape}, expected {expected}",
                    name=name,
                    shape=array.shape,
                    expected=expected,
                )
            object.__setattr__(self, name, array)
        if len(photos) != count:
            raise SeedsError("seeds: {count} photo names for {seeds} seeds", count=len(photos), seeds=count)
        object.__setattr__(self, "photos", photos)
        if len(reason) != count:
            raise SeedsError("seeds: {count} reasons for {seeds} seeds", count=len(reason), seeds=count)
        unknown = set(reason) - {None, *SOURCES}
        if unknown:
            raise SeedsError(
                "seeds: reason: expected one of {choices}, found {found!r}",
                choices=", ".join(SOURCES),
                found=sorted(unknown)[0],
            )
        object.__setattr__(self, "reason", reason)

    def __len__(self):
        return self.rows.size

    @property
    def all_guessed(self) -> bool:
        """True where no color was picked by a person or seen by a photo that was verified."""
        return len(self) > 0 and GUESSED.issuperset(self.reason)

    @property
    def of_a_person(self) -> np.ndarray:
        """(S,) bool: those that a person picked or locked; they take precedence over photos."""
        return self.locked | np.array([reason not in FOUND for reason in self.reason], bool)

    def chosen(self, indices) -> "Seeds":
        """Return the seeds of these indices, in their order."""
        indices = np.asarray(indices, np.int64)
        return Seeds(
            rows=self.rows[indices],
            cols=self.cols[indices],
            rgb=self.rgb[indices],
            photos=tuple(self.photos[index] for index in indices),
            photo_xy=self.photo_xy[indices],
            confidence=self.confidence[indices],
            reason=tuple(self.reason[index] for index in indices),
            locked=self.locked[indices],
        )

    @classmethod
    def load(cls, path: PathLike | str, photos: Iterable[PathLike | str] = ()) -> "Seeds":
        """Read seeds from a JSON file.

        A seed has ``row`` and ``col`` and either ``rgb`` or a point of a photo: ``photo``, ``x``, ``y``, in pixels from
        the photo's top left corner. A photo is found by its name among ``photos``, else beside the seeds' file.

        Parameters
        ----------
        path : path
        photos : sequence of paths
            Photos that the seeds may name.

        Raises
        ------
        SeedsError
            If the file cannot be read, or a seed in it cannot be used.
        ImageError
            If a photo cannot be read.
        """
        return cls(**read_columns(Path(path), photos))

    def save(self, path: PathLike | str) -> None:
        """Write the seeds as JSON; the file is whole or not there.

        Raises
        ------
        OutputError
            If the file cannot be written.
        """
        write_seeds(self, path)

    def placed_on(self, scan):
        """Return these seeds on pixels with a return, and what had to be moved for that.

        Returns
        -------
        seeds : Seeds
        warnings : list of str
            One line per seed that lay on a pixel without return and was moved to the nearest pixel with one; a single
            one with their number where they are many.

        Raises
        ------
        SeedsError
            If there are no seeds, one is outside the grid, or the scan has no return at all.
        """
        if len(self) == 0:
            raise SeedsError("no seeds: add at least one pixel with a color")
        if not scan.valid.any():
            raise SeedsError("{scan}: no pixel has a return, so no seed can be placed", scan=scan.name)
        height, width = scan.shape
        rows, cols, warnings = self.rows.copy(), self.cols.copy(), []
        for index, (row, col) in enumerate(zip(rows.tolist(), cols.tolist(), strict=True)):
            if not (0 <= row < height and 0 <= col < width):
                raise SeedsError(
                    "seed {seed}: row {row}, column {col} is outside the scan's grid (rows 0 to {last_row}, columns 0 "
                    "to {last_col})",
                    seed=index + 1,
                    row=row,
                    col=col,
                    last_row=height - 1,
                    last_col=width - 1,
                )
            if not scan.valid[row, col]:
                rows[index], cols[index] = nearest_valid(scan.valid, row, col, wrap=scan.full_turn)
                warnings.append(
                    Message(
                        "seed {seed}: no return at row {row}, column {column}; moved to row {to_row}, column "
                        "{to_column}",
                        seed=index + 1,
                        row=row,
                        column=col,
                        to_row=int(rows[index]),
                        to_column=int(cols[index]),
                    )
                )
        if len(warnings) >= _MANY_MOVED:
            warnings = [
                Message(
                    "{count} of {all} seeds lie where {scan} has no return, and were moved to the nearest pixel with "
                    "one; are they of another scan?",
                    count=len(warnings),
                    all=len(self),
                    scan=scan.name,
                )
            ]
        return replace(self, rows=rows, cols=cols), warnings


def require_seeds(seeds):
    """Raise a SeedsError where something else than Seeds was given."""
    require_kind(seeds, Seeds, "seeds", "write Seeds(rows, cols, rgb), or Seeds.load(path)", SeedsError)


def nearest_valid(valid, row, col, *, wrap=False):
    """Return (row, col) of the pixel with a return that is nearest in the grid; the first in reading order of several.

    Parameters
    ----------
    valid : (H, W) bool
        True somewhere.
    row, col : int
        Inside the grid.
    wrap : bool
        Whether the left and the right edge are neighbors.
    """
    height, width = valid.shape
    radius = 0
    while True:
        rows = np.arange(max(0, row - radius), min(height, row + radius + 1))
        if wrap:
            # Each column once, by the shorter way around.
            cols = np.arange(col - min(radius, (width - 1) // 2), col + min(radius, width // 2) + 1)
        else:
            cols = np.arange(max(0, col - radius), min(width, col + radius + 1))
        found_rows, found_cols = np.nonzero(valid[np.ix_(rows, cols % width)])
        squared = (rows[found_rows] - row) ** 2 + (cols[found_cols] - col) ** 2
        # A nearer pixel can still lie outside the square than one in its corner.
        if squared.size and (squared.min() <= radius**2 or radius >= max(height, width)):
            best = np.lexsort((cols[found_cols] % width, rows[found_rows], squared))[0]
            return int(rows[found_rows[best]]), int(cols[found_cols[best]] % width)
        radius = max(1, 2 * radius)


def _whole_numbers(name, values, dtype):
    array = np.asarray(values)
    if array.size == 0:
        return array.astype(dtype)
    if array.dtype.kind not in "iu":
        raise SeedsError("seeds: {name}: expected whole numbers, found {dtype}", name=name, dtype=array.dtype)
    if dtype == np.uint8 and (array.min() < 0 or array.max() > 255):
        raise SeedsError(
            "seeds: {name}: expected 0 to 255, found {low} to {high}",
            name=name,
            low=array.min(),
            high=array.max(),
        )
    return array.astype(dtype)
