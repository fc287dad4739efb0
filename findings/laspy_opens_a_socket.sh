#!/usr/bin/env bash
# Importing laspy opens a network socket where requests is installed (laspy 2.7.0, requests 2.32.5, urllib3 2.5.0).
#
# laspy can read files on servers (COPC), and tries to import requests for that whenever it is imported itself, whatever
# is to be read. requests imports urllib3, which opens and binds an IPv6 socket at once, to find out whether the machine
# has IPv6. A program that only reads LAS files from its disk thus asks for the network. Without requests, no socket is
# opened.
#
# Seen:
#   laspy alone: no socket
#   laspy beside requests: socket.__new__, socket.bind
#
# Why it matters: Blender brings requests. An extension whose manifest asks for no network permission opens a socket by
# importing laspy; in a sandbox that kills what opens one, that ends the program.
set -euo pipefail

python=${PYTHON:-$("$(dirname "$0")/../tools/find_python.sh" 3.13)}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check laspy==2.7.0 numpy==2.4.6

cat > "$folder/import.py" <<'PYTHON'
import sys

seen = []
sys.addaudithook(lambda event, _: seen.append(event) if event in ("socket.__new__", "socket.bind") else None)
import laspy

print(", ".join(seen) or "no socket")
PYTHON

cd "$folder"
alone=$(venv/bin/python import.py)
echo "laspy alone: $alone"
venv/bin/pip install --quiet --disable-pip-version-check requests==2.32.5 urllib3==2.5.0
beside=$(venv/bin/python import.py)
echo "laspy beside requests: $beside"
[ "$alone" = "no socket" ]
[ "$beside" = "socket.__new__, socket.bind" ]
