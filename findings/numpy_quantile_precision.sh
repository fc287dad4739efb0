#!/usr/bin/env bash
# NumPy 1 and NumPy 2 give different numbers for the same quantile of the same float32 image (numpy 1.26.4, 2.4.6).
#
# np.quantile(image, 0.98) of a float32 image is a float64 in NumPy 1 and a float32 in NumPy 2, with another value, not
# just another type: 0.98 itself is rounded to single precision first. With a list of quantiles, [0.98], both compute in
# double precision and agree. The like happens wherever a Python number meets one of NumPy's: 0.1 * image.sum() is a
# float64 in NumPy 1 and a float32 in NumPy 2.
#
# Seen:
#   numpy 1.26.4: quantile float64, list float64, 0.1 * sum float64
#   numpy 2.4.6: quantile float32, list float64, 0.1 * sum float32
#   the quantiles differ, those of the list are equal
#
# Why it matters: Blender 4.5 brings NumPy 1.26, Blender 5 brings NumPy 2. A threshold or a range that an add-on takes
# from an image differs between the two, and what is decided by it may differ by much more.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.11)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for version in 1.26.4 2.4.6; do
    "$python" -m venv "$version"
    "$version/bin/pip" install --quiet --disable-pip-version-check "numpy==$version"
    "$version/bin/python" - <<'PYTHON'
import json

import numpy as np

image = (np.arange(100_003, dtype=np.int64) * 7919 % 100_003).astype(np.float32) ** 2 / np.float32(3)
alone, listed = np.quantile(image, 0.98), np.quantile(image, [0.98])[0]
total = 0.1 * image.sum()
print(f"numpy {np.__version__}: quantile {alone.dtype}, list {listed.dtype}, 0.1 * sum {total.dtype}")
expected = ["float64", "float64", "float64"] if np.__version__ < "2" else ["float32", "float64", "float32"]
assert [str(number.dtype) for number in (alone, listed, total)] == expected
with open("found", "a") as file:
    file.write(json.dumps([float(alone), float(listed)]) + "\n")
PYTHON
done
"$python" - <<'PYTHON'
import json

(one, one_listed), (other, other_listed) = map(json.loads, open("found"))
assert one != other and one_listed == other_listed, (one, other, one_listed, other_listed)
print("the quantiles differ, those of the list are equal")
PYTHON
