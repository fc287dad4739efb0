"""Which Python runs a child process: the one that runs here, or the one that lies beside Blender."""

import sys
from pathlib import Path

ALONE = ("-I", "-S", "-B")
"""Options: nothing of the user's environment, no packages, no files written."""


def python_program():
    """Return the path of a Python of the same version as this one; None where there is none.

    Blender tells its own Python as ``sys.executable``; where a program holds Python without being one, it lies beside
    its library.
    """
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    folders = (Path(sys.base_exec_prefix), Path(sys.base_exec_prefix, "bin"))
    names = ("python.exe",) if sys.platform == "win32" else (version, "python3")
    stated = (sys.executable, getattr(sys, "_base_executable", None))
    candidates = [Path(path) for path in stated if path and Path(path).stem.startswith("python")]
    candidates += [folder / name for folder in folders for name in names]
    return next((path for path in candidates if path.is_file()), None)
