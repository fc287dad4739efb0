"""Starts a worker in a Python of its own: the first line of standard input tells where its modules are.

This file is run as a script; nothing imports it.
"""

import json
import sys

if __name__ == "__main__":
    start = json.loads(sys.stdin.readline())
    sys.path[:] = start["path"]
    from reflcolor_addon.cli.main import main

    sys.exit(main(["work"], prog="reflcolor worker"))
