"""What two photos on one scan, or one photo on two scans, have in common.

Two scans of one place have measured the same reflectance behind the same part of a photo, wherever they stood and
whatever was assumed of the camera. And two photos of one scan are bright and dark in the same places of it. Only what
changes from one cell to the next is compared, because the light, the exposure and the distance are not the same. Chance
gives a correlation of about nothing, even where walls and floors of different rooms fit on each other.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...matching.scan_image import pixel_steps

# Cells along the longer side of a photo; and how wide and how high those of a scan are, in degrees.
_CELLS, _CELL_DEG = 24, 2.5
# So many changes must be known to both before they are compared.
_LEAST_CHANGES = 250
# From this correlation on both show the same; below the other they do not. In between nothing is said. In the archive
# of ``python -m benchmarks.archive`` right pairs have 0.6 to 0.95, wrong ones -0.25 to 0.2.
ALIKE, _UNLIKE = 0.5, 0.2
# Scans that see different parts of a photo have fewer in common: from so many on they are of one place if they are
# alike by more, by so many deviations of what chance gives.
_LEAST_OF_SCANS, _MORE_DEVIATIONS = 50, 3.0
# How far apart the cameras of one photo may be found, in the distance of what it shows, and how far turned.
_BESIDE, _TURNED_DEG = 0.15, 8.0


@dataclass(frozen=True, eq=False)
class Cells:
    """What was seen in cells of a photo, or of a scan.

    Parameters
    ----------
    across : int
        How many cells lie side by side.
    index : list of int
        Which cells something is known of, row by row, in ascending order.
    values : list of float
    """

    across: int
    index: list
    values: list

    @classmethod
    def of(cls, rows, cols, across, values):
        """Return the means of values (N,) in the cells (row, column) where they are."""
        cells, place = np.unique(rows * across + cols, return_inverse=True)
        means = np.bincount(place, values) / np.bincount(place)
        return cls(int(across), cells.tolist(), [float(f"{mean:.5g}") for mean in means])

    @cached_property
    def changes(self):
        """(N,) int64, between which cells, and (N,) float64, the rank of what changes from the one to the other."""
        from scipy.stats import rankdata

        index, values = np.array(self.index, np.int64), np.array(self.values, float)
        keys, found = [], []
        for way, step in enumerate((1, self.across)):
            place = np.searchsorted(index, index + step).clip(max=max(len(index) - 1, 0))
            both = index[place] == index + step
            if step == 1:
                both &= index % self.across < self.across - 1
            keys.append(2 * index[both] + way)
            found.append(values[place[both]] - values[both])
        keys, found = np.concatenate(keys), np.concatenate(found)
        order = np.argsort(keys)
        return keys[order], rankdata(found[order])


def reflectance_seen(scan, model):
    """Return the mean reflectance that a scan has behind each cell of a photo.

    Parameters
    ----------
    scan : Scan
    model : Camera or GridHomography
        Of the photo, on the scan.

    Returns
    -------
    Cells
    """
    rows, cols, xy = pixels_seen(scan, model)
    size = max(model.width, model.height) / _CELLS
    col, row = (xy // size).astype(int).T
    return Cells.of(row, col, int(np.ceil(model.width / size)), scan.reflectance[rows, cols])


def brightness_seen(scan, model, photo):
    """Return how bright a photo is, on average, where it shows each cell of a scan's grid.

    Parameters
    ----------
    scan, model
        As `reflectance_seen`.
    photo : PhotoImage

    Returns
    -------
    Cells
    """
    rows, cols, xy = pixels_seen(scan, model)
    gray = photo.gray
    size = np.array(gray.shape[::-1])
    x, y = np.minimum(xy * size / [model.width, model.height], size - 1).astype(int).T
    down, right = (max(1, round(_CELL_DEG / step)) for step in pixel_steps(scan))
    across = int(np.ceil(scan.shape[1] / right))
    return Cells.of(rows // down, cols // right, across, gray[y, x])


def pixels_seen(scan, model):
    """Return rows and columns (N,) of the pixels with a return that a photo shows, and where: (N, 2) pixels of it.

    Parameters
    ----------
    scan, model
        As `reflectance_seen`.
    """
    rows, cols = np.nonzero(scan.valid)
    xy, depth = model.project(model.sites_of(scan, rows, cols))
    with np.errstate(invalid="ignore"):
        inside = (depth > 0) & (xy >= 0).all(axis=1) & (xy < [model.width, model.height]).all(axis=1)
    return rows[inside], cols[inside], xy[inside]


def agreement(one, other):
    """Return how far the same changes from cell to cell: -1..1, the correlation of ranks; None if too little is common.

    Parameters
    ----------
    one, other : Cells
        Of the same photo, or of the same scan.
    """
    found, count = _correlation(one, other)
    return found if count >= _LEAST_CHANGES else None


def alike(one, other):
    """Whether two scans measured the same behind one photo; None where they have too little in common to tell, or are
    neither alike nor unlike, as where a camera is a little off.

    Parameters
    ----------
    one, other : Cells or None
        See `reflectance_seen`.
    """
    found, count = _correlation(one, other)
    if found is None or count < _LEAST_OF_SCANS:
        return None
    more = max(count**-0.5 - _LEAST_CHANGES**-0.5, 0.0)
    if found >= ALIKE + _MORE_DEVIATIONS * more:
        return True
    return False if count >= _LEAST_CHANGES and unlike(found) else None


def _correlation(one, other):
    """The correlation of the ranks of what changes from cell to cell, or None, and how many changes are common."""
    if one is None or other is None or one.across != other.across:
        return None, 0
    (one_keys, one_ranks), (other_keys, other_ranks) = one.changes, other.changes
    _, mine, its = np.intersect1d(one_keys, other_keys, assume_unique=True, return_indices=True)
    if not len(mine):
        return None, 0
    one, other = one_ranks[mine] - one_ranks[mine].mean(), other_ranks[its] - other_ranks[its].mean()
    scale = np.sqrt((one @ one) * (other @ other))
    return float(one @ other / scale) if scale > 0 else None, len(mine)


def unlike(found):
    """Whether an `agreement` shows that both cannot be right."""
    return found is not None and found < _UNLIKE


def camera_place(scan, model):
    """Return where a photo's camera stands and where it looks, [x, y, z, x, y, z] in the world, and how far away what
    it shows is, meters; None where the scan has no pose, or the model no camera."""
    if model.kind != "pose" or np.allclose(scan.pose, np.eye(4)):
        return None
    rows, cols, _ = pixels_seen(scan, model)
    if not len(rows):
        return None
    distance = np.median(np.linalg.norm(scan.points[rows, cols] - model.center, axis=1))
    turn, shift = scan.pose[:3, :3], scan.pose[:3, 3]
    return [float(value) for value in (*(turn @ model.center + shift), *(turn @ model.rotation[2]), distance)]


def same_place(one, other):
    """Whether two scans agree about a photo; None where that cannot be told.

    Parameters
    ----------
    one, other : Claim
    """
    if one.camera is not None and other.camera is not None:
        # Where both scans have poses, these tell; those of scans that were never registered are all the same.
        return _is_beside(np.array(one.camera), np.array(other.camera))
    return alike(one.reflectance, other.reflectance)


def _is_beside(one, other):
    near = np.linalg.norm(one[:3] - other[:3]) <= _BESIDE * one[6]
    return bool(near and np.dot(one[3:6], other[3:6]) >= np.cos(np.radians(_TURNED_DEG)))
