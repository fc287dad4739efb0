"""Colors that verified photos saw, at every pixel, against other ways: python -m benchmarks.dense

For every pair of a scan and a photo of `benchmarks.matching` whose photo is verified: mean CIEDE2000 as the colors
come, over the whole scan, by the preset Enhanced, by Natural from the seeds alone, and by Natural with what the photo
saw; the last as a ratio to the first, as it comes and after one gain of linear light per channel, which undoes what the
light of the photo was. Then where the photo shows the scan: plain projection with the same camera (a depth buffer and
nothing else, as CloudCompare and MeshLab project photos) and ours. Where the photo did not see it: Natural to Enhanced.
The structural similarity of the luminance; and the step in color across the border of what was seen, as a ratio to the
step that the truth has there. "rank" is the rank correlation of the confidence with the error as the colors come; below
each group stands the mean error where the confidence is 0 to 0.1, 0.1 to 0.2 and so on.

"site" is the house of scene 3, four scans from three photos. "bound" says how good a perfect method would be in the
simulated scenes (see `benchmarks.dense_bound`). "hidden" takes real pairs whose true colors are known,
hides half of what the photo shows from every method, and prints the error there: of ours, of the mean color, and of
Levin's optimization on all three channels, which is given every pixel that is not hidden. "texture" is time and memory
of an image of 4,096 pixels a side from three photos of 12 megapixels.
"""

import argparse
import time
import tracemalloc
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from benchmarks import dense_bound, matching_pairs, true_cameras
from benchmarks.dense_figures import error, lit, projected, step
from benchmarks.matching import SCENES
from benchmarks.quality.measure import reliability
from benchmarks.quality.peers import levin
from reflcolor_addon import Seeds, Settings, colorize, evaluate
from reflcolor_addon.color import colorspaces
from reflcolor_addon.color.observed import Observed
from reflcolor_addon.files.images import read_image, write_png
from reflcolor_addon.matching import Shot, match_photos, match_site, texture
from reflcolor_addon.matching.photo_image import PhotoImage

GROUPS = (
    "warped-mild",
    "warped",
    "turned",
    "k4a",
    "simulated-10",
    "simulated-25",
    "simulated-45",
    "site",
    "bound",
    "hidden",
    "texture",
)
COLUMNS = (
    "enhanced",
    "seeds",
    "natural",
    "ratio",
    "in light",
    "seen",
    "plain",
    "ours",
    "unseen",
    "ssim",
    "step",
    "rank",
)
_HIDDEN_SEEDS = 300


def main():
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}; without any, all")
    parser.add_argument("--scenes", type=Path, default=SCENES, help="simulated scenes, made there where missing")
    parser.add_argument("--pictures", type=Path, help="folder for a picture of each result beside the truth")
    parser.add_argument("--only", help="only pairs whose scan's name begins so")
    arguments = parser.parse_args()
    if unknown := set(arguments.groups) - set(GROUPS):
        parser.error(f"no group is called {sorted(unknown)[0]}; there are {', '.join(GROUPS)}")
    for group in arguments.groups or GROUPS:
        if group == "hidden":
            hidden()
        elif group == "texture":
            textured(arguments.scenes)
        elif group == "bound":
            dense_bound.bound(arguments.scenes, arguments.only or "")
        else:
            measured(group, arguments)


def measured(group, arguments):
    """Print the pairs of one group, and their means."""
    print(f"\n{group}\n{'scan':14}" + "".join(f"{name:>10}" for name in COLUMNS), flush=True)
    rows, by_confidence = [], []
    for pair, matching in _matched(group, arguments):
        if matching.observed is None:
            print(f"{pair.scan.name:14} no photo is verified", flush=True)
            continue
        row, by_tenth, picture = figures(pair, matching)
        rows.append(row)
        by_confidence.append(by_tenth)
        print(f"{pair.scan.name:14}" + "".join(f"{value:10.3f}" for value in row), flush=True)
        if arguments.pictures:
            arguments.pictures.mkdir(parents=True, exist_ok=True)
            write_png(arguments.pictures / f"{group} {pair.scan.name}.png", picture)
    if rows:
        print(f"{'mean':14}" + "".join(f"{value:10.3f}" for value in np.nanmean(rows, axis=0)), flush=True)
        _print_by_confidence(by_confidence)


def _print_by_confidence(errors):
    """Print the mean, over all pairs, of the errors by tenths of the confidence."""
    known = [[error for error in tenth if error is not None] for tenth in zip(*errors, strict=True)]
    print("by confidence " + "".join(f"{np.mean(tenth) if tenth else np.nan:10.2f}" for tenth in known), flush=True)


def _matched(group, arguments):
    if group == "site":
        _, pairs = list(matching_pairs.site(arguments.scenes))[1]
        yield from zip(pairs, match_site([pair.scan for pair in pairs], pairs[0].photos, Settings()), strict=True)
        return
    for pair in matching_pairs.GROUPS[group](arguments.scenes):
        if pair.scan.name.startswith(arguments.only or ""):
            yield pair, match_photos(pair.scan, pair.photos, Settings(), hand=pair.hand)


