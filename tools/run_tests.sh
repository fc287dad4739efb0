#!/bin/sh
# run_tests.sh PYTHON   runs all tests: first those that need no Blender, then, in a process that ends without asking
# the interpreter, those that do. Both run, whatever the first one finds; the status is 0 when both pass.
set -u
cd "$(dirname "$0")/.."

status=0
"$1" -m pytest -m "not blender" || status=$?
"$1" -m pytest --blender || status=$?
exit "$status"
