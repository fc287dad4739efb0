"""A scan into a pair of images, range and reflectance, and the small file that describes them."""

from os import PathLike
from pathlib import Path

import numpy as np

from ...errors import OutputError
from ...scan.directions import directions
from ...scan.scan import Scan
from ..images import write_png
from ..readers.scan_json import write_scan_json

SUFFIX = ".scan.json"
_FULL = 65535
# Largest distance, in steps, of a point from the ray of its pixel.
_GRID_TOLERANCE = 0.25


def write_image_pair(
    scan: Scan,
    path: PathLike | str,
    *,
    range_scale: float = 1e-4,
    azimuth_deg: tuple[float, float] | None = None,
    elevation_deg: tuple[float, float] | None = None,
) -> None:
    """Write ``NAME.scan.json`` and its images: ``NAME.range.png``, ``NAME.reflectance.png`` and ``.color.png`` if any.

    Range and reflectance have 16 bits; range 0 is no return. Reflectance within 0..1 is stored as 0..65535, whole
    numbers up to 65535 as they are, anything else stretched to 0..65535. The pose is kept.

    Parameters
    ----------
    scan : Scan
        On a regular grid of azimuth and elevation.
    path : path-like
        Ends in ``.scan.json``.
    range_scale : float
        Meters per step of the range image; made coarser where 16 bits would not hold the greatest range.
    azimuth_deg, elevation_deg : (low, high) of float, optional
        Outer edges of the image in degrees; found from the points where not given.

    Raises
    ------
    OutputError
        If the points do not lie on such a grid, the name does not end in ``.scan.json``, or a file cannot be written.

    Examples
    --------
    >>> from reflcolor_addon import read_scans, write_image_pair
    >>> write_image_pair(read_scans("garage.ptx")[0], "garage.scan.json")
    """
    path = Path(path)
    if not path.name.endswith(SUFFIX):
        raise OutputError("{path}: cannot be written: an image pair's name ends in {suffix}", path=path, suffix=SUFFIX)
    if azimuth_deg is None or elevation_deg is None:
        azimuth_deg, elevation_deg = spherical_limits_deg(scan)
    _check_grid(scan, azimuth_deg, elevation_deg)
    farthest = float(scan.range.max())
    if farthest > _FULL * range_scale:
        range_scale = float(f"{farthest / _FULL * 1.0001:.6g}")
    # A return nearer than half a step would read as none.
    steps = np.where(scan.valid, np.maximum(np.round(scan.range / range_scale), 1), 0).astype(np.uint16)
    images = {"range": steps, "reflectance": _as_16_bit(scan)}
    if scan.color is not None:
        images["color"] = scan.color
    paths = {key: path.with_name(f"{path.name.removesuffix(SUFFIX)}.{key}.png") for key in images}
    for key, image in images.items():
        write_png(paths[key], image)
    # Last, so that the file that names the others is never there without them.
    write_scan_json(
        path,
        range_image=paths["range"],
        reflectance_image=paths["reflectance"],
        color_image=paths.get("color"),
        model={"type": "spherical", "azimuth_deg": list(azimuth_deg), "elevation_deg": list(elevation_deg)},
        range_scale=range_scale,
        pose=None if np.array_equal(scan.pose, np.eye(4)) else scan.pose,
    )


def spherical_limits_deg(scan):
    """Return ((left, right), (bottom, top)), the outer edges in degrees of a scan on a regular spherical grid.

    Raises
    ------
    OutputError
        If the scan has too few returns to tell.
    """
    valid, points = scan.valid, scan.points
    rows, columns = np.flatnonzero(valid.any(axis=1)), np.flatnonzero(valid.any(axis=0))
    if rows.size < 2 or columns.size < 2:
        raise OutputError(
            "{scan}: too few returns to find the grid's angles; give azimuth_deg and elevation_deg", scan=scan.name
        )
    elevation = np.degrees(np.arctan2(points[..., 2], np.hypot(points[..., 0], points[..., 1])))
    top = np.ma.median(np.ma.array(elevation, mask=~valid), axis=1).filled(np.nan)[rows]
    azimuth = np.degrees(np.arctan2(points[..., 0], points[..., 1]))
    # Relative to each column's first valid azimuth, so that the cut at 180 degrees does not fall inside a column.
    first = azimuth[np.argmax(valid, axis=0), np.arange(scan.shape[1])]
    around = (azimuth - first + 180) % 360 - 180
    middle = (first + np.ma.median(np.ma.array(around, mask=~valid), axis=0).filled(np.nan))[columns]
    middle = np.degrees(np.unwrap(np.radians(middle)))
    return _outer_edges(columns, middle, scan.shape[1]), _outer_edges(rows, top, scan.shape[0])[::-1]


def _outer_edges(places, angles, count):
    slope, start = np.polyfit(places, angles, 1)
    return float(start - slope / 2), float(start + slope * (count - 0.5))


def _check_grid(scan, azimuth_deg, elevation_deg):
    (left, right), (bottom, top) = azimuth_deg, elevation_deg
    height, width = scan.shape
    step = (right - left) / width, (top - bottom) / height
    azimuths = left + (np.arange(width) + 0.5) * step[0]
    elevations = top - (np.arange(height) + 0.5) * step[1]
    rays = directions(azimuths, elevations)
    away = np.linalg.norm(rays * scan.range[..., None] - scan.points, axis=-1)[scan.valid]
    allowed = np.radians(max(abs(step[0]), abs(step[1]))) * _GRID_TOLERANCE * scan.range[scan.valid] + 1e-4
    if (away > allowed).any():
        raise OutputError("{scan}: its points lie on no regular grid of angles; write it as PTX or E57", scan=scan.name)


def _as_16_bit(scan):
    values = np.where(scan.valid, scan.reflectance, 0).astype(np.float64)
    inside = values[scan.valid]
    low, high = (float(inside.min()), float(inside.max())) if inside.size else (0.0, 1.0)
    if low >= 0 and high <= 1:
        values = values * _FULL
    elif low < 0 or high > _FULL or (inside != np.round(inside)).any():
        values = np.where(scan.valid, (values - low) / max(high - low, 1e-300) * _FULL, 0)
    return np.round(values).astype(np.uint16)
