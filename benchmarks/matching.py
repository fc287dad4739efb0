"""How well seeds are found in photos, as published and verified: python -m benchmarks.matching

For every pair of a scan and a photo: the mean CIEDE2000 of color alone, painted in the photo's mean color, colorized
from the seeds found, and from perfect seeds at the same places; and the gap closed, which is what of the way from the
first to the last was gone. 1 is as good as perfect seeds, 0 as the mean color, below 0 is worse than that. A photo's
own exposure and white balance cannot be known, so "in light" is the same after three gains that bring its colors, of
seeds and of mean alike, nearest to the true ones: what is left is from wrong places. Evidence is what speaks for the
best camera, as a share of what is needed to be verified. Seconds are of processor time.
"unrelated" tries every real scan with every photo of something else, and simulated ones: none may be verified. "cost"
is time and memory for a scan of 760 x 1135 and a photo of 12 megapixels.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks import geodesic_tables, matching_cost, matching_pairs
from reflcolor_addon import Seeds, Settings, colorize, evaluate
from reflcolor_addon.files.images import read_image
from reflcolor_addon.matching import match_photos, match_site
from reflcolor_addon.srgb import linear_to_srgb8, srgb8_to_linear

MODES = ("paper", "verified")
SCENES = Path("build/scenes")


def main():
    """Print the table."""
    groups = (*matching_pairs.GROUPS, "site", "unrelated", "cost")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(groups)}; without any, all")
    parser.add_argument("--scenes", type=Path, default=SCENES, help="simulated scenes, made there where missing")
    parser.add_argument("--mode", choices=MODES, action="append", help="only this one; else both")
    arguments = parser.parse_args()
    if unknown := set(arguments.groups) - set(groups):
        parser.error(f"no group is called {sorted(unknown)[0]}; there are {', '.join(groups)}")
    modes = arguments.mode or MODES
    print(
        f"{'scan':12} {'photo':22} {'mode':9}   mean  result  perfect     gap in light evidence seconds  note",
        flush=True,
    )
    for group in arguments.groups or groups:
        if group == "unrelated":
            unrelated(arguments.scenes)
        elif group == "cost":
            cost()
        elif group == "site":
            site(arguments.scenes, modes)
        else:
            of_group(group, arguments.scenes, modes)


def of_group(group, scenes, modes):
    """Print the pairs of one group, and the mean gap."""
    gaps = {mode: [] for mode in modes}
    for pair in matching_pairs.GROUPS[group](scenes):
        for mode in modes:
            started = time.process_time()
            matching = match_photos(pair.scan, pair.photos, Settings(matching=mode), hand=pair.hand)
            gaps[mode].append(printed(pair, mode, matching, time.process_time() - started))
    for mode, values in gaps.items():
        summary(group, mode, values)


def site(scenes, modes):
    """Print four scans of a house, matched together from one photo and from three."""
    for label, pairs in matching_pairs.site(scenes):
        for mode in modes:
            started = time.process_time()
            found = match_site([pair.scan for pair in pairs], pairs[0].photos, Settings(matching=mode))
            seconds = (time.process_time() - started) / len(pairs)
            gaps = [printed(pair, mode, matching, seconds) for pair, matching in zip(pairs, found, strict=True)]
            summary(f"site, {label}", mode, gaps)


def summary(group, mode, values):
    mean, least = np.mean(values, axis=0), np.min(values, axis=0)
    figures = f"mean {mean[0]:.3f}, least {least[0]:.3f}; in light {mean[1]:.3f}, {least[1]:.3f}"
    print(f"{group}: {mode}: {figures}, of {len(values)}", flush=True)


def printed(pair, mode, matching, seconds):
    """Print one line and return the gap closed, as it is and in light."""
    seeds, truth = matching.seeds, pair.truth
    perfect = Seeds(rows=seeds.rows, cols=seeds.cols, rgb=truth[seeds.rows, seeds.cols])
    images = [photo if isinstance(photo, np.ndarray) else read_image(photo) for photo in pair.photos]
    mean = np.mean([image.reshape(-1, 3).mean(axis=0) for image in images], axis=0)[None]
    light = gains(seeds.rgb, perfect.rgb)
    settings = Settings(nearest=8)

    def error(rgb):
        return evaluate(rgb, truth, pair.known)["color_alone"]["ciede2000_mean"]

    best = error(colorize(pair.scan, perfect, settings).rgb)
    errors, gaps = [], []
    for factors in (np.ones(3), light):
        painted = np.broadcast_to(lit(np.rint(mean).astype(np.uint8), factors), truth.shape)
        result = colorize(pair.scan, replace(seeds, rgb=lit(seeds.rgb, factors)), settings).rgb
        errors.append((error(painted), error(result)))
        gaps.append((errors[-1][0] - errors[-1][1]) / (errors[-1][0] - best))
    notes = "; ".join(report.note for report in matching.photos)
    figures = f"{errors[0][0]:6.2f} {errors[0][1]:7.2f} {best:8.2f} {gaps[0]:7.3f} {gaps[1]:8.3f}"
    spent = f"{max(report.evidence for report in matching.photos):8.2f} {seconds:7.1f}"
    print(f"{pair.scan.name:12} {pair.label:22} {mode:9} {figures} {spent}  {notes}", flush=True)
    return gaps


def gains(rgb, truth):
    """(3,) factors of linear light that bring colors nearest to the true ones."""
    sound = ((rgb >= 12) & (rgb <= 245) & (truth >= 12) & (truth <= 245)).all(axis=1)
    if not sound.any():
        return np.ones(3)
    return np.exp(np.median(np.log(srgb8_to_linear(truth[sound]) / srgb8_to_linear(rgb[sound])), axis=0))


def lit(rgb, factors):
    """The colors (N, 3) uint8 in light of other strength."""
    return linear_to_srgb8(np.clip(srgb8_to_linear(rgb) * factors, 0, 1))


def unrelated(scenes):
    """Print what speaks for every scan with every photo of something else."""
    accepted, evidence = 0, []
    for scan, other, photo in matching_pairs.unrelated(scenes):
        (report,) = match_photos(scan, [photo], Settings()).photos
        evidence.append(report.evidence)
        accepted += report.verified
        verdict = "ACCEPTED" if report.verified else "refused"
        print(f"{scan.name:12} {other:20} {verdict:9} {report.evidence:8.2f}  {report.note}", flush=True)
    print(f"unrelated: {accepted} of {len(evidence)} pairs accepted; most evidence {max(evidence):.2f}", flush=True)


def cost():
    """Print time and memory for a large scan and a large photo, verified and beside that as published."""
    head = "scan, photo", "seconds", "processor", "as published", "ratio", "MB", "longest silence", "note"
    geodesic_tables.head("760 x 1135 and 12 megapixels, medians of three runs", *head)
    for case in matching_cost.CASES:
        found = {
            mode: [geodesic_tables.apart(*case, mode, module="benchmarks.matching_cost") for _ in range(3)]
            for mode in MODES
        }
        middle = {
            mode: {key: np.median([run[key] for run in runs]) for key in ("seconds", "processor", "bytes", "silence")}
            for mode, runs in found.items()
        }
        own, published = middle["verified"], middle["paper"]
        geodesic_tables.row(
            ", ".join(case),
            f"{own['seconds']:.1f}",
            f"{own['processor']:.1f}",
            f"{published['seconds']:.1f}",
            f"{own['seconds'] / published['seconds']:.1f}",
            f"{own['bytes'] / 1e6:.0f}",
            f"{own['silence']:.1f}",
            found["verified"][0]["note"],
        )


if __name__ == "__main__":
    main()
