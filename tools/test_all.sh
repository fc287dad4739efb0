#!/bin/sh
# test_all.sh   what CI tests, with each Python that this machine has: the tests that need no Blender once, a few of
# them with the other Python; those in Blender with bpy 5.2 LTS and the newest bpy (Python 3.13) and bpy 4.5 LTS (3.11).
# All are run, whatever the first ones find.
set -u
cd "$(dirname "$0")/.."

failed=
tested=
run() { # VERSION TARGET [KIND]...
    version=$1 target=$2
    shift 2
    echo "test: Python $version, $target${*:+ ($*)}"
    "${MAKE:-make}" --no-print-directory "$target" VENV=".venv-$version" FOR_PYTHON="$version" KINDS="$*" \
        || failed="$failed $version:$target"
}

# The last environment is made while the first tests run: that is mostly waiting for files.
making=
if tools/find_python.sh 3.13 >/dev/null 2>&1 && tools/find_python.sh 3.11 >/dev/null 2>&1; then
    "${MAKE:-make}" --no-print-directory setup VENV=.venv-3.11 FOR_PYTHON=3.11 >/dev/null 2>&1 &
    making=$!
fi
kinds="plain blender"
for version in 3.13 3.11; do
    if ! tools/find_python.sh "$version" >/dev/null 2>&1; then
        echo "test: no Python $version here, left out"
        continue
    fi
    [ -n "$tested" ] || run "$version" check
    # If it could not be made, that is tried once more, and told.
    [ "$version" != 3.11 ] || [ -z "$making" ] || wait "$making" || true
    # shellcheck disable=SC2086
    run "$version" test-one $kinds
    [ "$version" != 3.13 ] || run "$version" test-newest
    tested=1
    kinds="smoke blender"
done
[ -n "$tested" ] || tools/find_python.sh || exit 1
[ -z "$failed" ] || { echo "test: failed with Python$failed" >&2; exit 1; }
