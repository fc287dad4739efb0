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


def method_row(case, colorization):
    """How far one result is from the truth, beside what gray would give."""
    alone, as_is = _figures(case, colorization.rgb)
    gray = np.repeat(colorization.rgb.mean(axis=-1, keepdims=True), 3, axis=-1).astype(np.uint8)
    return [
        _name(case),
        len(colorization.seeds),
        f"{_figures(case, gray)[0]['ciede2000_mean']:.2f}",
        f"{alone['ciede2000_mean']:.2f}",
        f"{alone['ciede2000_p95']:.1f}",
        f"{alone['chrominance_psnr_db']:.1f}",
        f"{as_is['ciede2000_mean']:.1f}",
    ]


METHOD_TITLES = ["scan", "seeds", "gray", "mean", "95 %", "PSNR, dB", "as is, mean"]


def settings_row(case, seedings, settings):
    """Mean CIEDE2000 of color alone under each of several settings, from each of several Seeds."""
    cells = []
    for chosen in settings:
        results = [colorize(case.scan, seeds, chosen).rgb for seeds in seedings]
        cells.append(" / ".join(f"{_figures(case, rgb)[0]['ciede2000_mean']:.2f}" for rgb in results))
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


def _figures(case, rgb):
    figures = evaluate(rgb, case.truth, case.scan.valid)
    return figures["color_alone"], figures["as_is"]


def _name(case):
    side = f", {case.scan.name}" if case.variant else ""
    return f"{case.scene}{side}{f', {case.variant}' if case.variant else ''}"
