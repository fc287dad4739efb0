"""Methods to compare with: each takes a scan and seeds.

Some return (H, W, 2) chrominance (Cb, Cr), to which the luminance is that of the reflectance; those that give whole
colors return (H, W, 3): Y, Cb, Cr.
"""

import warnings

import numpy as np

from reflcolor_addon.color.colorspaces import LUMA, chrominance
from reflcolor_addon.scan.normalization import normalize

_NEIGHBORS = tuple((down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right)
# Of the guided filter: half the window in pixels, and what variance of Y (0..1) counts as an edge.
_GUIDED_RADIUS, _GUIDED_VARIANCE = 16, 1e-3


def gray(scan, seeds):
    """No color at all."""
    return np.zeros((*scan.shape, 2))


def mean_color(scan, seeds):
    """The mean of the seeds everywhere."""
    return np.broadcast_to(_colors(seeds).mean(axis=0), (*scan.shape, 2))


def constant(scan, seeds):
    """The mean of the seeds everywhere, luminance and all."""
    return np.broadcast_to(whole_colors(seeds).mean(axis=0), (*scan.shape, 3))


def linear(scan, seeds):
    """Each channel linear in the reflectance, fitted to the seeds."""
    luminance, _ = normalize(scan.reflectance, scan.valid)
    own = luminance[seeds.rows, seeds.cols]
    fit, *_ = np.linalg.lstsq(np.column_stack([np.ones(len(seeds)), own]), whole_colors(seeds), rcond=None)
    return fit[0] + fit[1] * luminance[..., None]


def levin_whole(scan, seeds):
    """Levin's optimization on all three channels."""
    return levin(scan, seeds, values=whole_colors(seeds))


def nearest_in_image(scan, seeds):
    """The color of the seed that is nearest in the image."""
    from scipy.spatial import cKDTree

    steps = np.array(scan.step_deg)
    grid = np.stack(np.indices(scan.shape), axis=-1) * steps
    _, nearest = cKDTree(np.column_stack([seeds.rows, seeds.cols]) * steps).query(grid)
    return _colors(seeds)[nearest]


def guided_filter(scan, seeds):
    """The nearest seed in the image, by a guided filter on the reflectance (He, Sun and Tang 2010)."""
    import cv2

    guide = normalize(scan.reflectance, scan.valid)[0].astype(np.float64) / 255
    weight = scan.valid.astype(np.float64)
    size = (2 * _GUIDED_RADIUS + 1,) * 2
    total = cv2.blur(weight, size)

    def local_mean(image):
        return cv2.blur(image * weight, size) / np.maximum(total, 1e-9)

    guide_mean = local_mean(guide)
    variance = local_mean(guide**2) - guide_mean**2
    result = np.empty((*scan.shape, 2))
    nearest = nearest_in_image(scan, seeds)
    for channel in range(2):
        values = np.ascontiguousarray(nearest[..., channel])
        slope = (local_mean(guide * values) - guide_mean * local_mean(values)) / (variance + _GUIDED_VARIANCE)
        offset = local_mean(values) - slope * guide_mean
        result[..., channel] = local_mean(slope) * guide + local_mean(offset)
    return result


def solve_by_default(matrix, known):
    """Solve a sparse system with scipy's default order of the columns (COLAMD)."""
    from scipy.sparse.linalg import spsolve

    return spsolve(matrix, known)


def solve_each_by_default(matrix, known):
    """The same, each channel by a call of its own, as is commonly written: the matrix is factorized twice."""
    return np.column_stack([solve_by_default(matrix, channel) for channel in known.T])


def solve_symmetrically(matrix, known):
    """Solve a sparse system whose pattern is symmetric, which keeps the factors small: minimum degree of A^T + A."""
    from scipy.sparse.linalg import splu

    options = {"permc_spec": "MMD_AT_PLUS_A", "options": {"SymmetricMode": True}, "diag_pivot_thresh": 0.0}
    return splu(matrix, **options).solve(known)


def levin(scan, seeds, solve=solve_symmetrically, values=None):
    """Colorization using optimization (Levin, Lischinski and Weiss 2004), by a sparse direct solver.

    Every pixel without a seed is the weighted mean of its 8 neighbors, with weights exp(-(Y_p - Y_q)^2 / 2 var) of the
    variance in the 3 x 3 window, bounded below as in the authors' program. By default the chrominance is spread.
    """
    from scipy.sparse import csc_array

    height, width = scan.shape
    guide = normalize(scan.reflectance, scan.valid)[0].astype(np.float64) / 255
    padded = np.pad(np.where(scan.valid, guide, np.nan), 1, constant_values=np.nan)
    around = np.stack([padded[1 + i : 1 + i + height, 1 + j : 1 + j + width] for i, j in _NEIGHBORS])
    with warnings.catch_warnings():
        # Windows without any return.
        warnings.simplefilter("ignore", RuntimeWarning)
        spread = 0.6 * np.nanvar(np.concatenate([around, np.where(scan.valid, guide, np.nan)[None]]), axis=0)
        least = np.nanmin((around - guide) ** 2, axis=0)
    spread = np.fmax(np.fmax(spread, -least / np.log(0.01)), 2e-6)
    affinity = np.nan_to_num(np.exp(-((around - guide) ** 2) / spread))
    total = affinity.sum(axis=0)
    is_seed = np.zeros(scan.shape, bool)
    is_seed[seeds.rows, seeds.cols] = True
    free = scan.valid & ~is_seed & (total > 0)
    index = np.arange(height * width).reshape(height, width)
    rows, cols, entries = [index.ravel()], [index.ravel()], [np.full(index.size, 1 + 1e-10)]
    for (down, right), weight in zip(_NEIGHBORS, affinity, strict=True):
        at = np.nonzero(free & (weight > 0))
        rows.append(index[at])
        cols.append(index[at[0] + down, at[1] + right])
        entries.append(-weight[at] / total[at])
    places = np.concatenate(rows), np.concatenate(cols)
    matrix = csc_array((np.concatenate(entries), places), (index.size, index.size))
    values = _colors(seeds) if values is None else values
    known = np.zeros((height * width, values.shape[1]))
    known[index[seeds.rows, seeds.cols]] = values
    return solve(matrix, known).reshape(height, width, -1)


def whole_colors(seeds):
    """(S, 3): Y, Cb, Cr."""
    return np.column_stack([seeds.rgb @ LUMA, _colors(seeds)])


def _colors(seeds):
    return chrominance(seeds.rgb, "ycbcr")
