"""Time and peak memory of matching one scan of 760 x 1135 with one photo of 12 megapixels, in a process of its own.

    python -m benchmarks.matching_cost BASE [ROUNDS]

prints them for all cases beside an older build, of which BASE is a checkout; the two take turns, figures are medians.
"Finding" is the part until cameras are found or photos refused; what follows transfers colors.

    python -m benchmarks.matching_cost SCAN PHOTO MODE [COUNT]

SCAN is a scan of geodesic_cases.SCANS, enlarged; PHOTO any real scan, whose colors are the photo, or "warped" for the
scan's own, warped; MODE is verified or paper; of COUNT photos each is cut narrower than the one before. Linux alone
tells the peak.

Prints JSON: seconds, seconds of the processor, in all and until cameras are found, bytes at the peak beyond what was
there before, the longest seconds between two words of progress, and what is said of the photo.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

from benchmarks import geodesic_cases, matching_pairs, real_scans
from benchmarks.geodesic_memory import status
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import Settings
from reflcolor_addon.matching import match_photos

PIXELS = 12e6
# Columns by which each further photo is narrower.
_CUT = 100
CASES = (
    ("doria", "warped"),
    ("doria", "k4a"),
    ("bildstein_25", "warped"),
    ("bildstein_25", "bildstein_20"),
    ("bildstein_25", "pumpA"),
)


def enlarged_photo(scan_name, photo_name):
    """(H, W, 3) uint8 of 12 megapixels."""
    color = real_scans.load(scan_name if photo_name == "warped" else photo_name, geodesic_cases.DATA).color
    if photo_name == "warped":
        color = matching_pairs.warped_photo(color)
    height, width = color.shape[:2]
    larger = np.sqrt(PIXELS / (height * width))
    return cv2.resize(color, (round(width * larger), round(height * larger)), interpolation=cv2.INTER_CUBIC)


def beside(base, rounds):
    """Print the cost of every case, verified, beside that of an older build."""
    names = {"finding": "finding, processor", "processor": "all, processor", "seconds": "all, clock", "bytes": "MB"}
    columns = [cell for name in names.values() for cell in (f"{name}: before", "now", "ratio")]
    head(f"760 x 1135 and 12 megapixels, medians of {rounds} runs", "scan, photo", *columns, "said before", "now")
    for case in CASES:
        runs = [[], []]
        for _ in range(rounds):
            for root, found in zip((base, ROOT), runs, strict=True):
                found.append(_of_build(root, case))
        cells = []
        for key in names:
            before, now = (np.median([run[key] for run in found]) for found in runs)
            shown = (f"{value / 1e6:.0f}" if key == "bytes" else f"{value:.1f}" for value in (before, now))
            cells += [*shown, f"{now / before:.2f}"]
        row(", ".join(case), *cells, *(found[0]["note"] for found in runs))


def _of_build(root, case):
    """What this file prints of one case for the build in a checkout."""
    environment = os.environ | {"PYTHONPATH": str(root), "PYTHONSAFEPATH": "1"}
    command = [sys.executable, __file__, *case, "verified"]
    done = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def main():
    if len(sys.argv) < 4:
        beside(Path(sys.argv[1]).resolve(strict=True), int(sys.argv[2]) if len(sys.argv) > 2 else 3)
        return
    scan_name, photo_name, mode, *count = sys.argv[1:]
    scan, photo = geodesic_cases.whole_scan(scan_name, 1), enlarged_photo(scan_name, photo_name)
    photos = [photo[:, : photo.shape[1] - number * _CUT] for number in range(int(count[0]) if count else 1)]
    Path("/proc/self/clear_refs").write_text("5")
    before, processor, told, found = status("VmRSS"), time.process_time(), [time.perf_counter()], []

    def progress(fraction, text):
        told.append(time.perf_counter())
        if "transferring colors" in str(text):
            found.append(time.process_time() - processor)

    matching = match_photos(scan, photos, Settings(matching=mode), progress=progress)
    told.append(time.perf_counter())
    processor = time.process_time() - processor
    cost = {
        "seconds": told[-1] - told[0],
        "processor": processor,
        "finding": found[0] if found else processor,
        "bytes": status("VmHWM") - before,
        "silence": max(np.diff(told)),
        "note": matching.photos[0].note,
    }
    print(json.dumps(cost))


if __name__ == "__main__":
    main()
