"""Scans, holes and photos that benchmarks.trust tries: what shows the scan, and what does not."""

import json
import zlib
from dataclasses import replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from benchmarks import matching_pairs, real_scans
from benchmarks.matching_pairs import BILDSTEIN, DATA, K4A_PHOTO, PUMP_PHOTO
from reflcolor_addon import Scan
from reflcolor_addon.files.images import read_image
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.readers.scan_json import write_scan_json

PAIRS = ("kitti_000008", "nus_back_right", "nus_front", "nus_front_left", "pjlab_ours1", "pjlab_ours3")
TURNS = ("nus_front", "pjlab_ours1", "pjlab_ours3")
_BREMEN = ("01", "20", "40")
_OUSTER = {
    "ouster_1": ("OS-1-128_v2.3.0_1024x10_lb_n3_scan0.npz", 22.5),
    "ouster_2": ("OS-2-128-U1_v2.3.0_1024x10_scan0.npz", 11.25),
}
SCANS = (
    *real_scans.NAMES,
    *(f"bremen_{view}" for view in _BREMEN),
    *_OUSTER,
    *PAIRS,
    *(f"{name}_all_around" for name in TURNS),
    *(f"{name}_every_3rd" for name in ("pumpA", "bildstein_05", "bildstein_20", "bremen_20", "k4a")),
    "pumpA_large",
)
HOLES = ("none", *(f"{kind} {share}" for kind in ("pixels", "lines", "blobs") for share in (3, 6, 12, 20)))
NOISE = (2, 6, 15, 40)
# Not the noise and phases of the tries by which the bar was chosen.
_SEED = 2026
# Photographs that come with scikit-image, of nothing that any scan here shows.
_LIBRARY = [
    "astronaut.png",
    "brick.png",
    "camera.png",
    "cell.png",
    "chelsea.png",
    "coffee.png",
    "coins.png",
    "grass.png",
    "gravel.png",
    "horse.png",
    "hubble_deep_field.jpg",
    "ihc.png",
    "moon.png",
    "motorcycle_left.png",
    "page.png",
    "retina.jpg",
    "rocket.jpg",
    "text.png",
]


def scan(name):
    """Return one of `SCANS`."""
    if name.endswith("_every_3rd"):
        whole = scan(name.removesuffix("_every_3rd"))
        return _strided(whole, name, 3)
    if name == "pumpA_large":
        return _enlarged(scan("pumpA"), name, 3)
    if name in real_scans.NAMES:
        return real_scans.load(name, DATA)
    if name.startswith("bremen"):
        return _bremen(name.removeprefix("bremen_"))
    if name in _OUSTER:
        return _ouster(name)
    file = "scan_full_turn.npz" if name.endswith("_all_around") else "scan.npz"
    with np.load(DATA / "pairs" / name.removesuffix("_all_around") / file) as arrays:
        points, reflectance, valid = (arrays[key] for key in ("points", "reflectance", "valid"))
    return Scan(name=name, points=points.astype(float), reflectance=reflectance, valid=valid)


def with_holes(whole, holes):
    """Return the scan with more holes: "none", or pixels, lines or blobs of a share in percent, always the same."""
    if holes == "none":
        return whole
    kind, percent = holes.split()
    share, rng = int(percent) / 100, np.random.default_rng(int(percent))
    missing = np.zeros(whole.shape, np.uint8)
    if kind == "pixels":
        missing = rng.random(whole.shape) < share
    else:
        height, width = whole.shape
        while missing.mean() < share:
            x, y = rng.uniform(0, [width, height])
            if kind == "lines":
                angle, length = rng.uniform(0, np.pi), rng.uniform(0.1, 0.5) * max(whole.shape)
                end = round(x + length * np.cos(angle)), round(y + length * np.sin(angle))
                cv2.line(missing, (round(x), round(y)), end, 1, int(rng.integers(1, 3)))
            else:
                axes = rng.uniform(1, 0.03 * max(whole.shape) + 1, 2)
                cv2.ellipse(missing, ((x, y), tuple(2 * axes), rng.uniform(0, 180)), 1, -1)
    return replace(whole, valid=whole.valid & (missing == 0))


