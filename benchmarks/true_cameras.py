"""Real scans with photos whose true camera is known: what guesses and picked pairs are measured on.

The views of the church are perspective views from one place, 6 degrees apart for each number; the pairs of lidar and
camera come with their calibration.
"""

import json
from dataclasses import dataclass

import numpy as np

from benchmarks import real_scans, trust_cases
from benchmarks.matching_pairs import BILDSTEIN, DATA
from reflcolor_addon import Scan
from reflcolor_addon.files.images import read_image
from reflcolor_addon.matching.models import Camera, camera_axes

_FOCAL = 311.77


@dataclass(frozen=True, eq=False)
class Known:
    """A scan and a photo of known camera.

    camera : Camera
        The best of the product's model (principal point in the middle, one distortion).
    project : callable
        Where the photo truly shows points (N, 3) of the scan: (N, 2) pixels, and which of them it can show.
    truth, known : (H, W, 3) uint8, (H, W) bool
    """

    label: str
    scan: Scan
    photo: np.ndarray
    camera: Camera
    project: object
    truth: np.ndarray
    known: np.ndarray


def every():
    """Yield all of them."""
    for own, other in [(a, b) for a in range(6) for b in (a - 1, a + 1) if 0 <= b < 6]:
        yield _view(BILDSTEIN[own], BILDSTEIN[other])
    for name in trust_cases.PAIRS:
        yield pair(name)


def _view(own, other):
    scan = real_scans.load(f"bildstein_{own}", DATA)
    photo = real_scans.load(f"bildstein_{other}", DATA).color
    height, width = photo.shape[:2]
    camera = Camera(camera_axes(6.0 * (int(own) - int(other)), 0, 0), np.zeros(3), _FOCAL, 0.0, width, height)

    def project(points):
        xy, depth = camera.project(points)
        return xy, (depth > 0) & (xy >= 0).all(axis=1) & (xy < [width, height]).all(axis=1)

    return Known(f"{scan.name}, {other}", scan, photo, camera, project, scan.color, real_scans.has_truth(scan))


def pair(name):
    """Return one of the pairs of lidar and camera."""
    folder = DATA / "pairs" / name
    scan, photo = trust_cases.scan(name), read_image(folder / "photo.jpg")
    lens = json.loads((folder / "calibration.json").read_text("utf-8"))
    with np.load(folder / "scan.npz") as arrays:
        truth, known = arrays["truth"], arrays["known"]

    def project(points):
        return trust_cases.projected(lens, points)

    rotation = np.array(lens["R"])
    start = Camera(
        rotation, -rotation.T @ np.array(lens["t"]), lens["fx"], lens["k1k2p1p2k3"][0], lens["width"], lens["height"]
    )
    return Known(name, scan, photo, _nearest(start, scan.points[known], project), project, truth, known)


def _nearest(camera, points, project):
    """The camera whose rotation, focal length and distortion put the points nearest to where they are seen."""
    from scipy.optimize import least_squares

    xy, shown = project(points)
    points, xy = points[shown][::5], xy[shown][::5]

    def moved(values):
        candidate = np.zeros(8)
        candidate[list(camera.TURNED)] = values
        return camera.moved(candidate, 1.0)

    solved = least_squares(lambda values: (moved(values).project(points)[0] - xy).ravel(), np.zeros(5), loss="soft_l1")
    return moved(solved.x)
