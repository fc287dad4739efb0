#!/usr/bin/env bash
# OpenCV reads some valid TIFF images wrongly, without an error (opencv-python-headless 4.14.0.94).
#
# The files are written by tifffile and read by cv2.imread(..., IMREAD_UNCHANGED):
# - RGB of 16 bits in separate planes comes back with the right size and depth, but almost no pixel has its value, and
#   what comes differs from one reading to the next. With 8 bits the same layout is read correctly.
# - Gray where zero is white is inverted, as it should be, in 8 bits; in 16 bits it is not.
# - Gray of 16 bits with an alpha channel comes back as gray of 8 bits.
#
# Seen:
#   planes of 8 bits: 100 % of the values are right
#   planes of 16 bits: 0 % of the values are right
#   white is zero, 8 bits: inverted
#   white is zero, 16 bits: not inverted
#   gray and alpha of 16 bits: uint8, (40, 50)
#
# Why it matters: range and reflectance images of scanners are 16-bit TIFFs. The wrong image looks like one that was
# read, so a program has to look at the file's own tags before it trusts what OpenCV returns.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    opencv-python-headless==4.14.0.94 tifffile==2026.11.8 numpy==2.4.6

cd "$folder"
venv/bin/python - <<'PYTHON'
import cv2
import numpy as np
import tifffile

chance = np.random.default_rng(0)


def read_back(image, **layout):
    tifffile.imwrite("image.tif", image, **layout)
    return cv2.imread("image.tif", cv2.IMREAD_UNCHANGED)


for kind, expected in ((np.uint8, True), (np.uint16, False)):
    bits, most = 8 * kind().itemsize, np.iinfo(kind).max
    rgb = chance.integers(0, most, (40, 50, 3), kind, endpoint=True)
    found = read_back(np.moveaxis(rgb, -1, 0), photometric="rgb", planarconfig="separate")
    assert found.shape == rgb.shape and found.dtype == kind
    right = (found[..., ::-1] == rgb).mean()
    print(f"planes of {bits} bits: {100 * right:.0f} % of the values are right")
    assert right == 1 if expected else right < 0.1

for kind, expected in ((np.uint8, True), (np.uint16, False)):
    most = np.iinfo(kind).max
    gray = chance.integers(0, most, (40, 50), kind, endpoint=True)
    found = read_back(gray, photometric="miniswhite")
    inverted = bool((found == most - gray).all())
    print(f"white is zero, {8 * kind().itemsize} bits: {'inverted' if inverted else 'not inverted'}")
    assert inverted == expected
    assert inverted or (found == gray).all()

both = chance.integers(0, 65536, (40, 50, 2), np.uint16)
found = read_back(both, photometric="minisblack", extrasamples=["unassalpha"])
print(f"gray and alpha of 16 bits: {found.dtype}, {found.shape}")
assert (found.dtype, found.shape) == (np.uint8, (40, 50))
PYTHON
