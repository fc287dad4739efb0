"""Time and peak memory of matching one scan of 760 x 1135 with one photo of 12 megapixels, in a process of its own.

    python -m benchmarks.matching_cost SCAN PHOTO MODE

SCAN is a scan of geodesic_cases.SCANS, enlarged; PHOTO any real scan, whose colors are the photo, or "warped" for the
scan's own, warped; MODE is verified or paper. Linux alone tells the peak.

Prints JSON: seconds, seconds of the processor, bytes at the peak beyond what was there before, the longest seconds
between two words of progress, and what is said of the photo.
"""

import json
import sys
import time
from pathlib import Path

import cv2
import numpy as np

from benchmarks import geodesic_cases, matching_pairs, real_scans
from benchmarks.geodesic_memory import status
from reflcolor_addon import Settings
from reflcolor_addon.matching import match_photos

PIXELS = 12e6
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


def main():
    scan_name, photo_name, mode = sys.argv[1:]
    scan, photo = geodesic_cases.whole_scan(scan_name, 1), enlarged_photo(scan_name, photo_name)
    Path("/proc/self/clear_refs").write_text("5")
    before, processor, told = status("VmRSS"), time.process_time(), [time.perf_counter()]
    matching = match_photos(
        scan, [photo], Settings(matching=mode), progress=lambda fraction, text: told.append(time.perf_counter())
    )
    told.append(time.perf_counter())
    found = {
        "seconds": told[-1] - told[0],
        "processor": time.process_time() - processor,
        "bytes": status("VmHWM") - before,
        "silence": max(np.diff(told)),
        "note": matching.photos[0].note,
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
