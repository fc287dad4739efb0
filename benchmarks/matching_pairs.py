"""The pairs of scan and photo that benchmarks.matching measures."""

import itertools
import os
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from benchmarks import real_scans
from benchmarks.experiments import cases
from reflcolor_addon import Scan, Seeds, read_scans
from reflcolor_addon.files.images import read_image

DATA = Path(os.environ.get("REFLCOLOR_DATA") or "../shared/data")
BILDSTEIN = ("01", "05", "10", "15", "20", "25")
K4A_PHOTO, PUMP_PHOTO = DATA / "k4a_mug/color_1280x720.jpg", DATA / "pumpA/pumpA_photo.jpg"
# What a person would click on in the scan of the pumps (row, column) and in the snapshot of them from another side (x,
# y): the tops of two poles, a lever, the lower end of the plinth's corner, a flange, a corner of the steel frame.
PUMP_PAIRS = (
    (394, 109, 884, 543),
    (387, 197, 790, 630),
    (312, 83, 1603, 472),
    (803, 33, 1974, 1602),
    (487, 71, 1675, 800),
    (757, 44, 1873, 1525),
)


# What another white balance multiplies red, green and blue by: that of a lamp, and that of another camera.
WARM, MILD = (1.08, 0.95, 0.8), (1.02, 1.0, 0.95)
# The corners of a grid, and where a strong warp moves them.
_ALL, _WARPED = ((0, 0), (1, 0), (1, 1), (0, 1)), ((0.12, 0.06), (0.93, 0.0), (1.0, 0.95), (0.0, 0.86))
# Folder, scan, truth and what makes it; the sides of the house that its photos show nothing of.
_SCENES = (
    ("cones", "cones", "truth", "views.py"),
    ("person_room", "room", "truth", "make.py"),
    ("brick_house", "south", "south.truth", "make.py"),
)
_NOT_SHOWN = (("photo_10", "north west"), ("photo_25", "north west"), ("photo_45", "north west"))
_NOT_SHOWN += (("photo_north", "south east west"), ("photo_west", "south east north"))


@dataclass(frozen=True, eq=False)
class Pair:
    """A scan, what it is matched with, and its true colors (H, W, 3) where they are known (H, W)."""

    scan: Scan
    label: str
    photos: tuple
    truth: np.ndarray
    known: np.ndarray
    hand: Seeds | None = None


def straight(scenes):
    """Yield every scan with its own colors as the photo."""
    for name in real_scans.NAMES:
        scan = real_scans.load(name, DATA)
        yield _real(scan, "own", scan.color)


def warped(light, label):
    """Return what yields every scan with its own colors, warped, in light of another color."""

    def pairs(scenes):
        for name in real_scans.NAMES:
            scan = real_scans.load(name, DATA)
            yield _real(scan, label, warped_photo(scan.color, light))

    return pairs


def turned(scenes):
    """Yield the views of the church with their neighbors, turned by 24 or 30 degrees, both ways."""
    for first, second in itertools.pairwise(BILDSTEIN):
        for own, other in ((first, second), (second, first)):
            photo = real_scans.load(f"bildstein_{other}", DATA).color
            yield _real(real_scans.load(f"bildstein_{own}", DATA), f"view {other}", photo)


def k4a(scenes):
    """Yield the infrared camera's image with the photo of the camera beside it."""
    yield _real(real_scans.load("k4a", DATA), K4A_PHOTO.name, K4A_PHOTO)


def pump(scenes):
    """Yield the pumps with a snapshot from another side: as it is, and with six pairs picked by hand."""
    scan = real_scans.load("pumpA", DATA)
    yield _real(scan, PUMP_PHOTO.name, PUMP_PHOTO)
    rows, cols, x, y = np.array(PUMP_PAIRS).T
    photo = read_image(PUMP_PHOTO)
    hand = Seeds(rows, cols, photo[y, x], photos=(PUMP_PHOTO.name,) * len(x), photo_xy=np.column_stack([x, y]))
    yield Pair(scan, "and six pairs by hand", (PUMP_PHOTO,), scan.color, real_scans.has_truth(scan), hand)


