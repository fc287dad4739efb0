"""Colors guessed for what no photo saw: python -m benchmarks.guesses

For every scan whose photo's camera is known (benchmarks.true_cameras), seeds are made as for a verified photo of that
camera. Printed is the mean CIEDE2000 of the guessed ones beside that of the photo's mean color at the same places: of
color alone (with the true luminance) and as they come; and how many guesses are nearer to the truth than that.
"""

import numpy as np
from skimage.color import deltaE_ciede2000, rgb2lab

from benchmarks import true_cameras
from reflcolor_addon.matching import match_photos
from reflcolor_addon.matching.registration import location
from reflcolor_addon.matching.registration.registration import Registration
from reflcolor_addon.matching.registration.verification import Evidence

_CERTAIN = Evidence(100.0, 100, 100, 10.0, 1.0, 1000.0)


def main():
    """Print the table."""
    print(f"{'scan, photo':18} {'guesses':>7} {'helpful':>7}   alone   mean color   as they come   mean color")
    total = np.zeros(2, int)
    for known in true_cameras.every():
        location.register = lambda views, photo, step, known=known: Registration(known.camera, _CERTAIN, "known")
        seeds = match_photos(known.scan, [known.photo]).seeds
        guessed = np.array([reason == "appearance" for reason in seeds.reason]) & known.known[seeds.rows, seeds.cols]
        # Parts that no seed reaches at all get the mean color of what was seen, and say so by a confidence near 0.
        guessed &= seeds.confidence > 0.1
        truth = known.truth[seeds.rows, seeds.cols][guessed]
        mean = np.broadcast_to(np.rint(known.photo.reshape(-1, 3).mean(axis=0)).astype(np.uint8), truth.shape)
        errors = [difference(colors, truth, alone) for alone in (True, False) for colors in (seeds.rgb[guessed], mean)]
        total += len(truth), int((errors[0] < errors[1]).sum())
        figures = "   ".join(f"{error.mean():7.2f}" for error in errors) if len(truth) else "none"
        print(f"{known.label:18} {len(truth):7d} {(errors[0] < errors[1]).sum():7d}   {figures}", flush=True)
    print(f"all: {total[0]} guesses, {total[1]} helpful")


def difference(rgb, truth, alone):
    """(N,) CIEDE2000 of colors (N, 3) uint8; with the truth's luminance for color alone."""
    lab, true = rgb2lab(rgb[None] / 255.0)[0], rgb2lab(truth[None] / 255.0)[0]
    if alone:
        lab[:, 0] = true[:, 0]
    return deltaE_ciede2000(true, lab)


if __name__ == "__main__":
    main()
