"""The packages that the extension brings along, and what to say where one of them is gone.

Nothing of them is imported before it is needed, so that the extension registers, and the command line answers, without
them. Blender takes a package away when another extension that brings files of the same name is disabled.
"""

from importlib import invalidate_caches
from importlib.util import find_spec
from pathlib import Path

from .messages import Message

PACKAGES = {"cv2": "OpenCV", "lazy_loader": "lazy-loader", "scipy": "SciPy", "skimage": "scikit-image"}
"""Module -> the name that people know. Others (pye57, OpenEXR, the kernel) are asked for where they are used."""


def missing_packages():
    """Return the names of the packages that cannot be found."""
    invalidate_caches()
    return [name for module, name in PACKAGES.items() if not _is_there(module)]


def missing_package(error):
    """Return a Message where an ImportError is about one of the packages; else None."""
    module = (error.name or "").partition(".")[0]
    if module not in PACKAGES:
        return None
    return Message(
        "{package} is missing: another extension took it away; disable and enable Reflectance Colorizer",
        package=PACKAGES[module],
    )


def _is_there(module):
    try:
        spec = find_spec(module)
    except (ImportError, ValueError):
        return False
    # The remains of a deleted package have no origin; a loaded module keeps its own when its file is gone.
    return spec is not None and spec.origin is not None and Path(spec.origin).exists()
