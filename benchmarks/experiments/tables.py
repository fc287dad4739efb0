"""The figures of the experiments as tables of Markdown."""

import numpy as np

from reflcolor_addon import colorize, evaluate
from reflcolor_addon.color.evaluation import error_map, with_luminance_of

# A step in range of this share is a jump edge; what lies within so many pixels of one is near it.
_JUMP_SHARE, _NEAR_PX = 0.03, 4


def table(titles, rows):
    """A table of Markdown; all columns but the first are aligned to the right."""
    lines = [titles, ["---", *["---:"] * (len(titles) - 1)], *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def method_row(case, paper, natural):
    """How far the results of the two presets are from the truth."""
    figures = [evaluate(result.rgb, case.truth, case.scan.valid) for result in (paper, natural)]
    cells = [f"{found[part]['ciede2000_mean']:.1f}" for part in ("as_is", "after_gain") for found in figures]
    cells += [f"{found['structural_similarity']:.2f}" for found in figures]
    cells += [f"{found['color_alone']['ciede2000_mean']:.2f}" for found in figures]
    return [_name(case), len(paper.seeds), *cells]


METHOD_TITLES = [
    *("scan", "seeds", "Paper", "Natural", "Paper, exposed alike", "Natural, exposed alike"),
    *("similarity, Paper", "similarity, Natural", "color alone, Paper", "color alone, Natural"),
]


def settings_row(case, seedings, settings):
    """Mean CIEDE2000 of color alone under each of several settings, from each of several Seeds."""
    cells = []
    for chosen in settings:
        results = [colorize(case.scan, seeds, chosen).rgb for seeds in seedings]
        figures = [evaluate(rgb, case.truth, case.scan.valid)["color_alone"] for rgb in results]
        cells.append(" / ".join(f"{found['ciede2000_mean']:.2f}" for found in figures))
    return [_name(case), *cells]


def range_row(case, seeds, without, with_range):
    """What the range is worth near jump edges and elsewhere: mean CIEDE2000 of color alone without and with it."""
    valid = case.scan.valid
    near = near_jumps(case.scan) & valid
    colored = (colorize(case.scan, seeds, settings).rgb for settings in (without, with_range))
    before, after = (error_map(with_luminance_of(rgb, case.truth), case.truth, valid) for rgb in colored)
    cells = []
    for region in (valid, near, valid & ~near):
        low, high = before[region].mean(), after[region].mean()
        cells.append(f"{low:.2f} → {high:.2f} ({(high / low - 1) * 100:+.0f} %)")
    return [_name(case), f"{near.sum() / valid.sum():.0%}", *cells]


RANGE_TITLES = ["scan", "near edges", "all pixels", "near jump edges", "elsewhere"]


def near_jumps(scan):
    """(H, W) bool: pixels at most four away from where neighbors differ by 3 % in range."""
    import cv2

    jump = np.zeros(scan.shape, bool)
    for first, second in (
        ((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
        ((slice(None), slice(1, None)), (slice(None), slice(None, -1))),
    ):
        one, other = scan.range[first], scan.range[second]
        step = scan.valid[first] & scan.valid[second] & (np.abs(one - other) > _JUMP_SHARE * np.minimum(one, other))
        jump[first] |= step
        jump[second] |= step
    return cv2.dilate(jump.astype(np.uint8), np.ones((2 * _NEAR_PX + 1,) * 2)) > 0


def _name(case):
    side = f", {case.scan.name}" if case.variant else ""
    return f"{case.scene}{side}{f', {case.variant}' if case.variant else ''}"
