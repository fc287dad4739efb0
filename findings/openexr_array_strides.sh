#!/usr/bin/env bash
# The OpenEXR module writes the memory behind an array, not the array: strides are ignored (OpenEXR 3.5.3).
#
# Every second pixel of an image, an image turned upside down, and a transposed image are NumPy views: they share the
# memory of the image and differ in their strides. OpenEXR.File(...).write() takes them without an error and writes
# as many values as they have from where they begin in memory, in the order of the memory. np.ascontiguousarray before
# writing helps.
#
# Seen:
#   every second pixel: another image comes back
#   upside down: another image comes back
#   transposed: another image comes back
#   a contiguous copy of each: the same image comes back
#
# Why it matters: a range image is often a slice or a flipped view of what a scanner delivered. The file is valid and
# has the right size; only its distances are wrong.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check OpenEXR==3.5.3 numpy==2.4.6

cd "$folder"
venv/bin/python - <<'PYTHON'
import numpy as np
import OpenEXR


def read_back(image):
    OpenEXR.File({"type": OpenEXR.scanlineimage}, {"Z": image}).write("image.exr")
    return OpenEXR.File("image.exr").channels()["Z"].pixels


# One large image, and views of its middle: there is valid memory of it before and behind them.
whole = np.arange(600, dtype=np.float32).reshape(20, 30)
middle = whole[8:12, 10:16]
views = {"every second pixel": middle[::2, ::2], "upside down": middle[::-1], "transposed": middle.T}
for name, view in views.items():
    found = read_back(view)
    same = np.array_equal(found, view)
    print(f"{name}: {'the same' if same else 'another'} image comes back")
    assert found.shape == view.shape and not same
assert all(np.array_equal(read_back(np.ascontiguousarray(view)), view) for view in views.values())
print("a contiguous copy of each: the same image comes back")
PYTHON
