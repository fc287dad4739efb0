"""Every method on every scan."""

import json
import time

import numpy as np

from reflcolor_addon import Settings, colorize
from reflcolor_addon.color.colorspaces import merge
from reflcolor_addon.color.evaluation import error_map, evaluate, with_luminance_of
from reflcolor_addon.scan.normalization import normalize

from . import peers
from .scenes import load, perfect_seeds

# Those that give whole colors, then those whose luminance is the reflectance's.
WHOLE = {"constant": peers.constant, "linear": peers.linear, "Levin, three channels": peers.levin_whole}
PEERS = {
    "gray": peers.gray,
    "mean color": peers.mean_color,
    "nearest in image": peers.nearest_in_image,
    "guided filter": peers.guided_filter,
}
LEVIN = "Levin"
OURS = {
    "Yatziv": Settings(beta=0.0),
    "Paper": Settings.preset("Paper"),
    "Enhanced": Settings.preset("Enhanced"),
    "Natural": Settings.preset("Natural"),
}
# What a table of colors as they come shows, and one of color alone.
AS_IS = ("gray", "Paper", "Enhanced", *WHOLE, "Natural")
ALONE = (*PEERS, "Yatziv", "Paper", LEVIN, "Enhanced", "Natural")
CALIBRATION = 10
TIMED, _ROUNDS = ("Enhanced", "Natural"), 2


def measure(name, count, kept=None):
    """Return the figures of all methods on one scan with about so many seeds.

    Parameters
    ----------
    name : str
    count : int
    kept : Path, optional
        Folder that figures are kept in; what is there is not measured again.

    Returns
    -------
    dict
        ``scan``, ``seeds``, ``count`` and ``figures``: by method, what ``evaluate`` returns and, for those of this
        project, ``seconds`` and ``confidence`` (see `reliability`).
    """
    path = kept and kept / f"{name}-{count}.json"
    if path and path.exists():
        return json.loads(path.read_text(encoding="utf-8"))
    found = _measured(name, count)
    if path:
        kept.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(found), encoding="utf-8")
    return found


def _measured(name, count):
    scan, known = load(name)
    seeds = perfect_seeds(scan, known, count)
    luminance, _ = normalize(scan.reflectance, scan.valid)
    figures = {}
    for method, function in WHOLE.items():
        values = function(scan, seeds)
        figures[method] = evaluate(merge(values[..., 0], values[..., 1:], "ycbcr"), scan.color, known)
        if function is peers.levin_whole:
            # Each channel is solved by itself.
            figures[LEVIN] = evaluate(merge(luminance, values[..., 1:], "ycbcr"), scan.color, known)
    for method, function in PEERS.items():
        figures[method] = evaluate(merge(luminance, function(scan, seeds), "ycbcr"), scan.color, known)
    results = {method: colorize(scan, seeds, settings) for method, settings in OURS.items()}
    seconds = _timed(scan, seeds)
    for method, settings in OURS.items():
        result = results[method]
        figures[method] = evaluate(result.rgb, scan.color, known) | {"seconds": seconds.get(method)}
        shown = result.rgb if settings.light else with_luminance_of(result.rgb, scan.color)
        figures[method]["confidence"] = reliability(result.confidence, shown, scan, known)
    return {"scan": name, "seeds": len(seeds), "count": count, "figures": figures}


def _timed(scan, seeds):
    """Return the processor time by preset, of all threads: the least of some runs by turns."""
    seconds = {method: [] for method in TIMED}
    for _ in range(_ROUNDS):
        for method, taken in seconds.items():
            start = time.process_time()
            colorize(scan, seeds, OURS[method])
            taken.append(time.process_time() - start)
    return {method: min(taken) for method, taken in seconds.items()}


def reliability(confidence, rgb, scan, known):
    """Rank correlation of confidence and error, the mean error of the more confident half and of the other, and the
    mean error where the confidence is 0 to 0.1, 0.1 to 0.2 and so on, None where it nowhere is."""
    from scipy.stats import spearmanr

    errors, confidence = error_map(rgb, scan.color, known)[known], confidence[known]
    order = np.argsort(-confidence, kind="stable")
    half = order.size // 2
    tenth = np.minimum((confidence * CALIBRATION).astype(int), CALIBRATION - 1)
    return {
        "rank_correlation": float(spearmanr(confidence, errors)[0]),
        "upper_half": float(errors[order[:half]].mean()),
        "lower_half": float(errors[order[half:]].mean()),
        "by_tenth": [float(errors[tenth == i].mean()) if (tenth == i).any() else None for i in range(CALIBRATION)],
        "pixels_by_tenth": np.bincount(tenth, minlength=CALIBRATION).tolist(),
    }
