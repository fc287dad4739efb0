#!/usr/bin/env bash
# structural_similarity takes a mask, and ignores it (scikit-image 0.26.0).
#
# skimage.metrics.structural_similarity ends in **kwargs and takes from them what it knows. Any other keyword passes
# without an error: `mask=`, which neighboring functions such as phase_cross_correlation know in a form of their own,
# changes nothing, nor does a misspelled option. And one NaN in an image, which is how holes are often marked, makes the
# whole value NaN.
#
# Seen:
#   all pixels: 0.495
#   with mask=, of the half that is equal: 0.495
#   with no_such_option=: 0.495
#   that half cut out: 1.000
#   one NaN in the other half: nan
#
# Why it matters: scans have holes, and what is compared is what was measured. A comparison "with a mask" that runs
# without an error reports the similarity of everything, holes included.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    scikit-image==0.26.0 scipy==1.17.1 numpy==2.4.6

cd "$folder"
venv/bin/python - <<'PYTHON'
import numpy as np
from skimage.metrics import structural_similarity

chance = np.random.default_rng(0)
one, other = chance.random((64, 64)), chance.random((64, 64))
other[32:] = one[32:]
mask = np.zeros(one.shape, bool)
mask[36:] = True

plain = structural_similarity(one, other, data_range=1.0)
masked = structural_similarity(one, other, data_range=1.0, mask=mask)
misspelled = structural_similarity(one, other, data_range=1.0, no_such_option=3)
cut = structural_similarity(one[36:], other[36:], data_range=1.0)
other[0, 0] = np.nan
holed = structural_similarity(one, other, data_range=1.0)

print(f"all pixels: {plain:.3f}")
print(f"with mask=, of the half that is equal: {masked:.3f}")
print(f"with no_such_option=: {misspelled:.3f}")
print(f"that half cut out: {cut:.3f}")
print(f"one NaN in the other half: {holed:.3f}")
assert plain == masked == misspelled
assert plain < 0.9 and cut > 0.999
assert np.isnan(holed)
PYTHON
