"""`blender -b --command reflcolor ARGUMENT...` without a Blender: in the bpy wheel, from the extension's zip.

python tools/blender_command.py [--zip ZIP] [--resources DIR] -- ARGUMENT...

The zip is by default the one that `make build` left in dist/. DIR is the user folder to install it to and to keep;
by default one that is thrown away.
"""

import argparse
import importlib
import shutil
import sys
import tempfile
import traceback
from pathlib import Path

import blender_session
from build_extension import host_platform, running_python, zip_path


def main() -> None:
    """Install, run the command, end with its status."""
    own, command = split(sys.argv[1:])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--zip", type=Path, default=zip_path(host_platform(), (running_python(),)))
    parser.add_argument("--resources", type=Path)
    args = parser.parse_args(own)
    if not args.zip.is_file():
        sys.exit(f"{args.zip} is not there: run make build")
    resources = args.resources or Path(tempfile.mkdtemp(prefix="reflcolor-"))
    try:
        status = run(args.zip, resources.resolve(), command)
    except BaseException:
        traceback.print_exc()
        status = 1
    if args.resources is None:
        shutil.rmtree(resources, ignore_errors=True)
    blender_session.end(status)


def split(argv: list[str]) -> tuple[list[str], list[str]]:
    """What stands before the first "--" and what stands after it."""
    at = argv.index("--") if "--" in argv else len(argv)
    return argv[:at], argv[at + 1 :]


def run(zip_file: Path, resources: Path, argv: list[str]) -> int:
    """Give `argv` to the function that the extension registers as Blender's command."""
    blender_session.start(zip_file, resources)
    command = importlib.import_module(f"{blender_session.EXTENSION}.operators.command")
    try:
        again = (sys.executable, str(Path(__file__).resolve()), "--zip", str(zip_file), "--resources", str(resources))
        return command.run(argv, (*again, "--"))
    except SystemExit as error:
        return error.code if isinstance(error.code, int) else int(error.code is not None)


if __name__ == "__main__":
    main()
