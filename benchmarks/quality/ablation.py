"""What each part of "Enhanced" gains, and what else was tried: python -m benchmarks.quality.ablation [SCAN ...]

Every variant differs from "Enhanced" in one respect. Printed is the mean over the scans and numbers of seeds of its
mean CIEDE2000 (with the true luminance) as a ratio to that of "Enhanced": above 1 is worse. Takes some ten minutes.
"""

import argparse
import statistics
import sys

import numpy as np

from reflcolor_addon.color import colorspaces, kriging
from reflcolor_addon.color.evaluation import evaluate
from reflcolor_addon.geodesic.blending import left_out
from reflcolor_addon.geodesic.engines import engine_for
from reflcolor_addon.geodesic.graph import PixelGraph
from reflcolor_addon.geodesic.smoothing import smooth
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.scan.normals import surface_normals
from reflcolor_addon.settings import Settings

from . import peers
from .scenes import CHOSEN_ON, COUNTS, NAMES, OTHERS, SIMULATED, load, perfect_seeds

_ENHANCED = Settings.preset("Enhanced")
# A step's constant is for a scan of this many pixels and shrinks with the side, so that crossing a scan costs the same.
_STEP_PIXELS = 270**2


class Case:
    """One scan with seeds, and the two estimates that "Enhanced" mixes, each in variants."""

    def __init__(self, scan, known, seeds):
        self.scan, self.known = scan, known
        self.pixels = np.ravel_multi_index((seeds.rows, seeds.cols), scan.shape)
        self.colors = colorspaces.chrominance(seeds.rgb, "ycbcr").astype(np.float32)
        self.seeds = seeds
        self.luminance, _ = normalize(scan.reflectance, scan.valid)
        self.range_image, _ = normalize(scan.range, scan.valid)
        self.smoothed = self.smooth(_ENHANCED.smoothing)

    def smooth(self, sigma):
        return smooth(self.luminance, self.scan.valid, sigma, wrap=self.scan.full_turn)

    def paths(self, *, luminance=None, beta=1.0, constant=0.0, alpha=_ENHANCED.alpha, nearest=_ENHANCED.nearest):
        """Return (H, W, 2) chrominance by eq. 1, where it reaches, and the residuals of left-out seeds."""
        graph = PixelGraph(
            luminance=self.smoothed if luminance is None else luminance,
            range_image=self.range_image,
            valid=self.scan.valid,
            beta=beta,
            wrap=self.scan.full_turn,
            step_cost=constant * float(np.sqrt(_STEP_PIXELS / self.scan.valid.sum())),
        )
        engine = engine_for(graph)
        count = min(nearest, self.pixels.size)
        mean, _, near = engine.nearest(self.pixels, self.colors, alpha, count, engine.control())
        self.reached = np.isfinite(mean.least)
        return np.moveaxis(mean.values, 0, -1), self.colors - left_out(*near, self.colors, alpha)

    def kriging(self, *, luminance=None, without=(), nuggets=kriging.NUGGETS, outliers=True):
        """Return (H, W, 2) chrominance by kriging, and the residuals of left-out seeds."""
        features = kriging.pixel_features(self.scan, self.smoothed if luminance is None else luminance)
        features[:, [i for part in without for i in range(*_FEATURES[part])]] = 0
        kept = kriging.NUGGETS, kriging._OUTLIER_GAIN
        kriging.NUGGETS, kriging._OUTLIER_GAIN = nuggets, kept[1] if outliers else 0.0
        try:
            model = kriging.Kriging(features[self.pixels], self.colors)
        finally:
            kriging.NUGGETS, kriging._OUTLIER_GAIN = kept
        estimate = np.concatenate([model.estimate(features[chunk]) for chunk in model.chunks(len(features))])
        return estimate.reshape(*self.scan.shape, 2), model.residuals

    def mix(self, paths, krige, *, share=None):
        """Return the chrominance mixed of both; by default with the share that the seeds tell."""
        if share is None:
            share = kriging.share(krige[1], paths[1], _ENHANCED.kriging)
        return (1 - share) * paths[0] + share * krige[0]

    def error(self, chroma):
        """Return the mean CIEDE2000 with the true luminance."""
        rgb = colorspaces.merge(self.luminance, chroma, "ycbcr")
        rgb[~self.reached] = np.rint(self.luminance[~self.reached])[:, None]
        return evaluate(rgb, self.scan.color, self.known)["color_alone"]["ciede2000_mean"]


_FEATURES = {"direction": (0, 3), "luminance": (3, 4), "log range": (4, 5), "normal": (5, 8)}


