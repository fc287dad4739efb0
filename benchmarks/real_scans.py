"""The public scans that carry their own truth, for tests and measurements: `color` of each is the truth.

`pumpA` and `doria` are scanners' files; the others are image pairs, described here as a user would describe them.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.readers.scan_json import write_scan_json

_FILES = {"pumpA": "pumpA/pumpAVisualReferenceImage.e57", "doria": "doria_ptx/1.ptx"}

# The depth images were equalized: each of the 255 gray values occurs equally often, so no scale and offset fit. These
# are the meters at every 16th value, found by making the overlaps of the views agree (a turn of 6 degrees per step of
# N, a field of view of 60 degrees: the residual is 0.3 % in the median) and setting the lawn 1.75 m below the scanner.
# It comes out flat to 0.5 % as depth along the axis, and to 3 % as length of the ray: so depth it is.
_VALUES = (*range(0, 241, 16), 254)
_METRES = {
    "01": (3.31, 3.41, 3.54, 3.71, 3.89, 4.09, 4.32, 4.59, 4.92, 5.33, 5.83, 6.83, 10.8, 17.6, 37.7, 59.2, 67.8),
    "05": (3.43, 3.76, 4.09, 4.42, 4.71, 5.03, 5.42, 5.90, 6.85, 7.86, 9.57, 14.2, 17.3, 27.5, 42.6, 59.6, 71.8),
    "10": (3.54, 3.82, 4.16, 4.56, 5.07, 5.55, 6.03, 6.61, 7.06, 7.72, 9.07, 14.8, 21.1, 31.7, 45.2, 59.6, 75.1),
    "15": (3.46, 3.79, 4.14, 4.57, 5.10, 5.79, 6.31, 6.65, 7.04, 7.78, 11.2, 22.0, 33.9, 47.1, 47.1, 55.9, 76.1),
    "20": (3.28, 3.65, 3.97, 4.40, 4.91, 5.53, 6.24, 7.34, 8.87, 11.5, 15.5, 24.2, 34.8, 40.9, 44.5, 50.9, 84.6),
    "25": (3.13, 3.41, 3.67, 3.97, 4.38, 4.91, 5.66, 6.56, 7.81, 9.51, 12.3, 16.0, 23.9, 40.4, 42.9, 62.6, 72.9),
}

NAMES = (*_FILES, *(f"bildstein_{view}" for view in _METRES), "k4a")


def load(name, data_dir):
    """Open one of `NAMES`.

    Parameters
    ----------
    name : str
    data_dir : path-like
        The folder of the shared data.

    Returns
    -------
    Scan
    """
    data_dir = Path(data_dir)
    if name in _FILES:
        (scan,) = read_scans(data_dir / _FILES[name])
        return replace(scan, name=name)
    with TemporaryDirectory() as folder:
        path = Path(folder, f"{name}.scan.json")
        write_scan_json(path, **_description(name, data_dir))
        (scan,) = read_scans(path, outside=True)
    return replace(scan, source=None)


def has_truth(scan):
    """(H, W) bool: pixels with a return whose true color was seen; black is what the files hold elsewhere."""
    return scan.valid & scan.color.any(axis=-1)


def _description(name, data_dir):
    """Keyword arguments of `write_scan_json` for an image pair."""
    if name == "k4a":
        folder = data_dir / "k4a_mug"
        return {
            "range_image": folder / "depth16_mm.png",
            "range_scale": 0.001,
            "reflectance_image": folder / "ir16.png",
            "color_image": folder / "color_aligned_to_depth.png",
            # The usual calibration of this camera; with it the wall on the left is flat to 0.7 mm, without to 2.5.
            "model": {
                "type": "pinhole",
                "fx": 504.0,
                "fy": 504.0,
                "cx": 320.0,
                "cy": 330.0,
                "distortion": [0.4878, 0.0320, 0.0, 0.0, 0.0019, 0.8265, 0.1244, 0.0108],
            },
        }
    view = name.removeprefix("bildstein_")
    folder, yaw = data_dir / "bildstein3_views", np.radians(6.0 * int(view))
    return {
        "range_image": folder / f"Depth_{view}.png",
        "range_table": list(zip(_VALUES, _METRES[view], strict=True)),
        "reflectance_image": folder / f"Intensity_{view}.png",
        "color_image": folder / f"RGB_{view}.png",
        "color_order": "bgr",
        "model": {"type": "pinhole", "fx": 311.77, "fy": 311.77, "cx": 179.5, "cy": 179.5},
        "pose": [
            [np.cos(yaw), -np.sin(yaw), 0, 0],
            [np.sin(yaw), np.cos(yaw), 0, 0],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ],
    }