def figures(pair, matching):
    """Return one figure for each of `COLUMNS`, the error by tenths of the confidence, and a picture: ours, the truth,
    what was seen."""
    scan, truth, known, observed = pair.scan, pair.truth, pair.known, matching.observed
    enhanced = colorize(scan, matching.seeds, Settings.preset("Enhanced")).rgb
    natural = Settings.preset("Natural")
    seeds, result = (colorize(scan, matching.seeds, natural, given) for given in (None, observed))
    seeds, ours = seeds.rgb, result.rgb
    sure = reliability(result.confidence, ours, replace(scan, color=truth), known)
    plain, shown = projected(pair, matching)
    shown &= known
    seen = known & observed.seen
    whole = [error(rgb, truth, known) for rgb in (enhanced, seeds, ours)]
    in_light = [error(lit(rgb, truth, known), truth, known) for rgb in (ours, enhanced)]
    row = (
        *whole,
        whole[2] / whole[0],
        in_light[0] / in_light[1],
        seen.sum() / known.sum(),
        error(plain, truth, shown),
        error(ours, truth, shown),
        error(ours, truth, known & ~seen) / error(enhanced, truth, known & ~seen),
        evaluate(ours, truth, known)["structural_similarity"],
        step(ours, observed.seen, scan, known) / step(truth, observed.seen, scan, known),
        sure["rank_correlation"],
    )
    beside = np.where(observed.seen[..., None], ours, 255 - (255 - ours) // 3)
    return row, sure["by_tenth"], np.concatenate([ours, truth, beside], axis=1 if scan.shape[0] > scan.shape[1] else 0)


def hidden():
    """Print the error of half of what photos show, hidden."""
    print(f"\nhidden\n{'pair':40}{'ours':>10}{'mean color':>12}{'Levin':>10}{'rank':>10}", flush=True)
    by_confidence = []
    for name, scan, truth, known in _real_pairs():
        cols = np.nonzero(known)[1]
        left = known & (np.arange(scan.shape[1]) < np.median(cols))
        for label, given in (("left half seen", left), ("right half seen", known & ~left)):
            asked = known & ~given
            observed = Observed(
                np.where(given[..., None], truth, 0).astype(np.uint8),
                given.astype(np.float32),
                np.where(given, 0, -1).astype(np.int16),
            )
            rows, cols = np.nonzero(given)
            few = np.linspace(0, len(rows) - 1, min(len(rows), _HIDDEN_SEEDS)).astype(int)
            seeds = Seeds(rows[few], cols[few], truth[rows[few], cols[few]], reason=["pose"] * len(few))
            result = colorize(scan, seeds, Settings.preset("Natural"), observed)
            ours, sure = result.rgb, reliability(result.confidence, result.rgb, replace(scan, color=truth), known)
            by_confidence.append(sure["by_tenth"])
            constant = np.broadcast_to(np.rint(truth[given].mean(axis=0)).astype(np.uint8), truth.shape)
            peer = _levin(scan, Seeds(rows, cols, truth[rows, cols]))
            errors = [error(rgb, truth, asked) for rgb in (ours, constant, peer)]
            line = f"{errors[0]:10.2f}{errors[1]:12.2f}{errors[2]:10.2f}{sure['rank_correlation']:10.2f}"
            print(f"{name + ', ' + label:40}"[:40] + line, flush=True)
    _print_by_confidence(by_confidence)


def _real_pairs():
    for case in true_cameras.every():
        if not case.label.startswith("bildstein"):
            yield case.label, case.scan, case.truth, case.known
    (pair,) = matching_pairs.k4a(None)
    yield "k4a", pair.scan, pair.truth, pair.known


def _levin(scan, seeds):
    """Levin's optimization on all three channels."""
    luminance = np.repeat((seeds.rgb @ colorspaces.LUMA)[:, None], 2, axis=1)
    chroma, light = levin(scan, seeds), levin(scan, seeds, values=luminance)[..., 0]
    return colorspaces.merge(light, chroma, "ycbcr")


def textured(scenes):
    """Print what a texture takes: the south of the house, with its photo three times at 12 megapixels."""
    pair = next(pair for pair in matching_pairs.GROUPS["simulated-25"](scenes) if pair.scan.name == "south")
    matching = match_photos(pair.scan, pair.photos, Settings())
    (found,), scan = matching.photos, pair.scan
    factor = np.sqrt(12e6 / (found.model.width * found.model.height))
    model = replace(
        found.model,
        focal_px=found.model.focal_px * factor,
        width=round(found.model.width * factor),
        height=round(found.model.height * factor),
    )
    large = cv2.resize(read_image(pair.photos[0]), (model.width, model.height), interpolation=cv2.INTER_CUBIC)
    shots = [Shot(PhotoImage(str(number), large), model) for number in range(3)]
    thirds = np.broadcast_to(np.arange(scan.shape[1]) * 3 // scan.shape[1], scan.shape)
    photo = np.where(matching.observed.seen, thirds, -1)
    result = colorize(scan, matching.seeds, Settings.preset("Natural"), matching.observed)
    tracemalloc.start()
    started, spent = time.perf_counter(), time.process_time()
    image = texture(scan, result.rgb, result.observed, photo, shots, 4096)
    seconds, processor = time.perf_counter() - started, time.process_time() - spent
    print(
        f"\ntexture of {image.shape[1]} x {image.shape[0]}: {seconds:.1f} s, {processor:.1f} s of processor, "
        f"{tracemalloc.get_traced_memory()[1] / 2**20:.0f} MB at most"
    )


if __name__ == "__main__":
    main()