@cache
def photographs():
    """Return every photograph there is: a dict of name and (H, W, 3) uint8."""
    import skimage

    photos = {f"bildstein_{view}": real_scans.load(f"bildstein_{view}", DATA).color for view in BILDSTEIN}
    photos |= {name: real_scans.load(name, DATA).color for name in ("doria", "pumpA")}
    photos |= {"k4a photo": read_image(K4A_PHOTO), "pumpA photo": read_image(PUMP_PHOTO)}
    photos |= {name: read_image(DATA / "pairs" / name / "photo.jpg") for name in PAIRS}
    photos["desk"] = read_image(next((DATA / "pcl_organized").glob("*rgb.tiff")))
    folder = Path(skimage.__file__).parent / "data"
    photos |= {name.split(".")[0]: read_image(folder / name) for name in _LIBRARY if (folder / name).is_file()}
    return photos


def wrong(scan_name, kind):
    """Yield the name and the (H, W, 3) uint8 of every photo of one kind that does not show a scan.

    noise: blurred, of four scales. foreign: photographs of something else. elsewhere: of the same site in another
    direction. mirrored: photographs that show the scan, left and right exchanged. upside-down: these turned on
    their heads. scrambled: photographs whose phases are random, those of the scan among them. reflectance: another
    scan's reflectance.
    """
    photos = photographs()
    if kind == "noise":
        for sigma in NOISE:
            yield f"sigma {sigma}", noise(sigma, zlib.crc32(scan_name.encode()))
    elif kind == "foreign":
        yield from ((name, rgb) for name, rgb in photos.items() if _place(name) != _place(scan_name))
    elif kind == "elsewhere":
        yield from ((name, rgb) for name, rgb in photos.items() if _elsewhere(scan_name, name))
    elif kind in ("mirrored", "upside-down"):
        turn = np.s_[:, ::-1] if kind == "mirrored" else np.s_[::-1]
        yield from ((name, rgb[turn].copy()) for name, rgb in photos.items() if _shows(scan_name, name))
    elif kind == "scrambled":
        yield from ((name, scrambled(name)) for name in photos)
    elif kind == "reflectance":
        for other in SCANS:
            if _place(other) != _place(scan_name) and "_every" not in other and other != "pumpA_large":
                yield other, reflectance_image(other)


WRONG = ("noise", "foreign", "elsewhere", "mirrored", "upside-down", "scrambled", "reflectance")


def right(scan_name):
    """Yield the kind, the name and the image of every photo that shows a scan."""
    if scan_name in real_scans.NAMES:
        color = real_scans.load(scan_name, DATA).color
        yield "straight", "own", color
        yield "warped", "own", matching_pairs.warped_photo(color)
        yield "warped-mild", "own", matching_pairs.warped_photo(color, (1.02, 1.0, 0.95))
    if scan_name.startswith("bildstein") and "_every" not in scan_name:
        own = BILDSTEIN.index(scan_name[-2:])
        for other in BILDSTEIN[max(0, own - 1) : own] + BILDSTEIN[own + 1 : own + 2]:
            yield "turned", f"view {other}", real_scans.load(f"bildstein_{other}", DATA).color
    if scan_name == "bildstein_25":
        yield from (("resized", name, rgb) for name, rgb in _resized(real_scans.load("bildstein_20", DATA).color))
    if scan_name == "k4a":
        yield "beside", "k4a photo", read_image(K4A_PHOTO)
    if scan_name.removesuffix("_all_around") in PAIRS:
        name = scan_name.removesuffix("_all_around")
        yield "all around" if name != scan_name else "pair", name, photographs()[name]


