"""``python -m reflcolor_addon``, or ``reflcolor`` where the package is installed: the command line without Blender."""

import sys

from .cli.interruption import ignore, leave_at_once


def main():
    """Run the command line and end with its exit status."""
    leave_at_once()
    from .cli.main import main as run

    prog = "python -m reflcolor_addon" if sys.argv[0].endswith("__main__.py") else "reflcolor"
    status = run(sys.argv[1:], prog=prog)
    ignore()
    sys.exit(status)


if __name__ == "__main__":
    main()
