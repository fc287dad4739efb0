#!/bin/sh
# test_no_network.sh PYTHON [FILE]...   runs the tests that need no Blender, or those of FILEs, in one process under a
# preloaded library that refuses and notes every call that opens or connects a socket or looks up a name
# (tests/refuse_sockets.c), in child processes, too. Prints the calls that were made, by test; the status is 0 when all
# tests pass and there was none. Linux, with a C compiler.
set -eu
cd "$(dirname "$0")/.."

python=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cc -shared -fPIC -o "$folder/refuse.so" tests/refuse_sockets.c
: >"$folder/calls"

status=0
# Workers of pytest-xdist would talk to each other; without it there is one process.
LD_PRELOAD=$folder/refuse.so REFLCOLOR_SOCKETS=$folder/calls \
    "$python" -m pytest -m "not blender" -p no:xdist -q "$@" || status=$?

if [ -s "$folder/calls" ]; then
    echo "test_no_network: calls that were refused:"
    sort "$folder/calls" | uniq -c
    exit 1
fi
echo "test_no_network: no socket was opened and no name looked up"
exit "$status"