RIGHT = ("straight", "warped", "warped-mild", "turned", "resized", "beside", "pair", "all around")


def _resized(rgb):
    """A picture of 360 pixels enlarged, up to 60 megapixels, and stored as JPEG: names and images."""
    height, width = rgb.shape[:2]
    for factor, kind, name in (
        (2, cv2.INTER_CUBIC, "twice"),
        (6, cv2.INTER_CUBIC, "six times"),
        (6, cv2.INTER_LANCZOS4, "six times, Lanczos"),
        (np.sqrt(60e6 / (height * width)), cv2.INTER_LINEAR, "60 megapixels"),
    ):
        yield name, cv2.resize(rgb, (round(width * factor), round(height * factor)), interpolation=kind)
    for quality in (70, 85, 100):
        data = cv2.imencode(".jpg", rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        yield f"JPEG {quality}", cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1].copy()


def off(scan_name, model):
    """Return how far a camera of one of `PAIRS` is off in the median, as a share of the photo's width."""
    folder = DATA / "pairs" / scan_name.removesuffix("_all_around")
    lens = json.loads((folder / "calibration.json").read_text("utf-8"))
    whole = scan(folder.name)
    points, grid_xy = whole.points[whole.valid], _grid_xy(whole)[whole.valid]
    xy, shown = projected(lens, points)
    found = model.project((points if model.kind == "pose" else grid_xy)[shown])[0]
    return float(np.nanmedian(np.linalg.norm(found - xy[shown], axis=1)) / lens["width"])


def projected(lens, points):
    """Return where a calibrated camera sees points (N, 3), (N, 2) pixels, and (N,) bool whether it can."""
    turn, shift = cv2.Rodrigues(np.array(lens["R"]))[0], np.array(lens["t"])
    matrix = np.array([[lens["fx"], 0, lens["cx"]], [0, lens["fy"], lens["cy"]], [0, 0, 1]])
    xy = cv2.projectPoints(points, turn, shift, matrix, np.array(lens["k1k2p1p2k3"]))[0][:, 0]
    x, y, ahead = (points @ np.array(lens["R"]).T + lens["t"]).T
    size = np.array([lens["width"], lens["height"]])
    # Far beyond its edge a lens's polynomial comes back into the photo.
    near = np.hypot(x, y) < 0.6 * np.hypot(*size) / lens["fx"] * np.maximum(ahead, 1e-9)
    return xy, (ahead > 1) & near & (xy > 0).all(axis=1) & (xy < size).all(axis=1)


def noise(sigma, seed, shape=(480, 1280)):
    """Return random noise, blurred by ``sigma`` pixels, at full contrast."""
    grain = np.random.default_rng([_SEED, seed, sigma]).standard_normal((*shape, 3)).astype(np.float32)
    blurred = cv2.GaussianBlur(grain, (0, 0), sigma)
    return np.clip(128 + 64 * blurred / blurred.std(), 0, 255).astype(np.uint8)


@cache
def scrambled(name):
    """Return one of `photographs`, at most 1,200 pixels a side, with the same spectrum and random phases."""
    rgb = photographs()[name]
    scale = min(1.0, 1200 / max(rgb.shape))
    image = cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA).astype(np.float32)
    random = np.angle(np.fft.rfft2(np.random.default_rng(_SEED).standard_normal(image.shape[:2])))[..., None]
    phase = np.exp(1j * random)
    phase[0, 0] = 1
    changed = np.fft.irfft2(np.fft.rfft2(image, axes=(0, 1)) * phase, image.shape[:2], axes=(0, 1))
    return np.clip(changed, 0, 255).astype(np.uint8)


