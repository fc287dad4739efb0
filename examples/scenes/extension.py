"""The extension's own modules for scripts of this folder, from the source tree and without registering anything."""

import importlib
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[2]
_PACKAGE = "reflcolor"


def module(name):
    """Import a module of the extension by its dotted name below the extension, e.g. "operators.scene.scene_renders"."""
    if _PACKAGE not in sys.modules:
        package = ModuleType(_PACKAGE)
        # A package without its __init__: that one registers classes, which only Blender's extension system should do.
        package.__path__ = [str(ROOT)]
        sys.modules[_PACKAGE] = package
    return importlib.import_module(f"{_PACKAGE}.{name}")
