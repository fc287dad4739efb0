"""Whether the reflectance helps to enlarge the colors: python -m benchmarks.quality.super_resolution [SCAN ...]

The true chrominance is averaged over blocks of 2 x 2 or 4 x 4 pixels and enlarged again, by bicubic interpolation and
by two methods that see the reflectance at full resolution. Printed is the mean CIEDE2000 (with the true luminance) and
the chrominance PSNR in dB over the pixels held back.
"""

import sys

import numpy as np

from benchmarks import real_scans
from reflcolor_addon.color import colorspaces
from reflcolor_addon.color.evaluation import evaluate
from reflcolor_addon.scan.normalization import normalize

from .scenes import load

FACTORS = (2, 4)
# Half a window in coarse pixels, and the variance of Y (0..1) that counts as an edge; of the bilateral weights, the
# standard deviations in coarse pixels and in Y.
_RADIUS, _VARIANCE = 1, 1e-3
_SPATIAL, _LUMINANCE = 0.7, 0.1


def bicubic(coarse, guide):
    """Enlarge (h, w, 2) to the guide's size."""
    import cv2

    return cv2.resize(coarse, guide.shape[::-1], interpolation=cv2.INTER_CUBIC)


def guided(coarse, guide):
    """A linear model of the guide in every window of the coarse image, enlarged (He and Sun 2015)."""
    import cv2

    size = (2 * _RADIUS + 1,) * 2
    small = cv2.resize(guide, coarse.shape[1::-1], interpolation=cv2.INTER_AREA)
    middle = cv2.blur(small, size)
    variance = cv2.blur(small**2, size) - middle**2
    result = []
    for channel in range(2):
        values = np.ascontiguousarray(coarse[..., channel])
        mean = cv2.blur(values, size)
        slope = (cv2.blur(small * values, size) - middle * mean) / (variance + _VARIANCE)
        detail = guide - bicubic(small, guide)
        result.append(bicubic(values, guide) + bicubic(cv2.blur(slope, size), guide) * detail)
    return np.stack(result, axis=-1)


def joint_bilateral(coarse, guide):
    """The mean of 5 x 5 coarse pixels, weighted by distance and by likeness of the guide (Kopf et al. 2007)."""
    import cv2

    height, width = guide.shape
    tall, wide = coarse.shape[:2]
    rows, cols = (np.arange(height) + 0.5) * tall / height - 0.5, (np.arange(width) + 0.5) * wide / width - 0.5
    small = cv2.resize(guide, (wide, tall), interpolation=cv2.INTER_AREA)
    total, result = np.zeros(guide.shape), np.zeros((*guide.shape, 2))
    for down in range(-2, 3):
        for right in range(-2, 3):
            r, c = np.rint(rows).astype(int) + down, np.rint(cols).astype(int) + right
            away = ((r - rows) ** 2)[:, None] + ((c - cols) ** 2)[None]
            at = np.ix_(np.clip(r, 0, tall - 1), np.clip(c, 0, wide - 1))
            likeness = ((small[at] - guide) / _LUMINANCE) ** 2
            weight = np.exp(-away / (2 * _SPATIAL**2) - likeness / 2)
            total += weight
            result += weight[..., None] * coarse[at]
    return result / np.maximum(total, 1e-300)[..., None]


METHODS = {"bicubic": bicubic, "guided by reflectance": guided, "joint bilateral": joint_bilateral}


def main():
    import cv2

    print(f"| scan | factor | {' | '.join(METHODS)} |\n|---|---|{'---|' * len(METHODS)}")
    for name in sys.argv[1:] or real_scans.NAMES:
        scan, known = load(name)
        guide = (normalize(scan.reflectance, scan.valid)[0] / 255).astype(np.float32)
        truth = colorspaces.chrominance(scan.color, "ycbcr").astype(np.float32)
        for factor in FACTORS:
            size = scan.shape[1] // factor, scan.shape[0] // factor
            share = cv2.resize(known.astype(np.float32), size, interpolation=cv2.INTER_AREA)
            coarse = cv2.resize(truth * known[..., None], size, interpolation=cv2.INTER_AREA)
            coarse /= np.maximum(share, 1e-6)[..., None]
            cells = []
            for method in METHODS.values():
                chroma = method(coarse, guide)
                luma = scan.color @ np.array([0.299, 0.587, 0.114])
                figures = evaluate(colorspaces.merge(luma, chroma, "ycbcr"), scan.color, known)["color_alone"]
                cells.append(f"{figures['ciede2000_mean']:.2f} / {figures['chrominance_psnr_db']:.1f}")
            print(f"| {name} | {factor} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
