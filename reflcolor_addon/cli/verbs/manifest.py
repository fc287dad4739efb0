"""The verb ``manifest``: draft the manifest of a batch from a folder."""

from pathlib import Path

from ...batch.archive.draft import draft
from ...errors import UsageError
from ...files.atomic import written_atomically
from ...messages import Message

NAME = "manifest"
HELP = "draft the manifest of a batch from a folder of scans and photos"


def add_arguments(parser):
    """Declare what ``manifest`` takes."""
    parser.add_argument("input", metavar="DIR", type=Path, help="folder that holds scans and photos, also in folders")
    parser.add_argument("-o", "--output", metavar="MANIFEST.toml", type=Path, required=True, help="file to write")


def run(arguments, session):
    """Write a manifest that names all scans and photos below a folder, for a person to look through and to change."""
    path = arguments.output
    if path.suffix.lower() != ".toml":
        raise UsageError("-o {path}: expected a file that ends in .toml", path=path)
    if path.exists():
        raise UsageError("-o {path}: exists already, and may have been edited; choose another name", path=path)
    text = draft(arguments.input, path)
    with written_atomically(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    session.say(Message("wrote {path}", path=path))