@cache
def reflectance_image(name):
    """Return a scan's reflectance as a gray photo, at least 400 pixels wide."""
    from reflcolor_addon.matching import scan_image

    own = scan(name)
    vertical, horizontal = scan_image.pixel_steps(own)
    height, width = own.shape[0] * vertical, own.shape[1] * horizontal
    scale = max(400, own.shape[1]) / width
    gray = cv2.resize(
        scan_image.reflectance_image(own, "percentiles"), (round(width * scale), max(16, round(height * scale)))
    )
    return np.repeat(np.rint(np.clip(gray, 0, 255)).astype(np.uint8)[..., None], 3, axis=-1)


def _place(name):
    """The site that a scan or a photo is of; all frames of one vehicle count as one."""
    return name.split(" ")[0].split("_")[0]


def _shows(scan_name, photo):
    if scan_name.startswith("bildstein"):
        view = scan_name.split("_")[1]
        return photo.startswith("bildstein") and abs(int(view) - int(photo[-2:])) <= 5
    return photo.split(" ")[0] in (scan_name.removesuffix("_all_around"), scan_name.split("_")[0])


def _elsewhere(scan_name, photo):
    """Whether a photo is of the same site, but shows nothing of what the scan sees."""
    if scan_name.startswith("bildstein") and photo.startswith("bildstein"):
        return abs(int(scan_name.split("_")[1]) - int(photo[-2:])) >= 15
    return scan_name in PAIRS and photo in PAIRS and photo != scan_name and _place(photo) == _place(scan_name)


def _strided(whole, name, every):
    part = np.s_[::every, ::every]
    return replace(
        whole,
        name=name,
        points=whole.points[part],
        reflectance=whole.reflectance[part],
        valid=whole.valid[part],
        color=None,
    )


def _enlarged(whole, name, factor):
    """A scan of so many times the rows and columns: pixels repeated, their directions in between."""
    size = (whole.shape[1] * factor, whole.shape[0] * factor)
    valid = cv2.resize(whole.valid.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0
    reach = cv2.resize(whole.range, size, interpolation=cv2.INTER_NEAREST)
    directions = cv2.resize(np.nan_to_num(whole.points / np.maximum(whole.range, 1e-9)[..., None]), size)
    directions /= np.maximum(np.linalg.norm(directions, axis=-1, keepdims=True), 1e-9)
    gray = cv2.resize(whole.reflectance, size, interpolation=cv2.INTER_NEAREST)
    return Scan(name=name, points=directions * reach[..., None], reflectance=gray, valid=valid)


def _bremen(view):
    """A view of a town square; its depth is equalized, and meters like those of the other views make it a scene."""
    import tempfile

    folder = DATA / "bremen_views"
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary, f"bremen_{view}.scan.json")
        meters = real_scans._METRES["15"]
        write_scan_json(
            path,
            range_image=folder / f"Depth_{view}.png",
            range_table=list(zip(real_scans._VALUES, meters, strict=True)),
            reflectance_image=folder / f"Intensity_{view}.png",
            model={"type": "pinhole", "fx": 311.77, "fy": 311.77, "cx": 179.5, "cy": 179.5},
        )
        (found,) = read_scans(path, outside=True)
    return replace(found, source=None)


def _ouster(name):
    file, half = _OUSTER[name]
    with np.load(DATA / "ouster" / file) as arrays:
        meters, gray = arrays["range"] / 1000.0, arrays["reflectivity"].astype(np.float32)
    rows, columns = meters.shape
    up = np.radians(np.linspace(half, -half, rows))[:, None]
    turn = np.linspace(-np.pi, np.pi, columns, endpoint=False)[None]
    rays = np.stack([np.sin(turn) * np.cos(up), np.cos(turn) * np.cos(up), np.sin(up) + 0 * turn], axis=-1)
    return Scan(name=name, points=rays * meters[..., None], reflectance=gray, valid=meters > 0)


def _grid_xy(whole):
    x, y = np.meshgrid(np.arange(whole.shape[1]) + 0.5, np.arange(whole.shape[0]) + 0.5)
    return np.stack([x, y], axis=-1)
