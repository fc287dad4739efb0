#!/bin/sh
# run_tests.sh PYTHON [KIND]...   runs tests, one worker for each processor: `plain` those that need no Blender, `smoke`
# a few of these, `blender` those that do, in processes that end without asking the interpreter. By default plain and
# blender. All that are asked for run, whatever the first ones find; the status is 0 when all pass.
# BPY=FOLDER takes the bpy that lies there instead of the environment's own. Tests that are marked slow run in CI
# (CI=true) only.
set -u
cd "$(dirname "$0")/.."

python=$1
shift
[ $# -gt 0 ] || set -- plain blender
workers=${WORKERS:-auto}
chosen="not blender"
[ "${CI:-}" = true ] || chosen="$chosen and not slow"
# One of each kind of work: reading, geodesic distances by the kernel and by scipy, colors, photos, the command line.
smoke="tests/test_readers_ptx.py tests/test_readers_e57.py tests/test_image_files.py tests/test_kernel_field.py
    tests/test_kernel_blend.py tests/test_colorizer.py tests/test_kriging.py tests/test_matching_superpixels.py
    tests/test_matching_pairs.py tests/test_cli.py"

# What the zip brings, trimmed as it is there, in place of the same packages as their publishers have them.
bundled=$("$python" tools/build_extension.py --unpack) || exit 1

status=0
for kind in "$@"; do
    case $kind in
        plain) PYTHONPATH=$bundled "$python" -m pytest -m "$chosen" -n "$workers" --dist loadfile || status=$? ;;
        # shellcheck disable=SC2086
        smoke) PYTHONPATH=$bundled "$python" -m pytest -m "not blender and not slow" -n "$workers" --dist loadfile $smoke || status=$? ;;
        blender) PYTHONPATH=${BPY:-} "$python" -m pytest --blender -n "$workers" --dist loadfile || status=$? ;;
        *) echo "run_tests: no kind of tests $kind" >&2; exit 2 ;;
    esac
done
exit "$status"
