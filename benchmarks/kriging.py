"""Kriging by the kernel beside NumPy in double precision: python -m benchmarks.kriging

Seconds of the processor, medians of runs that take turns; what differs is in 8-bit levels of red, green or blue.
"""

import argparse
from functools import partial

import numpy as np

from benchmarks import geodesic_cases as cases
from benchmarks import real_scans
from benchmarks.geodesic_tables import head, medians, row
from reflcolor_addon.color import colorspaces, kriging
from reflcolor_addon.geodesic import kernel
from reflcolor_addon.scan.normalization import normalize

# NumPy is asked for so many of the pixels, which takes long enough, and so many covariances at once.
_SAMPLE, _CHUNK_VALUES = 20_000, 1 << 21


def model_of(scan, count):
    """(N, 8) features of the pixels with a return, a Kriging of about so many seeds, and how many they are."""
    features = kriging.pixel_features(scan, normalize(scan.reflectance, scan.valid)[0])
    pixels = cases.spread_seeds(scan.valid, count)
    colors = colorspaces.chrominance(scan.color.reshape(-1, 3)[pixels], "ycbcr")
    return features[scan.valid.ravel()], kriging.Kriging(features[pixels], colors), len(pixels)


def in_double(model, features):
    """What the formula gives in double precision, as the fallback without a kernel takes it."""
    step = _CHUNK_VALUES // len(model._features)
    chunks = [np.asarray(features[start : start + step], np.float64) for start in range(0, len(features), step)]
    covariances = (kriging._covariance(chunk, model._features) for chunk in chunks)
    return np.concatenate([np.einsum("ns,sc->nc", each, model._weights) for each in covariances]) + model._mean


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.kriging", description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=5, help="runs per figure (5)")
    options = parser.parse_args()
    if not kernel.available():
        raise SystemExit(kernel.reason())
    levels = colorspaces.levels_per_unit("ycbcr")
    head(
        "Kriging, one thread: nanoseconds per pixel and seed, and what differs",
        *("scan", "seeds", "NumPy", "kernel", "ratio", "kernel, all pixels, s", "mean", "greatest"),
    )
    for name, count in (("pumpA", 450), ("bildstein_25", 1200), ("doria", 500), ("doria", 2000), ("doria", 8000)):
        scan = cases.whole_scan(name, 1) if name == "doria" else real_scans.load(name, cases.DATA)
        features, model, seeds = model_of(scan, count)
        sample = features[np.random.default_rng(0).permutation(len(features))[:_SAMPLE]]
        functions = {
            "numpy": partial(in_double, model, sample),
            "kernel": partial(model.estimate, sample),
        }
        found = medians(functions, options.rounds)
        each = {key: 1e9 * seconds / (len(sample) * seeds) for key, seconds in found.items()}
        differs = levels * np.abs(functions["numpy"]() - functions["kernel"]())
        whole = found["kernel"] / len(sample) * len(features)
        shown = f"{each['numpy']:.2f}", f"{each['kernel']:.2f}", f"{each['kernel'] / each['numpy']:.2f}", f"{whole:.1f}"
        row(name, seeds, *shown, f"{differs.mean():.1e}", f"{differs.max():.1e}")


if __name__ == "__main__":
    main()
