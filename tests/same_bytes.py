"""Whether other Blenders, with another Python and NumPy, have made the same bytes of the present sources."""

import hashlib
import platform
from pathlib import Path

import numpy as np

_ROOT = Path(__file__).resolve().parent.parent
_KEPT = _ROOT / "build" / "same-bytes"
_SOURCES = ("reflcolor_addon", "operators", "kernel/src", "tests/painted_room.py")


def differing_blenders(name: str, bpy, *contents: bytes) -> list[str]:
    """Keep the hashes of contents, and return the Blenders that have kept others.

    `make test` in CI runs one Blender after the other in one folder: the second finds what the first has kept.
    """
    hashes = [hashlib.sha256(each).hexdigest() for each in contents]
    folder = _KEPT / _fingerprint() / name
    folder.mkdir(parents=True, exist_ok=True)
    own = f"Blender {bpy.app.version_string}, Python {platform.python_version()}, NumPy {np.__version__}"
    (folder / own).write_text("\n".join(hashes))
    return [path.name for path in folder.iterdir() if path.read_text().split("\n") != hashes]


def _fingerprint():
    sources = hashlib.sha256()
    for source in _SOURCES:
        place = _ROOT / source
        for path in sorted(place.rglob("*.[pch]*")) if place.is_dir() else [place]:
            if path.suffix in (".py", ".c", ".h"):
                sources.update(path.read_bytes())
    return sources.hexdigest()[:16]
