"""How light the scans with truth are, and what another tone does: python -m benchmarks.quality.tone [SCAN ...]

Colors are spread from about 100 perfect seeds. Printed is the median of the luminance (0..255), the tone that is
suggested for it, and by tone the mean CIEDE2000 as the colors come / with the true luminance.
"""

import sys

import numpy as np

from reflcolor_addon import Colorizer, Settings
from reflcolor_addon.color.evaluation import evaluate
from reflcolor_addon.color.tone import tone_to_try
from reflcolor_addon.scan.normalization import normalize

from .scenes import NAMES, load, perfect_seeds

TONES = (0.7, 1.0, 2.0, 3.0, 4.0, 5.0)


def main():
    """Print a table."""
    print("| scan | median | to try |", *(f"tone {tone:g} |" for tone in TONES))
    print("|---|---|---|" + "---|" * len(TONES))
    for name in sys.argv[1:] or NAMES:
        scan, known = load(name)
        colorizer, seeds = Colorizer(scan), perfect_seeds(scan, known, 100)
        median = float(np.median(normalize(scan.reflectance, scan.valid)[0][scan.valid]))
        cells = []
        for tone in TONES:
            found = evaluate(colorizer.colorize(seeds, Settings(tone=tone)).rgb, scan.color, known)
            cells.append(" / ".join(f"{found[kind]['ciede2000_mean']:.2f}" for kind in ("as_is", "color_alone")))
        tried = tone_to_try(median, 1.0)
        print(f"| {name} | {median:.0f} | {'-' if tried is None else f'{tried:g}'} |", *(f"{cell} |" for cell in cells))


if __name__ == "__main__":
    main()
