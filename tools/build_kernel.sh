#!/bin/sh
# build_kernel.sh VENV   builds this machine's wheel of the geodesic kernel into build/kernel-wheels and installs it in
# VENV. Neither is done again until a file of kernel/ changes.
set -eu
cd "$(dirname "$0")/.."

venv=$1
wheels=build/kernel-wheels
stamp=$(find kernel -type f ! -name '*.pyc' | LC_ALL=C sort | xargs cksum | cksum)

if [ "$(cat "$wheels/stamp" 2>/dev/null)" != "$stamp" ]; then
    rm -rf "$wheels"
    "$venv/bin/python" kernel/build.py --host "$wheels"
    echo "$stamp" >"$wheels/stamp"
fi
if [ "$(cat "$venv/kernel-stamp" 2>/dev/null)" != "$stamp" ]; then
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-index --no-deps --force-reinstall \
        "$wheels"/reflcolor_kernel-*.whl
    echo "$stamp" >"$venv/kernel-stamp"
fi
