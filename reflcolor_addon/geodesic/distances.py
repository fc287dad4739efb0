"""Geodesic distances over the pixels of a scan (eq. 5)."""

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ScanError, SeedsError
from ..scan.normalization import normalize
from ..scan.scan import Scan
from ..settings import Settings, settings_or_default
from .engines import engine_for
from .graph import PixelGraph
from .smoothing import smooth


def geodesic_distances(
    scan: Scan | ArrayLike,
    rows: ArrayLike,
    cols: ArrayLike,
    settings: Settings | None = None,
    *,
    range_image: ArrayLike | None = None,
    valid: ArrayLike | None = None,
    full_turn: bool = False,
) -> np.ndarray:
    """Return the distance of every pixel to each of some pixels, along the path of least cost.

    The cost from a pixel p to its neighbor q is ``(beta (D_q - D_p)^2 + 1) |Y_q - Y_p|`` (eq. 6 of [1]_), where Y is
    the reflectance and D the range, each normalized to 0..255; the distance is the least sum of costs over any path
    (eq. 5).

    Parameters
    ----------
    scan : Scan or (H, W) array of float
        A scan, or the raw reflectance of any image.
    rows, cols : int, or (S,) sequence of int
        The pixels to measure from, row 0 at the top.
    settings : Settings, optional
        ``beta``, ``neighbors`` and ``smoothing``; the paper's by default.
    range_image : (H, W) array of float, optional
        With plain arrays: the range in any unit. Without it the reflectance alone counts.
    valid : (H, W) array of bool, optional
        With plain arrays: which pixels there are; by default those whose numbers are finite.
    full_turn : bool
        With plain arrays: whether the left and the right edge are neighbors.

    Returns
    -------
    (S, H, W) float32
        0 at the pixel itself; infinite where no path leads.

    Raises
    ------
    ScanError
        If the arrays do not fit together.
    SeedsError
        If a pixel lies outside the grid, or is not valid.

    References
    ----------
    .. [1] S. Oishi, R. Kurazume, Y. Iwashita, T. Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
       Reflectivity", ICRA 2013.

    Examples
    --------
    >>> import numpy as np
    >>> from reflcolor_addon import geodesic_distances
    >>> reflectance = np.repeat([[0.2, 0.8]], 3, axis=0)
    >>> geodesic_distances(reflectance, 1, 0)[0].tolist()
    [[0.0, 255.0], [0.0, 255.0], [0.0, 255.0]]
    """
    settings = settings_or_default(settings)
    if isinstance(scan, Scan):
        reflectance, ranges, there, full_turn = scan.reflectance, scan.range, scan.valid, scan.full_turn
    else:
        reflectance, ranges, there = _plain(scan, range_image, valid)
    luminance, _ = normalize(reflectance, there)
    graph = PixelGraph(
        luminance=smooth(luminance, there, settings.smoothing, wrap=full_turn),
        range_image=normalize(ranges, there)[0],
        valid=there,
        beta=settings.beta,
        neighbors=settings.neighbors,
        wrap=full_turn,
    )
    return distances_over(graph, *_pixels(rows, cols, there))


def distances_over(graph, rows, cols):
    """Return the same over a `PixelGraph`, for pixels that are nodes of it."""
    engine = engine_for(graph)
    pixels = np.ravel_multi_index((rows, cols), graph.shape)
    return np.stack([engine.field(int(pixel), engine.control()) for pixel in pixels])


def _plain(reflectance, range_image, valid):
    reflectance = np.asarray(reflectance)
    if reflectance.ndim != 2 or 0 in reflectance.shape or reflectance.dtype.kind not in "biuf":
        raise ScanError(
            "reflectance: expected a Scan or an (H, W) array of numbers, found shape {shape} of {dtype}",
            shape=reflectance.shape,
            dtype=reflectance.dtype,
        )
    ranges = np.zeros(reflectance.shape) if range_image is None else np.asarray(range_image)
    finite = np.isfinite(reflectance) & np.isfinite(ranges) if ranges.shape == reflectance.shape else None
    valid = finite if valid is None else np.asarray(valid)
    if valid is not None and valid.dtype.kind != "b":
        raise ScanError("valid: expected booleans, found {kind}; write valid > 0", kind=str(valid.dtype))
    for name, array, kinds in (("range_image", ranges, "biuf"), ("valid", valid, "b")):
        if array is not None and (array.shape != reflectance.shape or array.dtype.kind not in kinds):
            raise ScanError(
                "{name}: expected {expected} of shape {shape}, found shape {found} of {dtype}",
                name=name,
                expected="booleans" if kinds == "b" else "numbers",
                shape=reflectance.shape,
                found=array.shape,
                dtype=array.dtype,
            )
    return reflectance, ranges, valid & finite


def _pixels(rows, cols, valid):
    rows, cols = np.atleast_1d(rows), np.atleast_1d(cols)
    if rows.shape != cols.shape or rows.ndim != 1 or rows.dtype.kind not in "iu" or cols.dtype.kind not in "iu":
        raise SeedsError(
            "rows, cols: expected as many whole numbers in one as in the other, found {rows} of {row_dtype} and {cols} "
            "of {col_dtype}",
            rows=rows.shape,
            row_dtype=rows.dtype,
            cols=cols.shape,
            col_dtype=cols.dtype,
        )
    height, width = valid.shape
    for row, col in zip(rows.tolist(), cols.tolist(), strict=True):
        if not (0 <= row < height and 0 <= col < width):
            raise SeedsError(
                "row {row}, column {col} is outside the scan's grid (rows 0 to {last_row}, columns 0 to {last_col})",
                row=row,
                col=col,
                last_row=height - 1,
                last_col=width - 1,
            )
        if not valid[row, col]:
            raise SeedsError("row {row}, column {col}: no return there; choose a pixel that has one", row=row, col=col)
    return rows, cols
