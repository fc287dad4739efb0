"""Why photos of spinning lidars are not verified: python -m benchmarks.lidar_search [FRAME ...]

For each frame with the photo of a calibrated camera: the evidence (1 is needed of what was searched for) of the true
camera, of the camera fitted from there, which no search could better, and of what the search finds, with their strength
and tiles in place and how far they are off in the median, as a share of the photo's width. Then, of the search's
guesses from the scanner's place, which is the nearest: how far it is off, and how many are ranked before it.
"""

import argparse

import numpy as np

from benchmarks import true_cameras, trust_cases
from benchmarks.hand_pairs import distance
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.fitting import FINE, finely
from reflcolor_addon.matching.registration.registration import ScanViews, register
from reflcolor_addon.matching.registration.search import Search
from reflcolor_addon.matching.registration.verification import evidence, searched


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("frames", nargs="*", metavar="FRAME", help=f"of {', '.join(trust_cases.PAIRS)}; else all")
    for name in parser.parse_args().frames or trust_cases.PAIRS:
        of_frame(true_cameras.pair(name))


def of_frame(known):
    """Print one frame."""
    views, photo = ScanViews(known.scan), PhotoImage("photo", known.photo)
    true = evidence(views.image(FINE[0]), photo, known.camera)
    fitted, proof = finely(views, photo, known.camera, np.random.default_rng(0))
    found = register(views, photo)
    for what, camera, own in (
        ("true camera", known.camera, searched(true)),
        ("fitted from it", fitted, searched(proof)),
        ("found", found.model, found.evidence),
    ):
        off = "" if camera is None else f", off {100 * _off(known, camera):.2f} %"
        figures = f"strength {own.strength:5.2f}, {own.in_place} of {own.tiles} tiles"
        print(f"{known.label:16} {what:15} evidence {own.share:.2f}, {figures}{off}", flush=True)
    guesses = Search(views, photo).from_scanner()
    off = [_off(known, guess.camera(photo)) for guess in guesses]
    nearest = int(np.argmin(off))
    print(f"{known.label:16} nearest guess   off {100 * off[nearest]:.1f} %, {nearest} ranked before it", flush=True)


def _off(known, camera):
    """How far a camera is off in the median of all that the photo shows, as a share of the photo's width."""
    return distance(known, camera) / known.photo.shape[1]


if __name__ == "__main__":
    main()
