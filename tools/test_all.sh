#!/bin/sh
# test_all.sh   tests with Python 3.13 (bpy 5.2 LTS) and with 3.11 (bpy 4.5 LTS), with each one that this machine has.
set -eu
cd "$(dirname "$0")/.."

tested=
for version in 3.13 3.11; do
    if tools/find_python.sh "$version" >/dev/null 2>&1; then
        "${MAKE:-make}" --no-print-directory test-one VENV=".venv-$version" VERSION="$version"
        tested="$tested $version"
    else
        echo "test: no Python $version here, left out"
    fi
done
[ -n "$tested" ] || tools/find_python.sh
echo "test: passed with Python$tested"
