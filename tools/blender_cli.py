"""Blender's own extension tool, which lies as a script inside the bpy wheel: build, validate, index a repository."""

import importlib.util
import subprocess
import sys
from pathlib import Path

TAGS = "modules/_bpy_internal/extensions/tags.py"
TOOL = "addons_core/bl_pkg/cli/blender_ext.py"


def blender_ext(command: str, *arguments: str | Path) -> None:
    """Run one command of the tool; ends the program with its message where it fails."""
    scripts = bpy_scripts()
    tags = ["--valid-tags", str(scripts / TAGS)] if command in ("build", "validate") else []
    line = [sys.executable, str(scripts / TOOL), command, *tags, *map(str, arguments)]
    done = subprocess.run(line, check=False, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"blender_ext {command}: {(done.stderr or done.stdout).strip()}")


def bpy_scripts() -> Path:
    """The folder of Blender's scripts in the installed bpy wheel, found without importing bpy."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or not spec.submodule_search_locations:
        sys.exit("bpy is not installed in this Python: run make setup and use .venv/bin/python")
    tool = next(Path(spec.submodule_search_locations[0]).glob(f"*/scripts/{TOOL}"), None)
    if tool is None:
        sys.exit(f"the bpy of this Python lacks {TOOL}: run make setup again")
    return tool.parents[3]
