"""What each part of "Natural" gains, and what else was tried: python -m benchmarks.quality.ablation [SCAN ...]

Every variant differs from "Natural" in one respect. Printed is the mean over the scans and numbers of seeds of its mean
CIEDE2000 as a ratio to that of "Natural", as the colors come / with the true luminance: above 1 is worse. The last
column is of the simulated scan with the seeds that a person picked, with their true colors. Takes some fifteen minutes.
"""

import argparse
import statistics
import sys
from dataclasses import replace

import numpy as np

from reflcolor_addon.color import colorspaces, kriging, mixing
from reflcolor_addon.color.evaluation import evaluate
from reflcolor_addon.color.luminance import CHROMINANCE, channels_of, lightness, seed_values
from reflcolor_addon.geodesic.blending import leave_one_out
from reflcolor_addon.geodesic.engines import engine_for
from reflcolor_addon.geodesic.graph import PixelGraph
from reflcolor_addon.geodesic.smoothing import smooth
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.scan.normals import surface_normals
from reflcolor_addon.seeds.seeds import Seeds
from reflcolor_addon.settings import Settings

from . import peers
from .scenes import CHOSEN_ON, COUNTS, NAMES, OTHERS, PAIRS, ROOT, SIMULATED, load, perfect_seeds

_NATURAL = Settings.preset("Natural")
_PARTS = channels_of(_NATURAL)
# A step's constant is for a scan of this many pixels and shrinks with the side, so that crossing a scan costs the same.
_STEP_PIXELS = 270**2
# What is measured instead of a number of seeds.
_BY_HAND = "seeds by hand"
# Of a detail's slope that the seeds tell: what draws it to 0, in seeds.
_SLOPE_SEEDS = 10


class Case:
    """One scan with seeds, and the two estimates that "Natural" mixes, each in variants."""

    def __init__(self, scan, known, seeds):
        self.scan, self.known = scan, known
        self.pixels = np.ravel_multi_index((seeds.rows, seeds.cols), scan.shape)
        self.colors = seed_values(seeds.rgb, _NATURAL)
        self.seeds = seeds
        self.luminance, _ = normalize(scan.reflectance, scan.valid)
        self.range_image, _ = normalize(scan.range, scan.valid)
        self.smoothed = self.smooth(_NATURAL.smoothing)

    def smooth(self, sigma):
        return smooth(self.luminance, self.scan.valid, sigma, wrap=self.scan.full_turn)

    def paths(
        self,
        *,
        luminance=None,
        beta=1.0,
        constant=0.0,
        alpha=_NATURAL.alpha,
        nearest=_NATURAL.nearest,
        colors=None,
        unsmoothed=mixing.unsmoothed_share,
    ):
        """Return (H, W, C) values by eq. 1, where it reaches, and the residuals of left-out seeds.

        ``unsmoothed`` gives the share of paths over the reflectance as it is.
        """
        colors = self.colors if colors is None else colors

        def found_over(luminance, nearest):
            graph = PixelGraph(
                luminance=luminance,
                range_image=self.range_image,
                valid=self.scan.valid,
                beta=beta,
                wrap=self.scan.full_turn,
                step_cost=constant * float(np.sqrt(_STEP_PIXELS / self.scan.valid.sum())),
            )
            engine = engine_for(graph)
            return engine.nearest(self.pixels, min(nearest, self.pixels.size), engine.control())

        found = found_over(self.smoothed if luminance is None else luminance, nearest)
        mean, _ = found.blend(colors, alpha)
        near = found.at(self.pixels)
        self.least, self.reached, self.apart = mean.least, np.isfinite(mean.least), mixing.nearest_other(*near)
        if picked := self.picked():
            alpha *= mixing.PICKED_GAIN**picked
            mean, _ = found.blend(colors, alpha)
            chroma = mean.values[CHROMINANCE]
            own, rest = colors[:, CHROMINANCE], (colors - leave_one_out(*near, colors, alpha))[:, CHROMINANCE]
            other_found = found_over(self.luminance, nearest)
            other, _ = other_found.blend(own, alpha)
            other_rest = own - leave_one_out(*other_found.at(self.pixels), own, alpha)
            chroma += unsmoothed(mean.weight, picked, rest, other_rest) * (other.values - chroma)
        return np.moveaxis(mean.values, 0, -1), colors - leave_one_out(*near, colors, alpha)

    def picked(self):
        """How much the seeds pass for picked by a person, with the paths taken last."""
        points = self.scan.points.reshape(-1, 3)[self.pixels]
        directions = points / np.linalg.norm(points, axis=1, keepdims=True)
        return mixing.picked_by_a_person(directions, self.apart, self.least[self.scan.valid])

    def kriging(self, *, luminance=None, without=(), nuggets=kriging.NUGGETS, outliers=True, colors=None):
        """Return (H, W, C) values by kriging, and the residuals of left-out seeds."""
        colors = self.colors if colors is None else colors
        features = kriging.pixel_features(self.scan, self.smoothed if luminance is None else luminance)
        features[:, [i for part in without for i in range(*_FEATURES[part])]] = 0
        kept = kriging.NUGGETS, kriging._OUTLIER_GAIN
        kriging.NUGGETS, kriging._OUTLIER_GAIN = nuggets, kept[1] if outliers else 0.0
        try:
            model = kriging.Kriging(features[self.pixels], colors, _PARTS[: colors.shape[1] - 1])
        finally:
            kriging.NUGGETS, kriging._OUTLIER_GAIN = kept
        estimate = np.concatenate([model.estimate(features[chunk]) for chunk in model.chunks(len(features))])
        return estimate.reshape(*self.scan.shape, -1), model.residuals

    def mix(self, paths, krige, *, share=None, told_apart=True):
        """Return the values mixed of both, and the residuals; by default with the share that the seeds tell.

        ``share`` is one for all pixels; without ``told_apart`` luminance and chrominance get the same share.
        """
        mixed, rest = np.empty_like(paths[0]), np.empty_like(paths[1])
        picked = self.picked()
        for part in _PARTS:
            asked = part if told_apart else slice(None)
            if share is not None:
                of_pixels, of_seeds = share, share
            else:
                rule = mixing.mixture(krige[1][:, asked], paths[1][:, asked], self.apart, _NATURAL.kriging, picked)
                of_pixels, of_seeds = rule.share(self.least)[..., None], rule.share(self.apart)[:, None]
            mixed[..., part] = (1 - of_pixels) * paths[0][..., part] + of_pixels * krige[0][..., part]
            rest[:, part] = (1 - of_seeds) * paths[1][:, part] + of_seeds * krige[1][:, part]
        return mixed, rest

    def errors(self, values, light=None):
        """Return the mean CIEDE2000 as the colors come, and with the true luminance."""
        if light is None:
            light = lightness(self.luminance, values, self.reached, _NATURAL)
        rgb = colorspaces.merge(light, values[..., :2], "ycbcr")
        rgb[~self.reached] = np.rint(self.luminance[~self.reached])[:, None]
        found = evaluate(rgb, self.scan.color, self.known)
        return tuple(found[part]["ciede2000_mean"] for part in ("as_is", "color_alone"))


