#!/bin/sh
# find_python.sh [VERSION]...   prints the path of a Python that can carry the project, or says what to install.
# VERSION is 3.13 or 3.11 (default: both, the newer first): the Pythons that a bpy wheel exists for.
# PYTHON=... names one outright. A name on PATH proves nothing (pyenv's shims are there for versions that are not
# installed or not selected), so every candidate is run before it is believed.
set -u

[ $# -gt 0 ] || set -- 3.13 3.11
without_venv=

probe() { # CANDIDATE VERSION: prints the path of the interpreter itself
    command -v "$1" >/dev/null 2>&1 || return 1
    found=$("$1" -c "import sys
if '%d.%d' % sys.version_info[:2] == '$2' and sys.maxsize > 2**32 and sys.implementation.name == 'cpython':
    try:
        import ensurepip, venv
        print('ok', sys.executable)
    except ImportError:
        print('without-venv', sys.executable)" 2>/dev/null </dev/null) || return 1
    case $found in
        "ok "*) echo "${found#ok }" ;;
        "without-venv "*) without_venv=$2; return 1 ;;
        *) return 1 ;;
    esac
}

for version; do
    if [ -n "${PYTHON:-}" ]; then
        probe "$PYTHON" "$version" && exit 0
        continue
    fi
    for candidate in "python$version" python3 python \
        "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python \
        "$HOME/.local/share/uv/python/cpython-$version".*/bin/python3 \
        "/usr/local/bin/python$version" "/usr/bin/python$version" \
        "/opt/homebrew/bin/python$version" "/usr/local/opt/python@$version/bin/python$version" \
        "/Library/Frameworks/Python.framework/Versions/$version/bin/python3"; do
        probe "$candidate" "$version" && exit 0
    done
done

wanted=$(echo "$*" | sed 's/ / or /g')
if [ -n "$without_venv" ]; then
    echo "setup: Python $without_venv lacks its venv module: apt-get install python$without_venv-venv" >&2
elif [ -n "${PYTHON:-}" ]; then
    echo "setup: PYTHON=$PYTHON is no 64-bit CPython $wanted that runs; name another or leave PYTHON out" >&2
else
    echo "setup: no Python $wanted found: apt-get install python3.11 python3.11-venv, pyenv install 3.13, or the" \
        "installer from python.org; one that lies elsewhere is named by make setup PYTHON=/path/to/python" >&2
fi
exit 1
