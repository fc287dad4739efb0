"""Markdown tables of the figures, and whether they are good enough."""

import statistics

from .measure import METHODS
from .scenes import CHOSEN_ON, COUNTS, OTHERS

# What "Enhanced" must reach against Levin's optimization in the mean of the ratios over all scans.
BAR = 0.93


def table(results, count, part="color_alone"):
    """Mean CIEDE2000 and chrominance PSNR of every method on every scan at one number of seeds."""
    lines = [f"| scan | seeds | {' | '.join(METHODS)} |", "|---|---|" + "---|" * len(METHODS)]
    for result in results:
        if result["count"] == count:
            cells = [
                f"{figures['ciede2000_mean']:.2f} / {figures['chrominance_psnr_db']:.1f}"
                for figures in (result["figures"][method][part] for method in METHODS)
            ]
            lines.append(f"| {result['scan']} | {result['seeds']} | {' | '.join(cells)} |")
    return "\n".join(lines)


def summary(results):
    """The ratio of "Enhanced" to Levin's and to "Paper", by half and number of seeds, and its worst cases."""
    lines = [
        "| scans | seeds | mean to Levin's | worst | to Paper's | worst | 95 % to Levin's | PSNR over Levin's, worst |",
        "|---|---|---|---|---|---|---|---|",
    ]
    halves = {"chosen on": CHOSEN_ON, "others": OTHERS, "all": CHOSEN_ON + OTHERS}
    for half, names in halves.items():
        for count in (*COUNTS, None):
            chosen = [r["figures"] for r in results if r["scan"] in names and count in (None, r["count"])]
            if chosen:
                lines.append(f"| {half} | {count or 'all'} | {' | '.join(_ratios(chosen))} |")
    return "\n".join(lines)


def _ratios(figures):
    to_levin, to_paper, p95, gain = [], [], [], []
    for methods in figures:
        ours, levin, paper = (methods[name]["color_alone"] for name in ("Enhanced", "Levin", "Paper"))
        to_levin.append(ours["ciede2000_mean"] / levin["ciede2000_mean"])
        to_paper.append(ours["ciede2000_mean"] / paper["ciede2000_mean"])
        p95.append(ours["ciede2000_p95"] / levin["ciede2000_p95"])
        gain.append(ours["chrominance_psnr_db"] - levin["chrominance_psnr_db"])
    mean = statistics.fmean
    yield from (f"{mean(to_levin):.3f}", f"{max(to_levin):.3f}", f"{mean(to_paper):.3f}", f"{max(to_paper):.3f}")
    yield from (f"{mean(p95):.3f}", f"{mean(gain):+.2f} dB, {min(gain):+.2f} dB")


def confidence_table(results):
    """Rank correlation of confidence and error, and the mean errors of both halves."""
    lines = [
        "| scan | seeds | Paper: rank correlation, halves | Enhanced: rank correlation, halves |",
        "|---|---|---|---|",
    ]
    for result in results:
        cells = []
        for method in ("Paper", "Enhanced"):
            c = result["figures"][method]["confidence"]
            cells.append(f"{c['rank_correlation']:+.2f}, {c['upper_half']:.2f} / {c['lower_half']:.2f}")
        lines.append(f"| {result['scan']} | {result['seeds']} | {' | '.join(cells)} |")
    return "\n".join(lines)


def time_table(results):
    """Seconds of "Paper" and "Enhanced"."""
    lines = ["| scan | seeds | Paper, s | Enhanced, s | ratio |", "|---|---|---|---|---|"]
    for result in results:
        paper, ours = (result["figures"][method]["seconds"] for method in ("Paper", "Enhanced"))
        lines.append(f"| {result['scan']} | {result['seeds']} | {paper:.2f} | {ours:.2f} | {ours / paper:.2f} |")
    return "\n".join(lines)


def failures(results):
    """The bars that are not met on the real scans, one line each."""
    real = [result for result in results if result["scan"] in CHOSEN_ON + OTHERS]
    found, ratios = [], []
    for result in real:
        ours, levin, paper = (result["figures"][name]["color_alone"] for name in ("Enhanced", "Levin", "Paper"))
        place = f"{result['scan']}, {result['seeds']} seeds"
        ratios.append(ours["ciede2000_mean"] / levin["ciede2000_mean"])
        for name, other in (("Levin's", levin), ("Paper's", paper)):
            if ours["ciede2000_mean"] >= other["ciede2000_mean"]:
                found.append(f"{place}: CIEDE2000 is not below {name}")
        if ours["chrominance_psnr_db"] < levin["chrominance_psnr_db"]:
            found.append(f"{place}: chrominance PSNR is below Levin's")
        if result["figures"]["Enhanced"]["confidence"]["rank_correlation"] >= 0:
            found.append(f"{place}: confidence does not rise as the error falls")
    if ratios and statistics.fmean(ratios) > BAR:
        found.append(f"mean ratio to Levin's: {statistics.fmean(ratios):.3f} is above {BAR}")
    return found
