"""The verb ``provenance``: where the colors of a .blend are from."""

import json
from pathlib import Path

from ..errors import ReflcolorError, UsageError
from ..outputs import require_blender
from ..provenance import parse_provenance

NAME = "provenance"
HELP = "say where the colors in a .blend are from (in Blender)"
FORMAT = "reflcolor-provenance"
VERSION = 1
_NONE = "has no provenance: it was not colorized, or before provenance was kept, or somebody removed it"


def add_arguments(parser):
    """Declare what ``provenance`` takes."""
    parser.add_argument("input", metavar="FILE.blend", type=Path, help="a file saved by Blender")
    parser.add_argument("--object", metavar="NAME", help="one object; by default all that are scans")


def run(arguments, session):
    """Print, as JSON, from what inputs, seeds and settings the scans of a .blend were colorized."""
    require_blender(session.blender, NAME)
    if not arguments.input.is_file():
        raise ReflcolorError(f"{arguments.input}: no such file; expected a file saved by Blender")
    found = dict(session.blender.read_provenance(arguments.input))
    if not found:
        raise ReflcolorError(f"{arguments.input}: holds no scan")
    if arguments.object is not None:
        if arguments.object not in found:
            raise UsageError(f"--object {arguments.object}: not one of the scans {', '.join(found)}")
        found = {arguments.object: found[arguments.object]}
    if not any(found.values()):
        raise ReflcolorError(f"{arguments.input}: {', '.join(found)} {_NONE}")
    objects = []
    for name, text in found.items():
        try:
            objects.append({"name": name, "provenance": parse_provenance(text) if text else None})
        except ReflcolorError as error:
            raise ReflcolorError(f"{arguments.input}: {name}: {error}") from error
        if not text:
            session.warnings.append(f"{name} {_NONE}")
    document = {"format": FORMAT, "version": VERSION, "file": str(arguments.input), "objects": objects}
    session.console.print(json.dumps(document, indent=2))