_FEATURES = {"direction": (0, 3), "luminance": (3, 4), "log range": (4, 5), "normal": (5, 8)}


def variants(case):
    """Yield the name and the errors of every variant, "Natural" first."""
    paths, krige = case.paths(), case.kriging()
    least, apart = case.least, case.apart
    both, rest = case.mix(paths, krige)
    yield "Natural", case.errors(both)
    yield "luminance of the reflectance (Enhanced)", case.errors(both, case.luminance)
    yield "half of either luminance", case.errors(both, (case.luminance + _light(case, both)) / 2)
    yield "luminance by one gain and offset of the reflectance", case.errors(both, _fitted(case))
    yield "luminance blended as it is, not its root", case.errors(*_other_scale(case, both, lambda y: y, lambda y: y))
    yield (
        "luminance blended as its logarithm",
        case.errors(*_other_scale(case, both, lambda y: 80 * np.log(y + 32), lambda z: np.exp(z / 80) - 32)),
    )
    for name, local in (("one slope", False), ("a slope for each place", True)):
        yield f"detail of the reflectance added, {name}", case.errors(_with_detail(case, both, rest, local=local))
    yield "one share for chrominance and luminance", case.errors(case.mix(paths, krige, told_apart=False)[0])
    yield "paths alone (eq. 1)", case.errors(paths[0])
    yield "kriging alone", case.errors(krige[0])
    for share in (0.4, 0.6, 0.8):
        yield f"share of kriging {share} at every pixel", case.errors(case.mix(paths, krige, share=share)[0])
    for name, share in (
        ("paths over the smoothed reflectance alone", lambda weight, picked, *_: np.float32(0)),
        ("paths over the reflectance as it is alone", lambda weight, picked, *_: np.float32(picked)),
        ("half of each kind of path", lambda weight, picked, *_: np.float32(picked / 2)),
    ):
        yield (
            f"seeds picked by hand: {name}",
            case.errors(case.mix(case.paths(unsmoothed=share), krige)[0]),
        )
    for sigma in (0.0, 2.0):
        smoothed = case.smooth(sigma)
        changed = case.mix(case.paths(luminance=smoothed), case.kriging(luminance=smoothed))
        yield f"smoothing {sigma:g} instead of 1 pixel", case.errors(changed[0])
    for alpha in (2.0, 4.0, 6.0):
        yield f"alpha {alpha:g} instead of 3", case.errors(case.mix(case.paths(alpha=alpha), krige)[0])
    for nearest in (4, 16):
        yield f"{nearest} nearest instead of 8", case.errors(case.mix(case.paths(nearest=nearest), krige)[0])
    for beta in (0.0, 10.0):
        yield f"beta {beta:g} instead of 1", case.errors(case.mix(case.paths(beta=beta), krige)[0])
    yield "constant 2 in every step", case.errors(case.mix(case.paths(constant=2.0), krige)[0])
    case.least, case.apart = least, apart
    for part in _FEATURES:
        yield f"kriging without {part}", case.errors(case.mix(paths, case.kriging(without=(part,)))[0])
    yield "kriging with one nugget, 0.04", case.errors(case.mix(paths, case.kriging(nuggets=(0.04,)))[0])
    yield "kriging without nuggets for outliers", case.errors(case.mix(paths, case.kriging(outliers=False))[0])
    corrected = _corrected(case)
    changed = case.mix(case.paths(luminance=corrected), case.kriging(luminance=corrected))
    yield "reflectance corrected for incidence and range", case.errors(changed[0])
    yield (
        "a third of Levin's optimization",
        case.errors((2 * both + peers.levin(case.scan, case.seeds, values=case.colors)) / 3),
    )


