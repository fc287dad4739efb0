"""The scans of the three experiments, with the photos and seeds that a person would have; simulated where missing."""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reflcolor_addon import Scan, read_scans
from reflcolor_addon.files.images import read_image

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
HOUSE_SIDES = ("south", "east", "north", "west")
# What scene 3 is colorized from, as in the files of seeds and as in words.
HOUSE_PHOTOS = {"one_photo": "one photo", "three_photos": "three photos"}


@dataclass(frozen=True, eq=False, kw_only=True)
class Case:
    """One scan and what it is colorized from.

    Parameters
    ----------
    scene : str
    variant : str
        What tells it from other cases of the same scan.
    scan : Scan
    truth : (H, W, 3) uint8
        The true sRGB of every pixel.
    seeds : Path
        The seeds that a person picked.
    photos : tuple of Path
    """

    scene: str
    variant: str
    scan: Scan
    truth: np.ndarray
    seeds: Path
    photos: tuple[Path, ...]


def load(folder):
    """Return all cases in order; scenes that are not in the folder yet are simulated there."""
    room, house = simulated(folder / "person_room"), simulated(folder / "brick_house")
    cones = EXAMPLES / "cones"
    cases = [
        _case("scene 1", "", cones, "cones", "cones", "truth", ("photo.jpg",)),
        _case("scene 2", "", room, "room", "room", "truth", ("photo_10.jpg",)),
    ]
    photos = {
        "one_photo": ("photo_25.jpg",),
        "three_photos": ("photo_25.jpg", "photo_north.jpg", "photo_west.jpg"),
    }
    for key, words in HOUSE_PHOTOS.items():
        cases += [
            _case("scene 3", words, house, side, f"{side}.{key}", f"{side}.truth", photos[key]) for side in HOUSE_SIDES
        ]
    return cases


def _case(scene, variant, folder, scan, seeds, truth, photos):
    return Case(
        scene=scene,
        variant=variant,
        scan=read_scans(folder / f"{scan}.scan.json")[0],
        truth=read_image(folder / f"{truth}.png"),
        seeds=folder / f"{seeds}.seeds.json",
        photos=tuple(folder / photo for photo in photos),
    )


def simulated(folder, script="make.py"):
    """Return the folder, in which the example of its name has written its files; done before, nothing is done."""
    finished = folder / "finished"
    if not finished.is_file():
        print(f"simulating {folder.name}, a few minutes", flush=True)
        path = EXAMPLES / folder.name / script
        subprocess.run([sys.executable, str(path), str(folder)], check=True, stdout=subprocess.DEVNULL)
        finished.touch()
    return folder
