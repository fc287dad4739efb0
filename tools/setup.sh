#!/bin/sh
# setup.sh [VENV [VERSION]]   makes VENV (default .venv) of a Python 3.13 or 3.11 (or just VERSION) with all that
# requirements/dev.txt pins: bpy 5.2 LTS or 4.5 LTS, the wheels that the extension bundles, and the tools of the tests.
# A finished VENV carries a stamp and is left alone until the pins, the Python or this script change.
set -eu
cd "$(dirname "$0")/.."

venv=${1:-.venv}
[ $# -lt 2 ] || { version=$2; }
lock=requirements/dev.txt
stamp=$venv/setup-stamp

checksum() { cat "$lock" tools/setup.sh | cksum; }

if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$(checksum)" ] && [ -z "${PYTHON:-}" ] && "$venv/bin/python" -c '' 2>/dev/null; then
    exit 0
fi

# shellcheck disable=SC2086
python=$(tools/find_python.sh ${version:-})
if [ -n "${PYTHON:-}" ] && [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$(checksum)" ] \
    && [ "$("$venv/bin/python" -c 'import sys; print(sys.version)')" = "$("$python" -c 'import sys; print(sys.version)')" ]; then
    exit 0
fi

version_of() { "$1" -c 'import sys; print(sys.version)' 2>/dev/null; }
rm -f "$stamp"
if [ -n "$(version_of "$python")" ] && [ "$(version_of "$venv/bin/python")" = "$(version_of "$python")" ]; then
    # Only what the lock has changed is installed.
    echo "setup: bringing $venv up to date"
else
    echo "setup: making $venv with $("$python" -V)"
    "$python" -m venv --clear "$venv"
fi
# The lock names every file that may be installed by its hash and holds every dependency that is used.
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --only-binary=:all: \
    --requirement "$lock"

# bpy may hang when the interpreter ends, so the check ends it.
if ! error=$("$venv/bin/python" -c 'import os, bpy; os._exit(0)' 2>&1); then
    case $error in
        *"cannot open shared object file"*)
            echo "setup: bpy needs libraries of the system: ${error##*ImportError: }" >&2
            echo "setup: on Debian or Ubuntu run: apt-get install --no-install-recommends $(cat tools/system_libraries.txt)" >&2
            ;;
        *) echo "setup: bpy does not start: $error" >&2 ;;
    esac
    exit 1
fi
checksum >"$stamp"
echo "setup: $venv is ready"
