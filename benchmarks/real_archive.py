"""Which photo shows which scan of an archive of real scans: python -m benchmarks.real_archive [--folder DIR]

30 real scans and 40 photos. Twenty scans are of benchmarks.trust_cases (a church from one place in six directions, a
town square in three, cars before a garage, pumps, a desk, frames of spinning lidars); ten are the same places once
more, as if scanned again: part of the grid, coarser where it is fine, with holes. Photos: of nine scans their own
colors twice, warped and cut out, in other light, as JPEG; photos of cameras that stood beside the scanner; and 14 of
other things. What is printed is that of benchmarks.archive.

Where a photo is made of a scan's own colors, or its camera is calibrated, it is known how far a camera is off. Photos
of the church show scans turned by up to 30 degrees, too; their cameras there are not known. What frames of the same
vehicle, and views of the church turned by 36 to 54 degrees, have in common is not known, either: nothing that is said
of these pairs counts.
"""

import argparse
import json

import cv2
import numpy as np

from benchmarks import real_scans, trust_cases
from benchmarks.archive import Archive, add_arguments, folder_of, measure, median_off, write_manifest
from benchmarks.matching_pairs import DATA, K4A_PHOTO, MILD, PUMP_PHOTO, WARM, in_other_light, warp
from reflcolor_addon.files.writers.ptx import write_ptx

_SCANS = tuple(name for name in trust_cases.SCANS if not name.endswith(("_every_3rd", "_large", "_all_around")))
_AGAIN = ("doria", "pumpA", "k4a", "bildstein_05", "bildstein_15", "bildstein_25", "bremen_20", "nus_front")
_AGAIN += ("pjlab_ours3", "kitti_000008")
_OTHER = ("desk", "astronaut", "brick", "camera", "chelsea", "coffee", "coins", "grass", "gravel", "motorcycle_left")
_OTHER += ("page", "rocket", "text", "moon")
# What photos show of a scan's own colors: all of it, warped, or a part of it (corners as shares of the grid).
_SHAPES = {"warped": (), "cut": (((0.25, 0.1), (1.0, 0.1), (1.0, 0.9), (0.25, 0.9)), ((0, 0), (1, 0), (1, 1), (0, 1)))}
_LIGHT = {"warped": WARM, "cut": MILD}
# From where on the grid a place is scanned again, and how fine a grid must be to be made coarser.
_FROM, _FINE = 0.15, 300


def main():
    """Make the archive, run the batch, print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    arguments = parser.parse_args()
    folder = folder_of(arguments)
    scans = [*_SCANS, *(f"{name}_again" for name in _AGAIN)]
    for name in scans:
        path = folder / f"{name}.ptx"
        if not path.is_file():
            write_ptx(_scan(name), path)
    photos = dict(_photos())
    for name, jpeg in photos.items():
        (folder / f"{name}.jpg").write_bytes(jpeg)
    write_manifest(folder, "*.ptx", "*.jpg")
    kinds = {(scan, photo): _shows(scan.removesuffix("_again"), photo) for scan in scans for photo in photos}
    archive = Archive(
        folder=folder,
        scans=scans,
        photos=list(photos),
        true={pair for pair, kind in kinds.items() if kind},
        unknown={pair for pair, kind in kinds.items() if kind is None},
        off=_off,
    )
    measure(archive, arguments)


def _scan(name):
    whole = trust_cases.scan(name.removesuffix("_again"))
    if not name.endswith("_again"):
        return whole
    first, every = _again(whole.shape)
    part = np.s_[::every, first::every]
    coarser = type(whole)(
        name=name, points=whole.points[part], reflectance=whole.reflectance[part], valid=whole.valid[part]
    )
    return trust_cases.with_holes(coarser, "blobs 3")


def _again(shape):
    """The first column of the grid that is scanned again, and its stride along both sides."""
    return round(_FROM * shape[1]), 2 if shape[0] >= _FINE else 1


def _photos():
    """Yield the name and the JPEG of each photo."""
    for name in real_scans.NAMES:
        color = real_scans.load(name, DATA).color
        for kind in _SHAPES:
            yield f"{name} {kind}", _jpeg(in_other_light(color, *warp(color.shape, *_SHAPES[kind]), _LIGHT[kind]))
    yield "k4a beside", K4A_PHOTO.read_bytes()
    yield "pumpA beside", PUMP_PHOTO.read_bytes()
    for name in trust_cases.PAIRS:
        yield f"{name} photo", (DATA / "pairs" / name / "photo.jpg").read_bytes()
    for name in _OTHER:
        yield name, _jpeg(trust_cases.photographs()[name])


def _jpeg(rgb):
    return cv2.imencode(".jpg", rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 85])[1].tobytes()


def _shows(scan, photo):
    """Whether a photo shows a scan; None where that is not known."""
    of = photo.split(" ")[0]
    if scan == of:
        return True
    if scan.startswith("bildstein") and of.startswith("bildstein"):
        views = abs(int(scan[-2:]) - int(of[-2:]))
        return views <= 5 or (None if views < 10 else False)
    return None if scan in trust_cases.PAIRS and of in trust_cases.PAIRS and scan[:3] == of[:3] else False


def _off(scan, photo, own, model):
    """See `Archive`."""
    name, (of, kind) = scan.removesuffix("_again"), photo.split(" ")
    rows, columns = np.nonzero(own.valid)
    found = model.project(model.sites_of(own, rows, columns))[0]
    if name in trust_cases.PAIRS:
        lens = json.loads((DATA / "pairs" / name / "calibration.json").read_text("utf-8"))
        # Readers move the origin of a scan to its scanner.
        points = own.points[rows, columns] @ own.pose[:3, :3].T + own.pose[:3, 3]
        xy, seen = trust_cases.projected(lens, points)
        width = lens["width"]
    elif name == of and kind in _SHAPES:
        shape = trust_cases.scan(name).shape
        first, every = _again(shape) if name != scan else (0, 1)
        if own.shape != tuple(len(range(start, side, every)) for start, side in zip((0, first), shape, strict=True)):
            raise ValueError(f"{scan} has {own.shape} pixels")
        grid = np.stack([first + every * columns + 0.5, every * rows + 0.5], axis=-1)
        homography, (width, height) = warp(shape, *_SHAPES[kind])
        xy = cv2.perspectiveTransform(grid[None], homography)[0]
        seen = (xy >= 0).all(axis=1) & (xy < (width, height)).all(axis=1)
    else:
        return None
    return median_off(found[seen] * (width / model.width) - xy[seen], width)


if __name__ == "__main__":
    main()