def simulated(degrees):
    """Return what yields the scenes of the paper with photos so many degrees off the scanner's line."""

    def pairs(scenes):
        for name, scan, truth, script in _SCENES:
            folder = cases.simulated(scenes / name, script)
            (own,) = read_scans(folder / f"{scan}.scan.json")
            photo = folder / f"photo_{degrees}.jpg"
            yield Pair(own, f"{name}, {degrees} deg", (photo,), read_image(folder / f"{truth}.png"), own.valid)

    return pairs


def site(scenes):
    """Yield a label and the `Pair`s of all four scans of the house, for one photo and for three."""
    house = cases.simulated(scenes / "brick_house")
    for label, names in (
        ("one photo", ("photo_25.jpg",)),
        ("three photos", ("photo_25.jpg", "photo_north.jpg", "photo_west.jpg")),
    ):
        photos = tuple(house / name for name in names)
        pairs = []
        for side in cases.HOUSE_SIDES:
            (scan,) = read_scans(house / f"{side}.scan.json")
            pairs.append(Pair(scan, label, photos, read_image(house / f"{side}.truth.png"), scan.valid))
        yield label, pairs


def unrelated(scenes):
    """Yield every real scan with the name and the image of every photo of something else; then the simulated scenes
    with each other's photos, and the sides of the house with photos of other sides."""
    photos = {name: real_scans.load(name, DATA).color for name in real_scans.NAMES}
    photos |= {"k4a photo": read_image(K4A_PHOTO), "pumpA photo": read_image(PUMP_PHOTO)}
    for name in real_scans.NAMES:
        scan = real_scans.load(name, DATA)
        for other, photo in photos.items():
            if not _related(name, other):
                yield scan, other, photo
    folders = {name: cases.simulated(scenes / name, script) for name, _, _, script in _SCENES}
    for name, scan_name, _, _ in _SCENES:
        (scan,) = read_scans(folders[name] / f"{scan_name}.scan.json")
        for other, degrees in itertools.product(folders, (10, 45)):
            if other != name:
                yield scan, f"{other}, {degrees} deg", read_image(folders[other] / f"photo_{degrees}.jpg")
    for photo, sides in _NOT_SHOWN:
        for side in sides.split():
            (scan,) = read_scans(folders["brick_house"] / f"{side}.scan.json")
            yield scan, photo, read_image(folders["brick_house"] / f"{photo}.jpg")


GROUPS = {
    "straight": straight,
    "warped": warped(WARM, "own, warped"),
    "warped-mild": warped(MILD, "own, warped, mild"),
    "turned": turned,
    "k4a": k4a,
    "pumpA": pump,
    **{f"simulated-{degrees}": simulated(degrees) for degrees in (10, 25, 45)},
}


def warp(shape, corners=_ALL, moved=_WARPED):
    """Return what leads from a scan's grid, in pixels, to a photo of its own colors twice as large: (3, 3), and the
    photo's (width, height).

    ``corners`` of the part that is shown, as shares of the grid, are ``moved`` to places that are shares of that part.
    """
    size = np.float32([shape[1], shape[0]])
    shown, places = np.float32(corners) * size, np.float32(moved) * np.ptp(np.float32(corners), axis=0) * size * 2
    wide = 2 * np.ptp(shown, axis=0)
    return cv2.getPerspectiveTransform(shown, places), (int(wide[0]), int(wide[1]))


def in_other_light(color, homography, size, light):
    """Return a scan's own colors as a photo, warped, darker, and in other light."""
    large = cv2.warpPerspective(color, homography, size, flags=cv2.INTER_CUBIC)
    return np.clip((large / 255.0) ** 1.1 * np.array(light) * 255, 0, 255).astype(np.uint8)


def warped_photo(color, light=WARM):
    """Return a photo's own colors warped strongly, twice as large, darker, in other light, JPEG of quality 80."""
    lit = in_other_light(color, *warp(color.shape), light)
    data = cv2.imencode(".jpg", lit[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 80])[1]
    return cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1].copy()


def _real(scan, label, photo):
    return Pair(scan, label, (photo,), scan.color, real_scans.has_truth(scan))


def _related(name, other):
    """Whether a photo shows anything of a scan: it is of the same place, or turned by at most 60 degrees."""
    if name.startswith("bildstein") and other.startswith("bildstein"):
        return abs(int(name[-2:]) - int(other[-2:])) < 10
    return name.split("_")[0] == other.split(" ")[0].split("_")[0]
