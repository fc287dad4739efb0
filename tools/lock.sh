#!/bin/sh
# Writes requirements/wheels.txt (what the extension bundles) and requirements/dev.txt (what working on it takes) from
# the .in files beside them: every version pinned, every file of it by hash, for all platforms and Pythons at once.
# With --upgrade newer versions are taken where the .in files leave the choice.
set -eu
cd "$(dirname "$0")/.."

UV_VERSION=0.13.9
VENV=build/lock-venv
PYTHON=$(tools/find_python.sh)

[ -x "$VENV/bin/uv" ] || { "$PYTHON" -m venv "$VENV" && "$VENV/bin/python" -m pip install --quiet "uv==$UV_VERSION"; }

# scikit-image declares these for its reading, writing and graph modules, which nobody here imports.
unused="--no-emit-package imageio --no-emit-package networkx --no-emit-package pillow"

lock() { # OUTPUT [ARGUMENT]...
    output=$1
    shift
    # shellcheck disable=SC2086
    "$VENV/bin/uv" pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
        --override requirements/numpy.in $unused --output-file "$output" "$@"
}

lock requirements/wheels.txt --no-emit-package numpy --no-emit-package tifffile requirements/wheels.in "$@"
lock requirements/dev.txt --constraints requirements/wheels.txt requirements/wheels.in requirements/numpy.in requirements/dev.in "$@"
# The newest Blender beside the LTS ones: bpy alone, into a folder of its own.
"$VENV/bin/uv" pip compile --quiet --python-version 3.13 --universal --no-deps --generate-hashes --no-header \
    --no-annotate --output-file requirements/bpy-newest.txt requirements/bpy-newest.in "$@"
