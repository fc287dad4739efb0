"""Every method on every scan."""

import time

import numpy as np

from reflcolor_addon import Settings, colorize
from reflcolor_addon.color.colorspaces import merge
from reflcolor_addon.color.evaluation import error_map, evaluate
from reflcolor_addon.scan.normalization import normalize

from . import peers
from .scenes import load, perfect_seeds

PEERS = {
    "gray": peers.gray,
    "mean color": peers.mean_color,
    "nearest in image": peers.nearest_in_image,
    "guided filter": peers.guided_filter,
    "Levin": peers.levin,
}
OURS = {"Yatziv": Settings(beta=0.0), "Paper": Settings.preset("Paper"), "Enhanced": Settings.preset("Enhanced")}
METHODS = ("gray", "mean color", "nearest in image", "guided filter", "Yatziv", "Paper", "Levin", "Enhanced")


def measure(name, count):
    """Return the figures of all methods on one scan with about so many seeds.

    Returns
    -------
    dict
        ``scan``, ``seeds``, ``count`` and ``figures``: by method, what ``evaluate`` returns and, for those of this
        project, ``seconds`` and ``confidence`` (rank correlation of confidence and error; mean error of the more
        confident half and of the other).
    """
    scan, known = load(name)
    seeds = perfect_seeds(scan, known, count)
    luminance, _ = normalize(scan.reflectance, scan.valid)
    figures = {}
    for method, function in PEERS.items():
        rgb = merge(luminance, function(scan, seeds), "ycbcr")
        figures[method] = evaluate(rgb, scan.color, known)
    for method, settings in OURS.items():
        result, seconds = _timed(scan, seeds, settings)
        figures[method] = evaluate(result.rgb, scan.color, known) | {
            "seconds": seconds,
            "confidence": _confidence(result, scan, known),
        }
    return {"scan": name, "seeds": len(seeds), "count": count, "figures": figures}


def _timed(scan, seeds, settings):
    """Return the colorization and the seconds it takes: the least of up to five runs, for other work disturbs."""
    seconds = []
    while not seconds or (len(seconds) < 5 and sum(seconds) < 3):
        start = time.perf_counter()
        result = colorize(scan, seeds, settings)
        seconds.append(time.perf_counter() - start)
    return result, min(seconds)


def _confidence(result, scan, known):
    from scipy.stats import spearmanr

    errors, confidence = error_map(result.rgb, scan.color, known)[known], result.confidence[known]
    order = np.argsort(-confidence, kind="stable")
    half = order.size // 2
    return {
        "rank_correlation": float(spearmanr(confidence, errors)[0]),
        "upper_half": float(errors[order[:half]].mean()),
        "lower_half": float(errors[order[half:]].mean()),
    }
