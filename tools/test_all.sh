#!/bin/sh
# test_all.sh   tests with Python 3.13 (bpy 5.2 LTS) and with 3.11 (bpy 4.5 LTS), with each one that this machine has;
# both are tested, whatever the first one finds.
set -u
cd "$(dirname "$0")/.."

found=
failed=
for version in 3.13 3.11; do
    if tools/find_python.sh "$version" >/dev/null 2>&1; then
        found=1
        echo "test: Python $version"
        "${MAKE:-make}" --no-print-directory test-one VENV=".venv-$version" FOR_PYTHON="$version" || failed="$failed $version"
    else
        echo "test: no Python $version here, left out"
    fi
done
[ -n "$found" ] || tools/find_python.sh || exit 1
[ -z "$failed" ] || { echo "test: failed with Python$failed" >&2; exit 1; }
