"""``python -m reflcolor_addon``: the command line without Blender."""

import sys

if __name__ == "__main__":
    try:
        from .cli.main import main

        status = main(sys.argv[1:])
    except KeyboardInterrupt:  # before the command line listens for it
        print("error: interrupted", file=sys.stderr)
        status = 130
    sys.exit(status)