def _light(case, values):
    return lightness(case.luminance, values, case.reached, _NATURAL)


def _fitted(case):
    """The reflectance, made as light as the seeds by least squares."""
    wanted = peers.whole_colors(case.seeds)[:, 0]
    own = case.luminance.ravel()[case.pixels]
    fit, *_ = np.linalg.lstsq(np.column_stack([np.ones(len(own)), own]), wanted, rcond=None)
    return np.clip(fit[0] + fit[1] * case.luminance, 0, 255)


def _other_scale(case, values, scale, back):
    """The same values, and a luminance that was blended on another scale."""
    colors = np.column_stack([case.colors[:, :2], scale(peers.whole_colors(case.seeds)[:, 0])]).astype(np.float32)
    mixed, _ = case.mix(case.paths(colors=colors), case.kriging(colors=colors))
    return values, np.clip(back(mixed[..., 2]), 0, 255)


def _with_detail(case, values, rest, *, local):
    """The luminance plus the reflectance's detail, with the slope that left-out seeds tell.

    Detail is what the reflectance has beyond its own estimate from the seeds. A local slope is that of the seeds that
    are alike, and 0 where it did not help them.
    """
    own = np.column_stack([case.colors[:, :2], case.luminance.ravel()[case.pixels]]).astype(np.float32)
    smooth_part, own_rest = case.mix(case.paths(colors=own), case.kriging(colors=own))
    detail, off, by = case.luminance - smooth_part[..., 2], rest[:, 2], own_rest[:, 2]
    drawn = _SLOPE_SEEDS * np.mean(by**2)
    if not local:
        slope = (off @ by) / (by @ by + drawn)
    else:
        features = kriging.pixel_features(case.scan, case.smoothed)
        alike = kriging._covariance(features[case.pixels].astype(float), features[case.pixels].astype(float))
        np.fill_diagonal(alike, 0)
        told = (alike @ (off * by)) / (alike @ by**2 + drawn)
        helped = np.abs(off) - np.abs(off - told * by)
        slope = np.empty(len(features))
        for start in range(0, len(features), 1 << 14):
            weights = kriging._covariance(features[start : start + (1 << 14)].astype(float), features[case.pixels])
            found = (weights @ (off * by)) / (weights @ by**2 + drawn)
            slope[start : start + (1 << 14)] = np.where(weights @ helped > 0, found, 0)
        slope = slope.reshape(case.scan.shape)
    changed = values.copy()
    changed[..., 2] += slope * detail
    return changed


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


def _picked(name, scan):
    """The seeds that a person picked on a simulated scan, with their true colors."""
    folder = ROOT / SIMULATED[name]
    seeds = Seeds.load(folder / f"{name}.seeds.json", [folder / "photo.jpg"])
    return replace(seeds, rgb=scan.color[seeds.rows, seeds.cols])


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.quality.ablation", description=__doc__)
    parser.add_argument("scans", metavar="SCAN", nargs="*", help=f"by default all: {', '.join(NAMES)}")
    names = parser.parse_args().scans or NAMES
    errors = {}
    for name in names:
        for count in (*COUNTS, _BY_HAND) if name in SIMULATED else COUNTS:
            print(f"{name}, {count} seeds", file=sys.stderr, flush=True)
            scan, known = load(name)
            seeds = perfect_seeds(scan, known, count) if count in COUNTS else _picked(name, scan)
            for variant, found in variants(Case(scan, known, seeds)):
                errors.setdefault(variant, {})[name, count] = found
    groups = {"chosen on": CHOSEN_ON, "others": OTHERS, "spinning lidars": PAIRS, "simulated": tuple(SIMULATED)}
    groups = {title: [(name, count) for name in group for count in COUNTS] for title, group in groups.items()}
    groups[_BY_HAND] = [(name, _BY_HAND) for name in SIMULATED]
    print(f"| variant | {' | '.join(groups)} |\n|---|" + "---|" * len(groups))
    for variant, found in errors.items():
        cells = []
        for group in groups.values():
            places = [place for place in group if place in found]
            ratios = ([found[place][part] / errors["Natural"][place][part] for place in places] for part in (0, 1))
            cells.append(" / ".join(f"{statistics.fmean(part):.3f}" for part in ratios) if places else "")
        print(f"| {variant} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