def variants(case):
    """Yield the name and the chrominance of every variant, "Enhanced" first."""
    paths, krige = case.paths(), case.kriging()
    both = case.mix(paths, krige)
    yield "Enhanced", both
    yield "paths alone (eq. 1)", paths[0]
    yield "kriging alone", krige[0]
    for share in (0.4, 0.6, 0.8):
        yield f"share of kriging fixed at {share}", case.mix(paths, krige, share=share)
    for sigma in (0.0, 2.0):
        smoothed = case.smooth(sigma)
        yield (
            f"smoothing {sigma:g} instead of 1 pixel",
            case.mix(case.paths(luminance=smoothed), case.kriging(luminance=smoothed)),
        )
    for name, smoothed in (("bilateral", _bilateral(case)), ("median of 5 x 5", _median(case))):
        yield f"{name} instead of Gaussian", case.mix(case.paths(luminance=smoothed), case.kriging(luminance=smoothed))
    for alpha in (2.0, 4.0, 6.0):
        yield f"alpha {alpha:g} instead of 3", case.mix(case.paths(alpha=alpha), krige)
    for nearest in (4, 16, 64):
        yield f"{nearest} nearest instead of 8", case.mix(case.paths(nearest=nearest), krige)
    for beta in (0.0, 0.1, 10.0):
        yield f"beta {beta:g} instead of 1", case.mix(case.paths(beta=beta), krige)
    for constant in (0.5, 2.0, 8.0):
        yield f"constant {constant:g} in every step", case.mix(case.paths(constant=constant), krige)
    for part in _FEATURES:
        yield f"kriging without {part}", case.mix(paths, case.kriging(without=(part,)))
    yield "kriging with one nugget, 0.04", case.mix(paths, case.kriging(nuggets=(0.04,)))
    yield "kriging without nuggets for outliers", case.mix(paths, case.kriging(outliers=False))
    yield (
        "reflectance corrected for incidence and range",
        case.mix(case.paths(luminance=_corrected(case)), case.kriging(luminance=_corrected(case))),
    )
    yield "guided filter on the result", _filtered(case, both)
    yield "a third of Levin's optimization", (2 * both + peers.levin(case.scan, case.seeds)) / 3


def _filled(case):
    return np.where(case.scan.valid, case.luminance, case.smooth(4.0)).astype(np.float32)


def _bilateral(case):
    import cv2

    return np.where(case.scan.valid, cv2.bilateralFilter(_filled(case), 0, 30, 2), 0)


def _median(case):
    import cv2

    return np.where(case.scan.valid, cv2.medianBlur(_filled(case), 5), 0)


def _corrected(case):
    """The smoothed luminance less what a linear fit explains by log range and by the cosine of incidence."""
    scan, valid = case.scan, case.scan.valid
    distance = np.maximum(scan.range, 1e-9)
    normals = surface_normals(scan.points, valid, wrap=scan.full_turn)
    cosine = -np.einsum("ijk,ijk->ij", normals, scan.points / distance[..., None])
    terms = np.stack([np.ones(scan.shape), np.log(distance), cosine], axis=-1)[valid]
    fit, *_ = np.linalg.lstsq(terms, case.smoothed[valid], rcond=None)
    rest = np.zeros(scan.shape)
    rest[valid] = case.smoothed[valid] - terms @ fit
    return normalize(rest, valid)[0]


def _filtered(case, chroma, radius=4, variance=1e-3):
    import cv2

    guide, weight, size = case.luminance.astype(np.float64) / 255, case.scan.valid.astype(float), (2 * radius + 1,) * 2
    total = np.maximum(cv2.blur(weight, size), 1e-9)

    def mean(image):
        return cv2.blur(image * weight, size) / total

    middle = mean(guide)
    result = np.empty_like(chroma)
    for channel in range(2):
        values = np.ascontiguousarray(chroma[..., channel], np.float64)
        slope = (mean(guide * values) - middle * mean(values)) / (mean(guide**2) - middle**2 + variance)
        result[..., channel] = mean(slope) * guide + mean(mean(values) - slope * middle)
    return result


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.quality.ablation", description=__doc__)
    parser.add_argument("scans", metavar="SCAN", nargs="*", help=f"by default all: {', '.join(NAMES)}")
    names = parser.parse_args().scans or NAMES
    errors = {}
    for name in names:
        for count in COUNTS:
            print(f"{name}, {count} seeds", file=sys.stderr, flush=True)
            scan, known = load(name)
            case = Case(scan, known, perfect_seeds(scan, known, count))
            for variant, chroma in variants(case):
                errors.setdefault(variant, {})[name, count] = case.error(chroma)
    groups = {"chosen on": CHOSEN_ON, "others": OTHERS, "simulated": tuple(SIMULATED)}
    print(f"| variant | {' | '.join(groups)} |\n|---|---|---|---|")
    for variant, found in errors.items():
        cells = []
        for group in groups.values():
            ratios = [error / errors["Enhanced"][place] for place, error in found.items() if place[0] in group]
            cells.append(f"{statistics.fmean(ratios):.3f}" if ratios else "")
        print(f"| {variant} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
